"""Summaries of runs, as tables and as JSON."""

import json
import math
from collections.abc import Mapping
from typing import Any

from rich.table import Table

from buoyancy_mj.cli.console import out, print_line, viewer_command
from buoyancy_mj.cli.recordings import Files
from buoyancy_mj.environments.sauvc.report import MissionReport
from buoyancy_mj.scenes.summary import Summary


def summary_table(summary: Summary) -> Table:
    """A summary as a table, with a column for each of several vehicles."""
    several = len(summary.vehicles) > 1
    table = Table(title=summary.scene, show_header=several, title_justify="left")
    for name in ("", *summary.vehicles):
        table.add_column(name)
    for row in summary.rows():
        table.add_row(*row)
    if several:
        table.caption = summary.caption
        table.caption_justify = "left"
    return table


def mission_table(report: MissionReport) -> Table:
    """What a referee has seen, as a table."""
    table = Table(title=f"mission: {report.task}", show_header=False, title_justify="left")
    for row in report.rows():
        table.add_row(*row)
    return table


def summary_json(summary: Summary, files: Files, others: Mapping[str, Any] | None = None) -> str:
    """A summary and the paths of its files as JSON, which knows finite numbers only.

    Args:
        summary: the summary.
        files: what the run left.
        others: more values, by name.
    """
    values: dict[str, Any] = summary.values()
    if len(summary.vehicles) > 1:
        # a table for each vehicle, in place of names with dots
        own = tuple(f"{name}." for name in summary.vehicles)
        values = {name: value for name, value in values.items() if not name.startswith(own)}
        values["vehicles"] = {name: one.values() for name, one in summary.vehicles.items()}
    values |= {name: str(path) if path else None for name, path in files._asdict().items()}
    values |= others or {}
    return json.dumps(_drop_infinite(values), indent=2)


def print_files(files: Files) -> None:
    """Say where the files of a run are, and how a recording is opened."""
    if files.recording is not None:
        print_line(out, f"open the recording: {viewer_command(files.recording)}")
    if files.series is not None:
        print_line(out, f"the series is in '{files.series}'")
    if files.mcap is not None:
        print_line(out, f"the messages of ROS 2 are in '{files.mcap}'")
    if files.video is not None:
        print_line(out, f"the film is '{files.video}'")
    if files.screenshot is not None:
        print_line(out, f"the picture is '{files.screenshot}'")


def _drop_infinite(value: Any) -> Any:
    """The same values, but None for each number that is not finite."""
    if isinstance(value, dict):
        return {key: _drop_infinite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value

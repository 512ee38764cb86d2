"""Summaries of runs, as tables and as JSON."""

import dataclasses
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.table import Table

from buoyancy_mj.cli.console import out, print_line, quote_path, viewer_command
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


def summary_json(
    summary: Summary, paths: Sequence[Path], others: Mapping[str, Any] | None = None
) -> str:
    """A summary and the path of its recording as JSON, which knows finite numbers only.

    Args:
        summary: the summary.
        paths: files that the run left.
        others: more values, by name.
    """
    values: dict[str, Any] = summary.values()
    if len(summary.vehicles) > 1:
        # a table for each vehicle, in place of names with dots
        values = dataclasses.asdict(summary)
    files = {path.suffix: str(path) for path in paths}
    values |= {"recording": files.get(".rrd"), "mcap": files.get(".mcap"), **(others or {})}
    return json.dumps(_drop_infinite(values), indent=2)


def print_openers(paths: Sequence[Path]) -> None:
    """Print the command that opens each file of a run."""
    for path in paths:
        if path.suffix == ".rrd":
            print_line(out, f"open the recording: {viewer_command(path)}")
        else:
            print_line(out, f"written: {quote_path(path)}")


def _drop_infinite(value: Any) -> Any:
    """The same values, but None for each number that is not finite."""
    if isinstance(value, dict):
        return {key: _drop_infinite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value

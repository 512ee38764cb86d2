"""`run`, `view` and `list`: one scene at a time."""

import dataclasses
import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.progress import TextColumn, TimeRemainingColumn
from rich.table import Table

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out, print_line, show_progress, viewer_command
from buoyancy_mj.cli.flags import (
    Json,
    RunFlags,
    SceneArgument,
    SceneFlags,
    SelectionFlags,
    check_recording_name,
    check_table_name,
)
from buoyancy_mj.cli.signals import raise_received
from buoyancy_mj.environments.sauvc.report import MissionReport
from buoyancy_mj.errors import RecordingError, SceneError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.viz.sinks import open_sinks


@command()
def run(
    scene: SceneArgument,
    flags: RunFlags,
    selection: SelectionFlags,
    record: Annotated[
        Path | None, typer.Option(help="Record to this file instead of recordings/NAME.rrd.")
    ] = None,
    no_record: Annotated[
        bool, typer.Option("--no-record", help="Do not record to a file.")
    ] = False,
    series: Annotated[
        Path | None,
        typer.Option(help="Write a row for each frame into this .csv or .parquet as well."),
    ] = None,
    live: Annotated[
        bool, typer.Option("--live", help="Stream to a Rerun viewer while the scene runs.")
    ] = False,
    through: Annotated[
        str,
        typer.Option(
            help="Where the forces enter: qfrc_passive, or xfrc_applied, where sensors see them.",
            metavar="ARRAY",
        ),
    ] = "qfrc_passive",
    as_json: Json = False,
) -> None:
    """Run a scene headless, record it and sum it up."""
    if record is not None and no_record:
        raise SceneError("--record and --no-record contradict each other; give one of them")
    check_recording_name(record)
    check_table_name(series)

    # the run
    path = catalog.scene_path(scene)
    settings = [*flags.overrides(), *selection.overrides()]
    with err.status(
        "preparing (the first run after an installation compiles, which takes some seconds)"
    ):
        simulation = Simulation(read_scene(path, settings), through=through, trust=flags.trust)
    target = None if no_record else record or Path("recordings") / f"{simulation.scene.stem}.rrd"
    recording, table = _run_to_end(simulation, target, series, live=live)

    # its summary
    summary = simulation.summary()
    report = simulation.mission.report if simulation.mission else None
    if as_json:
        typer.echo(_to_json(summary, recording, table, report))
        return
    out.print(_to_table(summary))
    if report is not None:
        out.print(_to_mission_table(report))
    if recording is not None:
        print_line(out, f"open the recording: {viewer_command(recording)}")
    if table is not None:
        print_line(out, f"the series is in '{table}'")


@command("list")
def list_() -> None:
    """List the scenes and models that ship."""
    scenes = {name: read_scene(path).title for name, path in catalog.scenes().items()}
    models = {name: catalog.summary(path) for name, path in catalog.models().items()}
    for title, rows in (("scenes", scenes), ("models", models)):
        table = Table(
            title=title, show_header=False, title_justify="left", box=None, padding=(0, 2)
        )
        for name, line in rows.items():
            table.add_row(name, line)
        out.print(table)


@command()
def view(scene: SceneArgument, flags: SceneFlags, selection: SelectionFlags) -> None:
    """Show a scene in MuJoCo's interactive viewer, with its water."""
    from buoyancy_mj.viz.viewer import view_simulation  # needs a display, which 'run' does not

    settings = [*flags.overrides(), *selection.overrides()]
    read = read_scene(catalog.scene_path(scene), settings)
    view_simulation(Simulation(read, trust=flags.trust))


def _run_to_end(
    simulation: Simulation, target: Path | None, series: Path | None, *, live: bool
) -> tuple[Path | None, Path | None]:
    """Run to the end; record to a file, to a live viewer, to a table, or to several of them.

    Returns:
        Where the recording and the table are.
    """
    recording, table = open_sinks(simulation, target, series, live=live)
    try:
        _run_frames(simulation, [sink.add for sink in (recording, table) if sink is not None])
        return (
            recording.close(simulation.summary()) if recording is not None else None,
            table.close() if table is not None else None,
        )
    except BaseException:
        # whatever ends the run, what was recorded stays
        if recording is not None and not recording.closed:
            summary = simulation.summary()
            _keep_partial("recording", simulation, lambda: recording.close(summary, complete=False))
        if table is not None and not table.closed:
            _keep_partial("series", simulation, lambda: table.close(complete=False))
        raise


def _keep_partial(what: str, simulation: Simulation, close: Callable[[], Path | None]) -> None:
    """Close a recording or a table that broke off, and say where it is."""
    try:
        partial = close()
    except RecordingError as error:
        print_line(err, f"note: {error}", style="yellow")
    else:
        if partial is not None:
            time = simulation.data.time
            print_line(err, f"the {what} up to {time:.2f} s is in '{partial}'")


def _run_frames(simulation: Simulation, sinks: Sequence[Callable[[Frame], None]]) -> None:
    """Run to the end, handing each frame to all `sinks`, and show the simulated time."""
    scene = simulation.scene
    columns = TextColumn("{task.completed:.1f} of {task.total:.1f} s"), TimeRemainingColumn()
    with show_progress(scene.title, scene.duration, *columns) as update:
        for frame in simulation.frames():
            raise_received()
            for add in sinks:
                add(frame)
            update(completed=frame.time)


def _to_table(summary: Summary) -> Table:
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


def _to_mission_table(report: MissionReport) -> Table:
    """What a referee has seen, as a table."""
    table = Table(title=f"mission: {report.task}", show_header=False, title_justify="left")
    for row in report.rows():
        table.add_row(*row)
    return table


def _to_json(
    summary: Summary, recording: Path | None, table: Path | None, report: MissionReport | None
) -> str:
    """A summary, the paths of its files and what a referee has seen, as JSON.

    JSON knows finite numbers only.
    """
    values: dict[str, Any] = summary.values()
    if len(summary.vehicles) > 1:
        # a table for each vehicle, in place of names with dots
        values = dataclasses.asdict(summary)
    for name, path in (("recording", recording), ("series", table)):
        values[name] = str(path) if path else None
    if report is not None:
        values |= {"mission": report.values()}
    return json.dumps(_drop_infinite(values), indent=2)


def _drop_infinite(value: Any) -> Any:
    """The same values, but None for each number that is not finite."""
    if isinstance(value, dict):
        return {key: _drop_infinite(item) for key, item in value.items()}
    return None if isinstance(value, float) and not math.isfinite(value) else value

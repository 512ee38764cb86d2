"""`run` and `list`: one scene at a time."""

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import TextColumn, TimeRemainingColumn
from rich.table import Table

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out, print_line, show_progress
from buoyancy_mj.cli.films import FilmFlags
from buoyancy_mj.cli.flags import (
    Json,
    RunFlags,
    SceneArgument,
    SelectionFlags,
    check_recording_name,
    check_table_name,
)
from buoyancy_mj.cli.recordings import Files, Recordings, StreamFlags
from buoyancy_mj.cli.signals import raise_received, wait_for_interrupt
from buoyancy_mj.cli.summaries import mission_table, print_files, summary_json, summary_table
from buoyancy_mj.cli.watching import ViewerFlags
from buoyancy_mj.errors import SceneError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.simulation import Simulation


@command(
    examples=(
        "run auv_waves --video waves.mp4",
        "run auv_waves --vehicle my_auv.xml --duration 20",
    ),
)
def run(
    scene: SceneArgument,
    flags: RunFlags,
    selection: SelectionFlags,
    streams: StreamFlags,
    films: FilmFlags,
    watching: ViewerFlags,
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
    through: Annotated[
        str,
        typer.Option(
            help="Where the forces enter: qfrc_passive, or xfrc_applied, where sensors see them.",
            metavar="ARRAY",
        ),
    ] = "qfrc_passive",
    as_json: Json = False,
) -> None:
    """Run a scene headless, record it or film it, and sum it up."""
    if record is not None and no_record:
        raise SceneError("--record and --no-record contradict each other; give one of them")
    check_recording_name(record)
    check_table_name(series)
    watching.viewers.check()

    # the run
    path = catalog.scene_path(scene)
    settings = [*flags.overrides(), *selection.overrides()]
    with err.status(
        "preparing (the first run after an installation compiles, which takes a minute or two)"
    ):
        simulation = Simulation(read_scene(path, settings), through=through, trust=flags.trust)
    target = None if no_record else record or Path("recordings") / f"{simulation.scene.stem}.rrd"
    recordings = Recordings(
        simulation,
        target,
        series,
        viewers=watching.viewers,
        streams=streams,
        films=films,
        waits=True,
    )
    files = _run_to_end(simulation, recordings)

    # its summary
    summary = simulation.summary(with_periods=True)
    report = simulation.mission.report if simulation.mission else None
    if as_json:
        others = {"mission": report.values()} if report else None
        typer.echo(summary_json(summary, files, others))
    else:
        out.print(summary_table(summary))
        if report is not None:
            out.print(mission_table(report))
        print_files(files)
    if recordings.page is not None:
        print_line(err, f"{recordings.page} is served until Ctrl-C")
        wait_for_interrupt()


@command(
    "list",
    examples=(
        "list",
        "list | grep sauvc",
    ),
)
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


def _run_to_end(simulation: Simulation, recordings: Recordings) -> Files:
    """Run to the end, and record; the files."""
    try:
        _run_frames(simulation, recordings)
        return recordings.close(simulation.summary(with_periods=True))
    except BaseException:
        # whatever ends the run, what was recorded stays
        recordings.keep(simulation.summary)
        raise


def _run_frames(simulation: Simulation, recordings: Recordings) -> None:
    """Run to the end, recording each frame if anything is recorded; show the simulated time."""
    scene = simulation.scene
    columns = TextColumn("{task.completed:.1f} of {task.total:.1f} s"), TimeRemainingColumn()
    with show_progress(scene.title, scene.duration, *columns) as update:

        def show(time: float) -> None:
            raise_received()
            update(completed=time)

        if not recordings:
            simulation.run(show)
            return
        for frame in simulation.frames():
            show(frame.time)
            recordings.add(frame)

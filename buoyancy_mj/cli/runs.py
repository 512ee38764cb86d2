"""`run`, `view` and `list`: one scene at a time."""

import dataclasses
import json
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from buoyancy_mj.cli.common import (
    FILL,
    GEOMS,
    HULL,
    METHOD,
    SCENE,
    SET,
    TIMESTEP,
    VEHICLE,
    app,
    err,
    out,
    quote,
    read_scene_with_flags,
    report_errors,
    viewer_command,
)
from buoyancy_mj.errors import SceneError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.frames import Summary
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.simulation import Simulation


@app.command()
@report_errors
def run(
    scene: SCENE,
    vehicle: VEHICLE = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s].")] = None,
    timestep: TIMESTEP = None,
    method: METHOD = None,
    record: Annotated[
        Path | None, typer.Option(help="Where to record; otherwise recordings/SCENE.rrd.")
    ] = None,
    no_record: Annotated[
        bool, typer.Option("--no-record", help="Do not record to a file.")
    ] = False,
    live: Annotated[
        bool, typer.Option("--live", help="Stream to a Rerun viewer while it runs.")
    ] = False,
    settings: SET = None,
    geoms: GEOMS = None,
    hull: HULL = None,
    fill: FILL = None,
    as_json: Annotated[
        bool,
        typer.Option("--json", help="The summary as JSON on the standard output, nothing else."),
    ] = False,
) -> None:
    """Run a scene headless, record it and sum it up."""
    if record is not None and no_record:
        raise SceneError("--record and --no-record contradict each other; give one of them")
    if record is not None and record.suffix != ".rrd":
        raise SceneError(f"--record is '{record}'; a recording's name ends in .rrd")
    path = catalog.scene_path(scene)
    chosen = read_scene_with_flags(
        path, vehicle, duration, timestep, settings, method, geoms=geoms, hull=hull, fill=fill
    )
    with err.status(
        "preparing (the first run after an installation compiles, which takes some seconds)"
    ):
        simulation = Simulation(chosen)
    target = None if no_record else record or Path("recordings") / f"{path.stem}.rrd"
    summary, file = _recorded(simulation, target, live=live)
    if as_json:
        plain = {
            k: None if isinstance(v, float) and not math.isfinite(v) else v
            for k, v in dataclasses.asdict(summary).items()
        }
        print(json.dumps(plain | {"recording": str(file) if file else None}, indent=2))
        return
    table = Table(title=summary.scene, show_header=False, title_justify="left")
    for name, value in summary.rows():
        table.add_row(name, value)
    out.print(table)
    if file is not None:
        out.print(
            f"open the recording: {viewer_command()} {quote(file)}", highlight=False, soft_wrap=True
        )


@app.command("list")
@report_errors
def list_() -> None:
    """List the scenes and models that ship."""
    for title, rows in (
        ("scenes", {name: read_scene(path).title for name, path in catalog.scenes().items()}),
        ("models", {name: catalog.summary(path) for name, path in catalog.models().items()}),
    ):
        table = Table(
            title=title, show_header=False, title_justify="left", box=None, padding=(0, 2)
        )
        for name, line in rows.items():
            table.add_row(name, line)
        out.print(table)


@app.command()
@report_errors
def view(
    scene: SCENE,
    vehicle: VEHICLE = None,
    timestep: TIMESTEP = None,
    method: METHOD = None,
    settings: SET = None,
    geoms: GEOMS = None,
    hull: HULL = None,
    fill: FILL = None,
) -> None:
    """Open MuJoCo's interactive viewer with the water acting and drawn in it."""
    from buoyancy_mj.viz.viewer import view as show

    show(
        Simulation(
            read_scene_with_flags(
                catalog.scene_path(scene),
                vehicle,
                None,
                timestep,
                settings,
                method,
                geoms=geoms,
                hull=hull,
                fill=fill,
            )
        )
    )


def _recorded(
    simulation: Simulation, target: Path | None, *, live: bool
) -> tuple[Summary, Path | None]:
    """Run to the end, recording as asked; a run that breaks off says what it leaves."""
    if target is None and not live:
        with _progress(simulation) as advance:
            for frame in simulation.frames():
                advance(frame.time)
        return simulation.summary(), None
    from buoyancy_mj.viz.recording import Recording

    recording = Recording(simulation, target, live=live)
    try:
        with _progress(simulation) as advance:
            for frame in simulation.frames():
                recording.add(frame)
                advance(frame.time)
    except BaseException as error:
        # whatever ends the run, what was recorded stays
        if not recording.closed:
            _left(recording.close(simulation.summary(), complete=False), simulation.data.time)
        if isinstance(error, KeyboardInterrupt):
            raise typer.Exit(130) from None
        raise
    summary = simulation.summary()
    return summary, recording.close(summary)


def _left(file: Path | None, time: float) -> None:
    if file is not None:
        err.print(
            f"the recording up to {time:.2f} s is in '{file}'", highlight=False, soft_wrap=True
        )


@contextmanager
def _progress(simulation: Simulation) -> Iterator[Callable[[float], None]]:
    """A bar in simulated time, where a person looks on."""
    if not err.is_terminal:
        with nullcontext():
            yield lambda time: None
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:.1f} s"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=err, transient=True) as progress:
        task = progress.add_task(simulation.scene.title, total=simulation.scene.duration)
        yield lambda time: progress.update(task, completed=time)

"""The command line: flags to a scene, then for each frame: record. No physics."""

import dataclasses
import itertools
import json
import math
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import mujoco
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.table import Table

from buoyancy_mj import catalog
from buoyancy_mj import sweep as sweeps
from buoyancy_mj.errors import BuoyancyError, SceneError
from buoyancy_mj.frames import Summary
from buoyancy_mj.paper.study import Study
from buoyancy_mj.scene import Scene, read_scene
from buoyancy_mj.simulation import Simulation

app = typer.Typer(help="Put water into MuJoCo.", no_args_is_help=True, add_completion=False, rich_markup_mode=None)
# what users name may hold brackets
_out, _err = Console(markup=False), Console(stderr=True, markup=False)

_SCENE = Annotated[str, typer.Argument(help="A scene file (.toml), or the name of one that ships; see 'list'.")]
_VEHICLE = Annotated[str | None, typer.Option(help="Put this vehicle into the scene: MJCF, URDF, or the name of a model.")]
_SET = Annotated[
    list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Any field, as water.waves.0.amplitude=0.1.")
]
_GEOMS = Annotated[list[str] | None, typer.Option(help="Which geoms displace water: name globs ('hull*') or group:N.")]
_HULL = Annotated[
    list[str] | None, typer.Option(help="Geoms that displace as their convex hull: 'frame*=convex', or 'convex'.")
]
_FILL = Annotated[list[str] | None, typer.Option(help="Flooded geoms, and the part that displaces: 'frame*=0.1'.")]
_METHOD = Annotated[
    str | None, typer.Option(help="How the submersion is found: exact (the default), convex_hull or sections.")
]
_TIMESTEP = Annotated[float | None, typer.Option(help="MuJoCo's timestep [s].")]


def _told(command: Callable[..., None]) -> Callable[..., None]:
    """Errors of ours as one sentence and exit status 1; notices as lines on the standard error."""

    @wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> None:
        def show(message: Warning | str, *_: Any, **__: Any) -> None:
            _err.print(f"note: {message}", style="yellow", highlight=False, soft_wrap=True)

        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.showwarning = show
            # MuJoCo's own, which would else go to a file in the working folder; what diverged is told as an error
            mujoco.set_mju_user_warning(lambda text: None if "Nan, Inf" in text else show(text))
            signal.signal(signal.SIGTERM, _interrupt)
            try:
                command(*args, **kwargs)
            except BuoyancyError as error:
                _err.print(f"error: {error}", style="red", highlight=False, soft_wrap=True)
                raise typer.Exit(1) from error

    return wrapped


def _interrupt(*_: Any) -> None:
    """End as by Ctrl-C."""
    raise KeyboardInterrupt


@app.command()
@_told
def run(
    scene: _SCENE,
    vehicle: _VEHICLE = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s].")] = None,
    timestep: _TIMESTEP = None,
    method: _METHOD = None,
    record: Annotated[Path | None, typer.Option(help="Where to record; otherwise recordings/SCENE.rrd.")] = None,
    no_record: Annotated[bool, typer.Option("--no-record", help="Do not record to a file.")] = False,
    live: Annotated[bool, typer.Option("--live", help="Stream to a Rerun viewer while it runs.")] = False,
    settings: _SET = None,
    geoms: _GEOMS = None,
    hull: _HULL = None,
    fill: _FILL = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="The summary as JSON on the standard output, nothing else.")
    ] = False,
) -> None:
    """Run a scene headless, record it and sum it up."""
    if record is not None and no_record:
        raise SceneError("--record and --no-record contradict each other; give one of them")
    if record is not None and record.suffix != ".rrd":
        raise SceneError(f"--record is '{record}'; a recording's name ends in .rrd")
    path = catalog.scene_path(scene)
    read = _read(path, vehicle, duration, timestep, settings, method, geoms=geoms, hull=hull, fill=fill)
    with _err.status("preparing (the first run after an installation compiles, which takes some seconds)"):
        simulation = Simulation(read)
    target = None if no_record else record or Path("recordings") / f"{path.stem}.rrd"
    summary, file = _recorded(simulation, target, live=live)
    if as_json:
        plain = {
            k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in dataclasses.asdict(summary).items()
        }
        print(json.dumps(plain | {"recording": str(file) if file else None}, indent=2))
        return
    table = Table(title=summary.scene, show_header=False, title_justify="left")
    for name, value in summary.rows():
        table.add_row(name, value)
    _out.print(table)
    if file is not None:
        _out.print(f"open the recording: {_rerun()} {_quoted(file)}", highlight=False, soft_wrap=True)


@app.command()
@_told
def sweep(
    scene: _SCENE,
    over: Annotated[
        list[str], typer.Option("--over", metavar="KEY=a:b:n", help="A field, and n values from a to b; repeat for a grid.")
    ],
    out: Annotated[
        Path, typer.Option(help="Results, a row for each run: .csv or .parquet. What is there is not run again.")
    ],
    draws: Annotated[int | None, typer.Option(min=1, help="So many random draws between a and b instead of a grid.")] = None,
    seed: Annotated[int, typer.Option(help="Of the draws.")] = 0,
    threads: Annotated[int, typer.Option(min=0, help="That step at once; 0 for one per core.")] = 0,
    vehicle: _VEHICLE = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s].")] = None,
    timestep: _TIMESTEP = None,
    method: _METHOD = None,
    settings: _SET = None,
    geoms: _GEOMS = None,
    hull: _HULL = None,
    fill: _FILL = None,
) -> None:
    """Run a scene many times over a grid or random draws of its fields, as batches."""
    fields = [sweeps.parsed(text) for text in over]
    path = catalog.scene_path(scene)
    common = tuple(_settings(vehicle, duration, timestep, settings, method, geoms=geoms, hull=hull, fill=fill))
    read_scene(path, common)
    values = sweeps.grid(fields) if draws is None else sweeps.draws(fields, draws, seed)
    plan = sweeps.Sweep(path, common, tuple(field.key for field in fields), tuple(values), out)
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    failed = 0
    with Progress(*columns, console=_err, transient=True, disable=not _err.is_terminal) as progress:
        task = progress.add_task(path.stem, total=len(values))
        for row in plan.run(threads):
            failed += row["status"] != "done"
            progress.advance(task)
    _out.print(f"{len(values)} runs, {failed} failed: {_quoted(out)}", highlight=False, soft_wrap=True)


@app.command("list")
@_told
def list_() -> None:
    """List the scenes and models that ship."""
    for title, rows in (
        ("scenes", {name: read_scene(path).title for name, path in catalog.scenes().items()}),
        ("models", {name: catalog.summary(path) for name, path in catalog.models().items()}),
    ):
        table = Table(title=title, show_header=False, title_justify="left", box=None, padding=(0, 2))
        for name, line in rows.items():
            table.add_row(name, line)
        _out.print(table)


@app.command()
@_told
def view(
    scene: _SCENE,
    vehicle: _VEHICLE = None,
    timestep: _TIMESTEP = None,
    method: _METHOD = None,
    settings: _SET = None,
    geoms: _GEOMS = None,
    hull: _HULL = None,
    fill: _FILL = None,
) -> None:
    """Open MuJoCo's interactive viewer with the water acting and drawn in it."""
    from buoyancy_mj.viewer import view as show  # needs GLFW and a display, which 'run' does not

    show(
        Simulation(
            _read(catalog.scene_path(scene), vehicle, None, timestep, settings, method, geoms=geoms, hull=hull, fill=fill)
        )
    )


@app.command()
@_told
def paper(
    only: Annotated[list[str] | None, typer.Option(help="Only these studies; a wrong name lists them.")] = None,
    out: Annotated[Path, typer.Option(help="Where tables and pictures go.")] = Path("docs/paper"),
    quick: Annotated[bool, typer.Option("--quick", help="Coarse and short, to see that it runs.")] = False,
) -> None:
    """Reproduce the source paper: its figures, and what holds of its claims."""
    from buoyancy_mj.paper import report, studies  # need matplotlib, which 'run' does not

    total = len(set(only)) if only else len(studies.STUDIES)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, console=_err, transient=True, disable=not _err.is_terminal) as progress:
        task = progress.add_task("", total=total)

        def begin(study: Study) -> None:
            progress.update(task, description=study.title, completed=next(done))

        done = itertools.count()
        rows = report.reproduce(out, only or (), quick=quick, begin=begin)
    table = Table(title="The source paper's claims", title_justify="left", show_lines=True)
    for name in report.HEADER:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    _out.print(table)
    _out.print(f"tables and pictures: {_quoted(out)}", highlight=False, soft_wrap=True)


def _read(
    path: Path,
    vehicle: str | None,
    duration: float | None,
    timestep: float | None,
    settings: list[str] | None,
    method: str | None,
    **words: list[str] | None,
) -> Scene:
    """The scene with the flags laid over it."""
    return read_scene(path, _settings(vehicle, duration, timestep, settings, method, **words))


def _settings(
    vehicle: str | None,
    duration: float | None,
    timestep: float | None,
    settings: list[str] | None,
    method: str | None,
    **words: list[str] | None,
) -> list[str]:
    """The flags as settings."""
    # first, so that settings may reach the method's options
    over = [f"method={{kind={json.dumps(method, ensure_ascii=False)}}}"] if method is not None else []
    over += settings or []
    if vehicle is not None:
        # relative to where the user stands, not to the scene
        own = vehicle if vehicle in catalog.models() else str(catalog.model_path(vehicle).resolve())
        over.append(f"vehicle={json.dumps(own, ensure_ascii=False)}")
    if duration is not None:
        over.append(f"duration={duration}")
    if timestep is not None:
        over.append(f"timestep={timestep}")
    return over + [f"{name}={json.dumps(given, ensure_ascii=False)}" for name, given in words.items() if given]


def _recorded(simulation: Simulation, target: Path | None, *, live: bool) -> tuple[Summary, Path | None]:
    """Run to the end, recording as asked; a run that breaks off says what it leaves."""
    if target is None and not live:
        with _progress(simulation) as advance:
            for frame in simulation.frames():
                advance(frame.time)
        return simulation.summary(), None
    from buoyancy_mj.recording import Recording  # Rerun takes half a second to import

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
        _err.print(f"the recording up to {time:.2f} s is in '{file}'", highlight=False, soft_wrap=True)


@contextmanager
def _progress(simulation: Simulation) -> Iterator[Callable[[float], None]]:
    """A bar in simulated time, where a person looks on."""
    if not _err.is_terminal:
        with nullcontext():
            yield lambda time: None
        return
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.completed:.1f} of {task.total:.1f} s"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=_err, transient=True) as progress:
        task = progress.add_task(simulation.scene.title, total=simulation.scene.duration)
        yield lambda time: progress.update(task, completed=time)


def _rerun() -> str:
    """The viewer's command, from the same environment."""
    beside = Path(sys.executable).with_name("rerun")
    return _quoted(beside) if beside.exists() else "rerun"


def _quoted(path: Path) -> str:
    text = str(path)
    return f"'{text}'" if " " in text else text

"""`sweep`: one scene many times."""

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import MofNCompleteColumn, TimeRemainingColumn

from buoyancy_mj.cli import console
from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.flags import RunFlags, SceneArgument, SelectionFlags
from buoyancy_mj.cli.signals import raise_received
from buoyancy_mj.errors import SweepError
from buoyancy_mj.scenes import catalog, ranges
from buoyancy_mj.scenes.places import LOCAL
from buoyancy_mj.scenes.scene import read_scene
from buoyancy_mj.scenes.sweep import Sweep

MOST_THREADS = 1024
"""Most threads that step at once."""
SOME_FAILED = 3
"""Exit status of a sweep that is complete, and some of whose runs failed."""


@command(
    examples=(
        "sweep auv_waves --over mass=20:25:6 --out masses.csv",
        "sweep auv_waves --over mass=20,25 --measure gyro --out gyro.csv",
    ),
)
def sweep(
    scene: SceneArgument,
    over: Annotated[
        list[str],
        typer.Option(
            metavar="KEY=a:b:n",
            help="Give a field n values from a to b, or a list, v1,v2,v3; repeat for a grid.",
        ),
    ],
    out: Annotated[
        Path,
        typer.Option(
            help="Write a row for each run into this .csv or .parquet; rows that are there stay."
        ),
    ],
    flags: RunFlags,
    selection: SelectionFlags,
    measure: Annotated[
        list[str] | None,
        typer.Option(
            metavar="SENSOR",
            help="Add columns of what this sensor measures, as gyro, or gyro.x; may be repeated.",
        ),
    ] = None,
    draws: Annotated[
        int | None,
        typer.Option(min=1, help="Draw this many random values between a and b, without a grid."),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random draws.")] = 0,
    threads: Annotated[
        int,
        typer.Option(min=0, max=MOST_THREADS, help="Step on this many threads; 0 is one per core."),
    ] = 0,
    on: Annotated[
        str,
        typer.Option(
            metavar="local|ray|ray://HOST:PORT",
            help="Run on the cores of this machine, or on a cluster of Ray.",
        ),
    ] = LOCAL,
) -> None:
    """Run a scene many times, over a grid or random draws.

    The runs go side by side on all cores. A sweep that was interrupted goes on where it was. The
    exit status is 3 if some runs failed.
    """
    # what varies, and what all runs share
    fields = [ranges.parse_range(text) for text in over]
    path = catalog.scene_path(scene)
    settings = (*flags.overrides(), *selection.overrides())
    read_scene(path, settings)
    values = ranges.grid(fields) if draws is None else ranges.draws(fields, draws, seed)
    keys = tuple(field.key for field in fields)
    plan = Sweep(
        path, settings, keys, tuple(values), out, flags.trust, measure=tuple(measure or ())
    )

    # the runs
    done, failures = 0, []
    columns = MofNCompleteColumn(), TimeRemainingColumn()
    with console.show_progress(path.stem, len(values), *columns) as update:
        try:
            for row in plan.run(threads, on):
                done += 1
                failures += [row] if row["status"] != "done" else []
                update(advance=1)
                raise_received()
        except KeyboardInterrupt:
            console.print_line(
                console.err,
                f"{done} of {len(values)} runs are done; the same command does the rest",
            )
            raise
    told = f"{done} runs, {len(failures)} failed: {console.quote_path(out)}"
    console.print_line(console.out, told)
    if not failures:
        return
    first = min(failures, key=lambda row: int(row["run"]))
    if len(failures) == done:
        raise SweepError(f"all {done} runs failed; the first: {first['reason']}")
    told = f"{len(failures)} of {done} runs failed; the first is run {first['run']}: "
    console.print_line(console.err, f"note: {told}{first['reason']}", style="yellow")
    raise typer.Exit(SOME_FAILED)

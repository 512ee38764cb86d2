"""`sweep`: a scene many times."""

from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

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
    flags_as_settings,
    quote,
    report_errors,
)
from buoyancy_mj.cli.common import (
    out as console,
)
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes import sweep as sweeps
from buoyancy_mj.scenes.scene import read_scene


@app.command()
@report_errors
def sweep(
    scene: SCENE,
    over: Annotated[
        list[str],
        typer.Option(
            "--over",
            metavar="KEY=a:b:n",
            help="A field, and n values from a to b; repeat for a grid.",
        ),
    ],
    out: Annotated[
        Path,
        typer.Option(
            help="Results, a row for each run: .csv or .parquet. What is there is not run again."
        ),
    ],
    draws: Annotated[
        int | None,
        typer.Option(min=1, help="So many random draws between a and b instead of a grid."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of the draws.")] = 0,
    threads: Annotated[int, typer.Option(min=0, help="That step at once; 0 for one per core.")] = 0,
    vehicle: VEHICLE = None,
    duration: Annotated[float | None, typer.Option(help="Simulated time [s].")] = None,
    timestep: TIMESTEP = None,
    method: METHOD = None,
    settings: SET = None,
    geoms: GEOMS = None,
    hull: HULL = None,
    fill: FILL = None,
) -> None:
    """Run a scene many times over a grid or random draws of its fields, as batches."""
    fields = [sweeps.parse_over(text) for text in over]
    path = catalog.scene_path(scene)
    common = tuple(
        flags_as_settings(
            vehicle, duration, timestep, settings, method, geoms=geoms, hull=hull, fill=fill
        )
    )
    read_scene(path, common)
    values = sweeps.grid(fields) if draws is None else sweeps.draws(fields, draws, seed)
    plan = sweeps.Sweep(path, common, tuple(field.key for field in fields), tuple(values), out)
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
    )
    failed = 0
    with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as progress:
        task = progress.add_task(path.stem, total=len(values))
        for row in plan.run(threads):
            failed += row["status"] != "done"
            progress.advance(task)
    console.print(
        f"{len(values)} runs, {failed} failed: {quote(out)}", highlight=False, soft_wrap=True
    )

"""`respond`: what a vehicle answers to waves."""

import json
from typing import Annotated

import typer
from rich.progress import MofNCompleteColumn, TimeRemainingColumn

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out, print_line, show_progress
from buoyancy_mj.cli.flags import Json, SceneFlags, SelectionFlags
from buoyancy_mj.cli.response_flags import (
    ResponseFiles,
    SeaFlags,
    SubjectArgument,
    parse_angles,
    parse_numbers,
    parse_points,
)
from buoyancy_mj.cli.response_tables import list_tables
from buoyancy_mj.cli.signals import raise_received
from buoyancy_mj.cli.sweeps import MOST_THREADS
from buoyancy_mj.errors import ResponseError
from buoyancy_mj.responses.respond import respond as measure
from buoyancy_mj.responses.responses import Responses
from buoyancy_mj.responses.subject import read_subject
from buoyancy_mj.responses.tables import to_values
from buoyancy_mj.values import read_number


@command(
    examples=(
        "respond catamaran --periods 1:6:11 --heading 0:180:7",
        "respond auv_sea_state_2 --periods 2,3,5 --csv raos.csv",
    )
)
def respond(
    model: SubjectArgument,
    flags: SceneFlags,
    selection: SelectionFlags,
    periods: Annotated[
        str,
        typer.Option(metavar="a:b:n", help="Periods of the waves [s]: n from a to b, or a,b,c."),
    ],
    in_sea: SeaFlags,
    files: ResponseFiles,
    heading: Annotated[
        str,
        typer.Option(
            metavar="a:b:n",
            help="Headings of the waves [deg]: 0 is a following sea, 180 a head sea.",
        ),
    ] = "180",
    amplitude: Annotated[
        float | None, typer.Option(help="Amplitude of the waves [m]; 1/20 of the draft by default.")
    ] = None,
    of: Annotated[
        list[str] | None, typer.Option(metavar="SENSOR", help="Measure a sensor too; repeatable.")
    ] = None,
    point: Annotated[
        list[str] | None,
        typer.Option(metavar="x,y,z", help="Measure a point of the root body too; repeatable [m]."),
    ] = None,
    depth: Annotated[float | None, typer.Option(help="Depth of the water [m].")] = None,
    threads: Annotated[
        int,
        typer.Option(min=0, max=MOST_THREADS, help="Step on this many threads; 0 is one per core."),
    ] = 0,
    all_rows: Annotated[
        bool, typer.Option("--all", help="Show every row, however many headings there are.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Measure response amplitude operators, by regular waves or in a sea.

    The vehicle is held softly at its place and heading. A model is put into fresh water with the
    pressure of Froude and Krylov; a scene keeps its own water.
    """
    waves, angles = parse_numbers("--periods", periods), parse_angles("--heading", heading)
    if depth is not None:
        depth = read_number(ResponseError, "--depth", depth, above=0.0)
    sea = in_sea.read()
    files.check()
    scene = read_subject(model, (*flags.overrides(), *selection.overrides()))

    # the runs
    runs = len(angles) * (1 if in_sea.irregular else len(waves))
    columns = MofNCompleteColumn(), TimeRemainingColumn()
    with show_progress(scene.title, runs, *columns) as update:

        def show() -> None:
            raise_received()
            update(advance=1)

        responses = measure(
            scene, waves, angles, amplitude=amplitude, sea=sea if in_sea.irregular else None,
            sensors=of or (), points=parse_points(point or ()), depth=depth, threads=threads,
            trust=flags.trust, each=show,
        )  # fmt: skip

    # what came of them
    files.write(responses, sea)
    if as_json:
        typer.echo(json.dumps(to_values(responses, sea, in_sea.duration), indent=2))
    else:
        _print_notes(responses)
        for table in list_tables(responses, sea, in_sea.duration, all_rows=all_rows):
            out.print(table)
            out.print()
        if sea is not None:
            covered = 100.0 * responses.covers(sea)
            print_line(out, f"these periods hold {covered:.3g} % of the energy of the sea")
    for doubt in responses.doubts():
        print_line(err, f"note: {doubt}", style="yellow")


def _print_notes(responses: Responses) -> None:
    """Say how it was measured, and the natural periods."""
    for note in responses.notes:
        out.print(note)
    heave, roll, pitch = responses.natural_periods
    out.print(
        f"Natural periods: heave {heave:.3g} s (h), roll {roll:.3g} s (r), pitch {pitch:.3g} s (p)."
    )
    out.print()

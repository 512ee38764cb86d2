"""`decay`: a vehicle is let go, and swings until it is still."""

import csv as csv_
import json
import math
from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out
from buoyancy_mj.cli.flags import Json, SceneFlags, SelectionFlags
from buoyancy_mj.cli.response_flags import SubjectArgument, check_file, import_charts, tell_files
from buoyancy_mj.errors import ResponseError
from buoyancy_mj.files import replace_file
from buoyancy_mj.responses.decay import RESTORED, Decay
from buoyancy_mj.responses.decay import decay as measure
from buoyancy_mj.values import read_number


@command(
    examples=(
        "decay oes_sphere --motion heave --from 1",
        "decay catamaran --motion roll --from 10 --plot roll.png",
    )
)
def decay(
    model: SubjectArgument,
    flags: SceneFlags,
    selection: SelectionFlags,
    motion: Annotated[
        str, typer.Option(metavar="|".join(RESTORED), help="The motion that is let go.")
    ] = "heave",
    start: Annotated[
        float | None,
        typer.Option(
            "--from",
            help="From where [m, or degrees]; by default a fifth of the draft, or 10 degrees.",
        ),
    ] = None,
    plot: Annotated[
        Path | None, typer.Option(help="Draw the decay into this .png, .svg or .pdf.")
    ] = None,
    csv: Annotated[
        Path | None, typer.Option(help="Write the motion over time into this .csv.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Let a vehicle go out of its rest, and fit period, damping and added mass.

    They are those of x'' + p1 x' + p2 |x'| x' + w^2 x = 0, beside the natural period of statics.
    """
    charts = None if plot is None else import_charts("--plot", plot, "decay_charts")
    check_file("--csv", csv, (".csv",))
    if start is not None:
        start = read_number(ResponseError, "--from", start)
        start = start if motion == "heave" else math.radians(start)
    settings = (*flags.overrides(), *selection.overrides())
    with err.status("letting it go"):
        found = measure(model, motion, start, settings=settings, trust=flags.trust)

    if csv is not None:
        _write_csv(found, csv)
    if plot is not None and charts is not None:
        charts.draw_decay(found, plot)
    if as_json:
        typer.echo(json.dumps(found.to_values(), indent=2))
    else:
        out.print(_make_table(found))
    tell_files(plot, csv)


def _make_table(found: Decay) -> Table:
    """What was measured, beside what statics say."""
    is_heave = found.motion == "heave"
    length, inertia = ("m", "kg") if is_heave else ("rad", "kg m^2")
    force = "N" if is_heave else "N m"
    rate = "m/s" if is_heave else "rad/s"
    fit = found.fit
    begin = f"{found.start:.4g} m" if is_heave else f"{math.degrees(found.start):.4g} degrees"
    half = 0.5 * abs(found.start)

    table = Table(
        title=f"{found.title}: {found.motion} let go from {begin}", title_justify="left",
        show_header=True, box=None, padding=(0, 1), pad_edge=False,
    )  # fmt: skip
    for column, justify in (("", "left"), ("measured", "right"), ("statics", "right")):
        table.add_column(column, justify=justify)  # type: ignore[arg-type]
    rows = (
        ("period [s]", fit.period, found.natural_period),
        ("period without added mass [s]", None, found.dry_period),
        (f"inertia of the vehicle [{inertia}]", None, found.inertia),
        (f"added mass, equivalent [{inertia}]", found.added_mass, found.given_added_mass),
        (f"stiffness [{force}/{length}]", None, found.stiffness),
        (f"linear damping B1 [{force}/({rate})]", found.linear_damping, None),
        (f"quadratic damping B2 [{force}/({rate})^2]", found.quadratic_damping, None),
        ("damping at half the start [% of critical]", 100.0 * fit.damping_ratio(half), None),
        ("damping of small swings [% of critical]", 100.0 * fit.damping_ratio(0.0), None),
        ("turning points", len(found.peaks.times), None),
    )
    for name, measured, by_statics in rows:
        table.add_row(name, *("" if x is None else f"{x:.4g}" for x in (measured, by_statics)))
    return table


def _write_csv(found: Decay, path: Path) -> None:
    """Write times and the motion."""
    unit = "m" if found.motion == "heave" else "rad"
    with replace_file(path) as part, part.open("w", newline="", encoding="utf-8") as file:
        writer = csv_.writer(file, lineterminator="\n")
        writer.writerow(["time [s]", f"{found.motion} [{unit}]"])
        writer.writerows(zip(found.times.tolist(), found.values.tolist(), strict=True))

"""`ballast`: the least mass that brings a model to a draft and attitude."""

from pathlib import Path
from typing import Annotated

import typer

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import out, print_line, quote_path
from buoyancy_mj.cli.flags import (
    ModelArgument,
    SelectionFlags,
    WaterOption,
    parse_still_water,
)
from buoyancy_mj.hulls.mjcf import write_mjcf
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import compile_spec
from buoyancy_mj.scenes.vehicles import read_vehicle
from buoyancy_mj.statics.ballast import ballast

Box = tuple[float, float, float, float, float, float]


@command(
    "ballast",
    examples=(
        "ballast sauvc_auv --reserve 0 --box -.1 -.1 -.2 .1 .1 0",
        "ballast my_boat.xml --draft 0.3 --out trimmed.xml",
    ),
)
def ballast_(
    model: ModelArgument,
    out_file: Annotated[
        Path | None, typer.Option("--out", help="Write the ballasted vehicle here, as MJCF.")
    ] = None,
    draft: Annotated[float | None, typer.Option(help="Draft to float at [m].")] = None,
    reserve: Annotated[
        float | None,
        typer.Option(help="Lift to keep under water [kg], 0 for neutral; instead of --draft."),
    ] = None,
    heel: Annotated[float, typer.Option(help="Heel to float at [rad].")] = 0.0,
    trim: Annotated[float, typer.Option(help="Trim to float at, bow down [rad].")] = 0.0,
    bg: Annotated[float | None, typer.Option(help="Height of B over G to reach [m].")] = None,
    masses: Annotated[
        list[str] | None,
        typer.Option(help="Sites that may take ballast: globs, 'ballast*' by default."),
    ] = None,
    foam: Annotated[
        list[str] | None,
        typer.Option(help="Sites that may take foam: globs, 'foam*' by default."),
    ] = None,
    box: Annotated[
        Box | None,
        typer.Option(
            help="Ballast anywhere between two corners instead, in the frame of the root body [m]."
        ),
    ] = None,
    water: WaterOption = None,
    *,
    selection: SelectionFlags,
) -> None:
    """Find the least ballast and foam for a draft and attitude.

    Instead of a draft, --reserve asks for a lift under water, and 0 for neutral buoyancy.
    """
    path = catalog.model_path(model)
    spec = read_vehicle(path)
    result = ballast(
        compile_spec(spec, path), parse_still_water(water), draft=draft, reserve=reserve, heel=heel,
        trim=trim, bg=bg, masses=[box[:3], box[3:]] if box is not None else masses or "ballast*",
        foam=foam or "foam*", selection=selection.selection,
    )  # fmt: skip

    # each item, and the vehicle with all of them
    for item in result.items:
        x, y, z = item.position.round(6) + 0.0
        where = f"({x:.4g}, {y:.4g}, {z:.4g}) m"
        print_line(out, f"{item.label}: {item.mass:.4g} kg of {item.kind} at {where}")
    at = result.hydrostatics
    carried = at.carried_mass
    part = f", of which gravity compensation carries {carried:.4g} kg" if carried else ""
    where = f"draft {at.draft:.4g} m" if draft is not None else "under water"
    print_line(
        out,
        f"{result.mass:.4g} kg added, {at.mass + at.carried_mass:.4g} kg in all{part}; {where}: "
        f"BG {at.BG:.4g} m, GM {at.GM:.4g} m, reserve {at.reserve:.4g} kg",
    )
    if out_file is not None:
        result.add_to(spec)
        print_line(out, f"written: {quote_path(write_mjcf(spec, out_file))}")

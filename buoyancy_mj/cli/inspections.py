"""`inspect` and `ballast`: a model before it is put to sea."""

import json
import tomllib
from pathlib import Path
from typing import Annotated

import mujoco
import typer

from buoyancy_mj import ballast as ballasts
from buoyancy_mj.cli.common import (
    FILL,
    GEOMS,
    HULL,
    app,
    err,
    out,
    quote,
    report_errors,
    viewer_command,
)
from buoyancy_mj.errors import ModelError, SceneError
from buoyancy_mj.hulls.mjcf import embed_meshes, write_mjcf
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.inspection import json_report, report
from buoyancy_mj.inspection.inspection import Inspection, inspect_model
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import compile_spec
from buoyancy_mj.scenes.vehicles import read_vehicle
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.toml import water_from_table

_MODEL = Annotated[str, typer.Argument(help="MJCF, URDF, or the name of a model that ships.")]
_WATER = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KEY=VALUE", help="The still water: density=1025 [kg/m^3], level=0.2 [m]."
    ),
]


@app.command("inspect")
@report_errors
def inspect_(
    model: _MODEL,
    water: _WATER = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="All of it as JSON on the standard output, nothing else.")
    ] = False,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Draw plots into this folder, with report.md."),
    ] = None,
    record: Annotated[
        Path | None, typer.Option(help="Hulls, waterplane and centres as a recording (.rrd).")
    ] = None,
    repair: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT.xml", help="Write the model with its meshes mended, where that is safe."
        ),
    ] = None,
    geoms: GEOMS = None,
    hull: HULL = None,
    fill: FILL = None,
) -> None:
    """Tell what of a model displaces water, what is wrong with its meshes, whether and how it floats."""
    if record is not None and record.suffix != ".rrd":
        raise SceneError(f"--record is '{record}'; a recording's name ends in .rrd")
    path = catalog.model_path(model)
    spec = read_vehicle(path)
    whole = compile_spec(spec, path)
    with err.status("inspecting"):
        selection = Selection(geoms=geoms, hull=hull, fill=fill)
        found = inspect_model(whole, _water(water), selection=selection, title=path.stem)
    if as_json:
        print(json.dumps(json_report.to_json(found), indent=2, allow_nan=False))
    else:
        out.print(report.to_tables(found))
    # what is written is told on the standard error, lest it stand in the JSON
    if plot is not None:
        err.print(
            f"plots and report: {quote(_plotted(found, plot))}", highlight=False, soft_wrap=True
        )
    if record is not None:
        from buoyancy_mj.viz.inspection_recording import record_inspection

        err.print(
            f"open the recording: {viewer_command()} {quote(record_inspection(found, record))}",
            highlight=False,
            soft_wrap=True,
        )
    if repair is not None:
        _repair(spec, whole, found, repair)
    if any(part.displaces and part.mesh is None for part in found.geoms):
        raise typer.Exit(1)


@app.command("ballast")
@report_errors
def ballast_(
    model: _MODEL,
    out_file: Annotated[
        Path | None, typer.Option("--out", help="Write the ballasted vehicle here, as MJCF.")
    ] = None,
    draft: Annotated[float | None, typer.Option(help="Wanted draft [m], floating; or")] = None,
    reserve: Annotated[
        float | None, typer.Option(help="wanted lift left under water [kg], 0 for neutral.")
    ] = None,
    heel: Annotated[float, typer.Option(help="Wanted heel [rad].")] = 0.0,
    trim: Annotated[float, typer.Option(help="Wanted trim, bow down [rad].")] = 0.0,
    bg: Annotated[float | None, typer.Option(help="Wanted height of B over G [m].")] = None,
    masses: Annotated[
        list[str] | None, typer.Option(help="Sites that may take ballast: globs; 'ballast*'.")
    ] = None,
    foam: Annotated[
        list[str] | None, typer.Option(help="Sites that may take foam: globs; 'foam*'.")
    ] = None,
    box: Annotated[
        tuple[float, float, float, float, float, float] | None,
        typer.Option(
            help="Ballast anywhere between two corners instead, in the frame of the root body [m]."
        ),
    ] = None,
    water: _WATER = None,
    geoms: GEOMS = None,
    hull: HULL = None,
    fill: FILL = None,
) -> None:
    """Find the least ballast and foam for a draft and attitude, or for neutral buoyancy."""
    path = catalog.model_path(model)
    spec = read_vehicle(path)
    found = ballasts(
        compile_spec(spec, path), _water(water), draft=draft, reserve=reserve, heel=heel, trim=trim, bg=bg,
        masses=[box[:3], box[3:]] if box is not None else masses or "ballast*", foam=foam or "foam*",
        selection=Selection(geoms=geoms, hull=hull, fill=fill),
    )  # fmt: skip
    for one in found.items:
        x, y, z = one.position.round(6) + 0.0
        out.print(
            f"{one.label}: {one.mass:.4g} kg of {one.kind} at ({x:.4g}, {y:.4g}, {z:.4g}) m",
            highlight=False,
        )
    at = found.hydrostatics
    out.print(
        f"{found.mass:.4g} kg added, {at.mass:.4g} kg in all; draft {at.draft:.4g} m, BG {at.BG:.4g} m, GM {at.GM:.4g} m, "
        f"reserve {at.reserve:.4g} kg",
        highlight=False,
        soft_wrap=True,
    )
    if out_file is not None:
        found.add_to(spec)
        out.print(f"written: {quote(write_mjcf(spec, out_file))}", highlight=False, soft_wrap=True)


def _water(words: list[str] | None) -> Water:
    """The still water that the flags describe."""
    try:
        table = tomllib.loads("\n".join(words or []))
    except tomllib.TOMLDecodeError as error:
        raise SceneError(
            f"--water {' '.join(words or [])}: {error}; write KEY=VALUE, as in density=1025"
        ) from error
    return water_from_table(table, "--water")


def _plotted(found: Inspection, folder: Path) -> Path:
    """Pictures and the report beside them."""
    try:
        from buoyancy_mj.inspection.charts import draw_charts
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("matplotlib"):
            raise
        raise ModelError(
            "--plot needs matplotlib, which is not installed: pip install 'buoyancy_mj[paper]', or leave it out"
        ) from error
    try:
        folder.mkdir(parents=True, exist_ok=True)
        pictures = [(caption, file.name) for caption, file in draw_charts(found, folder)]
        (folder / "report.md").write_text(report.to_markdown(found, pictures))
    except OSError as error:
        raise ModelError(
            f"cannot write into '{folder}': {error.strerror}; choose another folder (--plot)"
        ) from error
    return folder


def _repair(spec: mujoco.MjSpec, model: mujoco.MjModel, found: Inspection, path: Path) -> None:
    """Write the model with what could be mended."""
    mended = {}
    for part, geom in zip(found.geoms, range(model.ngeom), strict=True):
        was = part.diagnosis
        if was is not None and was.mesh is not None and was.repaired:
            asset = int(model.geom_dataid[geom])
            if asset in mended:
                continue
            mended[asset] = was.mesh
            change = was.mesh.volume - was.original_volume
            told = (
                f"mended {was.name}: {was.mesh.volume:.4g} m^3, {change:+.3g} m^3 against as it was"
            )
            err.print(told, highlight=False, soft_wrap=True)
    if not mended:
        err.print(
            "no mesh was mended: none needs it, or what does cannot be mended safely",
            highlight=False,
        )
        return
    place = write_mjcf(embed_meshes(spec, model, mended, path.parent / f"{path.stem}_meshes"), path)
    err.print(f"written: {quote(place)}", highlight=False, soft_wrap=True)

"""`inspect`: a model before it is put to sea."""

import json
from pathlib import Path
from typing import Annotated

import mujoco
import typer

from buoyancy_mj.cli.application import command
from buoyancy_mj.cli.console import err, out, print_line, quote_path, viewer_command
from buoyancy_mj.cli.flags import (
    Json,
    ModelArgument,
    SelectionFlags,
    WaterOption,
    check_recording_name,
    parse_still_water,
)
from buoyancy_mj.errors import ModelError, describe
from buoyancy_mj.files import replace_file, require_own
from buoyancy_mj.hulls.mjcf import embed_meshes, write_mjcf
from buoyancy_mj.inspection import json_report, report
from buoyancy_mj.inspection.inspection import Inspection, inspect_model
from buoyancy_mj.inspection.next_steps import list_next_steps
from buoyancy_mj.loads.added_mass import SOURCES, check_source
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import compile_spec
from buoyancy_mj.scenes.vehicles import read_vehicle

_REPORT_MARK = "<!-- written by buoyancy-mj inspect -->"
"""The last line of a report."""


@command(
    "inspect",
    examples=(
        "inspect sauvc_auv --water density=1025",
        "inspect my_auv.xml --details --plot report --record inspect.rrd",
    ),
)
def inspect_(
    model: ModelArgument,
    water: WaterOption = None,
    as_json: Json = False,
    details: Annotated[
        bool, typer.Option("--details", help="Tell of each geom and mesh, and of all rest poses.")
    ] = False,
    added_mass: Annotated[
        str | None,
        typer.Option(
            metavar="SOURCE", help=f"Report added mass: {', '.join(SOURCES[:-1])}; see the guide."
        ),
    ] = None,
    ballast: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VOLUME",
            help="Fill a tank, a compartment or a bladder: aft=0.002 [m^3]; may be repeated.",
        ),
    ] = None,
    plot: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Draw plots into this folder, beside a report.md."),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(help="Record hulls, waterplane and centres to this file (.rrd)."),
    ] = None,
    repair: Annotated[
        Path | None,
        typer.Option(
            metavar="OUT.xml", help="Write the model with its meshes mended, where that is safe."
        ),
    ] = None,
    *,
    selection: SelectionFlags,
) -> None:
    """Report what displaces water, and how a model floats.

    The report also tells what is wrong with meshes. Exit status 1 says that a mesh is refused.
    """
    check_recording_name(record)
    check_source(added_mass)
    path = catalog.model_path(model)
    spec = read_vehicle(path)
    compiled = compile_spec(spec, path)
    with err.status("inspecting"):
        inspection = inspect_model(
            compiled,
            parse_still_water(water),
            selection=selection.selection,
            title=path.stem,
            added_mass=added_mass,
            ballast=_parse_volumes(ballast or []),
        )

    # the report
    if as_json:
        typer.echo(json.dumps(json_report.to_json(inspection), indent=2, allow_nan=False))
    else:
        steps = list_next_steps(inspection, model, water or [], details=details)
        out.print(report.to_tables(inspection, steps, details=details))

    # files; the standard error tells of them, since the standard output may be JSON
    if plot is not None:
        _draw_plots(inspection, plot)
        print_line(err, f"plots and report: {quote_path(plot)}")
    if record is not None:
        from buoyancy_mj.viz.inspection_recording import record_inspection  # needs Rerun

        command_line = viewer_command(record_inspection(inspection, record))
        print_line(err, f"open the recording: {command_line}")
    if repair is not None:
        _write_repaired(spec, compiled, inspection, repair)
    if any(part.displaces and part.mesh is None for part in inspection.geoms):
        raise typer.Exit(1)


def _parse_volumes(words: list[str]) -> dict[str, float]:
    """Volumes [m^3] by name, of words NAME=VOLUME."""
    volumes = {}
    for word in words:
        name, _, volume = word.rpartition("=")
        try:
            volumes[name] = float(volume)
        except ValueError:
            name = ""
        if not name:
            raise ModelError(
                f"--ballast is {describe(word)}; write NAME=VOLUME [m^3], as aft=0.002"
            )
    return volumes


def _draw_plots(inspection: Inspection, folder: Path) -> None:
    """Draw plots into a folder, and write the report beside them."""
    try:
        from buoyancy_mj.inspection.charts import draw_charts
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("matplotlib"):
            raise
        raise ModelError(
            "--plot needs matplotlib, which is not installed: pip install 'buoyancy_mj[charts]', "
            "or leave it out"
        ) from error
    try:
        page = folder / "report.md"
        require_own(page, _REPORT_MARK)
        pictures = [(caption, file.name) for caption, file in draw_charts(inspection, folder)]
        with replace_file(page) as part:
            part.write_text(f"{report.to_markdown(inspection, pictures)}\n{_REPORT_MARK}\n")
    except OSError as error:
        raise ModelError(
            f"cannot write '{error.filename or folder}': {error.strerror}; choose another folder "
            "(--plot)"
        ) from error


def _write_repaired(
    spec: mujoco.MjSpec, model: mujoco.MjModel, inspection: Inspection, path: Path
) -> None:
    """Write the model with the meshes that could be mended."""
    mended: dict[int, TriMesh] = {}
    for part, geom in zip(inspection.geoms, range(model.ngeom), strict=True):
        diagnosis = part.diagnosis
        asset = int(model.geom_dataid[geom])
        if diagnosis is None or diagnosis.mesh is None or not diagnosis.repaired or asset in mended:
            continue
        mesh = mended[asset] = diagnosis.mesh
        change = mesh.volume - diagnosis.original_volume
        print_line(
            err, f"mended {diagnosis.name}: {mesh.volume:.4g} m^3, a change of {change:+.3g} m^3"
        )
    if not mended:
        print_line(err, "no mesh was mended: none needs it, or none that does can be mended safely")
        return
    folder = path.parent / f"{path.stem}_meshes"
    file = write_mjcf(embed_meshes(spec, model, mended, folder), path)
    print_line(err, f"written: {quote_path(file)}")

"""An `Inspection` as a Rerun recording: vessels at rest, righting arms and the report."""

from pathlib import Path

import manifold3d
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.inspection import report
from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.vessels import VesselInspection
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.meshes.surface import to_manifold
from buoyancy_mj.statics.curves import compute_waterline
from buoyancy_mj.statics.hydrostatics import Hydrostatics
from buoyancy_mj.statics.vessel import Vessel
from buoyancy_mj.viz.blueprints import RIGHT, inspection_blueprint
from buoyancy_mj.viz.centre_labels import draw_centres
from buoyancy_mj.viz.righting_chart import RightingChart
from buoyancy_mj.viz.rrd import RrdFile
from buoyancy_mj.viz.triangles import both_sides, rectangle, smooth_mesh

DRY = (225, 190, 90)
WET = (60, 120, 210)
FLOODED = (170, 170, 170)
WATERPLANE = (120, 200, 255, 110)
WATERLINE = (255, 255, 255)
SEA = (70, 150, 215, 30)
TRANSLUCENT = 110
"""Alpha of hulls."""
FINENESS = 24.0
"""Length of a vessel over the longest edge with which its hulls are drawn."""


def record_inspection(inspection: Inspection, path: Path) -> Path:
    """Write an inspection as a recording.

    Returns:
        Where the file is.

    Raises:
        RecordingError: the file cannot be written.
    """
    stream = rr.RecordingStream("buoyancy_mj_inspection")
    file = RrdFile(path, stream)
    try:
        _draw(stream, inspection)
        file.write()
    except BaseException:
        if not file.closed:
            file.discard()
        raise
    return file.close(complete=True)


def _draw(stream: rr.RecordingStream, inspection: Inspection) -> None:
    """Draw the report and the vessels."""
    # the layout, which looks at the first vessel
    floating = inspection.vessels
    look_at = floating[0].at_rest.position if floating else np.zeros(3)
    size = _size(floating[0].at_rest) if floating else 1.0
    arms = {one.total.body: one.righting for one in floating if one.righting is not None}
    chart = RightingChart(arms) if arms else None
    stream.send_blueprint(inspection_blueprint(inspection.title, look_at, size, chart))

    # the report and the vessels
    text = rr.TextDocument(report.to_markdown(inspection), media_type="text/markdown")
    stream.log("report", text, static=True)
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    if chart is not None:
        chart.draw(stream)
    for one in floating:
        _draw_vessel(stream, rr.escape_entity_path_part(one.total.body), one)


def _draw_vessel(stream: rr.RecordingStream, name: str, floating: VesselInspection) -> None:
    """Draw one vessel, with its waterplane and centres if it rests."""
    vessel = floating.at_rest
    entity = f"world/{name}"
    _draw_hulls(stream, entity, vessel)
    _draw_sea(stream, entity, vessel)
    if floating.rest is None:
        buoyancy = vessel.position + vessel.rotation @ vessel.centroid
        centres = {"G": vessel.position, "B": buoyancy}
        draw_centres(stream, entity, centres, _size(vessel), RIGHT, vessel.water.level)
        return
    hydrostatics = floating.rest.hydrostatics
    _draw_waterplane(stream, entity, vessel, hydrostatics.draft)
    centres = _centres(hydrostatics, _size(vessel))
    draw_centres(stream, entity, centres, _size(vessel), RIGHT, vessel.water.level)


def _draw_hulls(stream: rr.RecordingStream, entity: str, vessel: Vessel) -> None:
    """Draw the hulls, coloured by what of them is under water."""
    longest = _size(vessel) / FINENESS
    for hull, mesh in zip(vessel.hulls, vessel.meshes, strict=True):
        placed = mesh.transformed(vessel.rotation, vessel.position)
        smooth = smooth_mesh(*refine(placed.vertices, placed.faces, longest))
        is_wet = smooth.vertices[:, 2] < vessel.water.level
        colours = np.where(is_wet[:, None], WET if hull.fill == 1.0 else FLOODED, DRY)
        shown = rr.Mesh3D(
            vertex_positions=smooth.vertices,
            triangle_indices=smooth.faces,
            vertex_normals=smooth.normals,
            vertex_colors=colours.astype(np.uint8),
            # what is inside shows through
            albedo_factor=(255, 255, 255, TRANSLUCENT),
        )
        stream.log(f"{entity}/hull/{rr.escape_entity_path_part(hull.name)}", shown, static=True)


def _draw_sea(stream: rr.RecordingStream, entity: str, vessel: Vessel) -> None:
    """Draw a square of the still water around the vessel."""
    half = 0.9 * _size(vessel)
    corners, faces = rectangle([half, half])
    corners += [*vessel.position[:2], vessel.water.level]
    _draw_sheet(stream, f"{entity}/sea", corners, faces, SEA)


def _draw_waterplane(stream: rr.RecordingStream, entity: str, vessel: Vessel, draft: float) -> None:
    """Draw the waterline, and the waterplane that it encloses."""
    level = vessel.water.level
    lines = compute_waterline(vessel, vessel.rotation, draft) + vessel.position[:2]
    segments = np.concatenate([lines, np.full((*lines.shape[:2], 1), level)], axis=-1)
    strips = rr.LineStrips3D(segments, colors=WATERLINE, radii=0.003 * _size(vessel))
    stream.log(f"{entity}/waterline", strips, static=True)

    hulls = (mesh.transformed(vessel.rotation, vessel.position) for mesh in vessel.meshes)
    corners = np.concatenate([_cut(hull, level) for hull in hulls])
    if len(corners):
        faces = np.arange(len(corners)).reshape(-1, 3)
        _draw_sheet(stream, f"{entity}/waterplane", corners, faces, WATERPLANE)


def _draw_sheet(
    stream: rr.RecordingStream,
    entity: str,
    corners: NDArray[np.float64],
    faces: NDArray[np.int64],
    colour: tuple[int, int, int, int],
) -> None:
    """Draw a flat mesh that is seen from both sides."""
    sheet = rr.Mesh3D(
        vertex_positions=corners, triangle_indices=both_sides(faces), albedo_factor=colour
    )
    stream.log(entity, sheet, static=True)


def _centres(hydrostatics: Hydrostatics, size: float) -> dict[str, NDArray[np.float64]]:
    """The points (3,) [m] of a vessel at rest, by their letters in `centre_labels.NAMES`."""
    points = {"G": hydrostatics.centre_of_gravity, "B": hydrostatics.centre_of_buoyancy}
    if hydrostatics.waterplane_area <= 0.0:
        return points
    points["F"] = hydrostatics.centre_of_flotation

    # metacentres stand over the centre of buoyancy; those far above the vessel would dwarf it
    for name, radius in (("Mt", hydrostatics.BMt), ("Ml", hydrostatics.BMl)):
        if radius < 2.0 * size:
            points[name] = hydrostatics.centre_of_buoyancy + np.array([0.0, 0.0, radius])
    return points


def _cut(mesh: TriMesh, level: float) -> NDArray[np.float64]:
    """Corners (3 n, 3) [m] of triangles that fill a cut; none where the mesh is no manifold."""
    solid = to_manifold(*mesh.compact)
    polygons = [] if solid is None else solid.slice(level).to_polygons()
    if not polygons:
        return np.empty((0, 3))
    corners = np.concatenate(polygons)[np.asarray(manifold3d.triangulate(polygons)).ravel()]
    return np.column_stack([corners, np.full(len(corners), level)])


def _size(vessel: Vessel) -> float:
    """Length of a vessel [m]."""
    return 2.0 * vessel.radius

"""An `Inspection` as a Rerun recording: hulls at rest, waterplane, centres, metacentres, righting arm, report."""

from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import rerun as rr
import rerun.blueprint as rrb
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.inspection import report
from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.vessels import VesselInspection
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.meshes.surface import to_manifold
from buoyancy_mj.statics.curves import compute_waterline
from buoyancy_mj.statics.vessel import Vessel
from buoyancy_mj.viz.rrd import RrdFile

DRY, WET, FLOODED = (225, 190, 90), (60, 120, 210), (170, 170, 170)
WATERPLANE, WATERLINE, SEA = (120, 200, 255, 110), (255, 255, 255), (70, 150, 215, 30)
POINTS = {
    "G": (230, 60, 60),
    "B": (60, 90, 240),
    "F": (255, 255, 255),
    "Mt": (60, 190, 90),
    "Ml": (150, 220, 60),
}
"""Centre of gravity, of buoyancy and of flotation, transverse and longitudinal metacentre."""
TRANSLUCENT = 110
"""Alpha of hulls."""
FINENESS = 24.0
"""Size of a hull over the longest edge with which it is drawn."""


def record_inspection(found: Inspection, path: Path) -> Path:
    """Write an inspection as a recording; where it lies.

    Raises:
        RecordingError: the file cannot be written.
    """
    file = RrdFile(path)
    stream = rr.RecordingStream("buoyancy_mj_inspection")
    file.follow(stream)
    stream.send_blueprint(_blueprint(found))
    stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    stream.log(
        "report",
        rr.TextDocument(report.to_markdown(found), media_type="text/markdown"),
        static=True,
    )
    for floating in found.vessels:
        _log(stream, f"world/{rr.escape_entity_path_part(floating.total.body)}", floating)
    file.write()
    return file.close(complete=True)


def _blueprint(found: Inspection) -> rrb.Blueprint:
    """The vessel beside the report and the righting arms."""
    look_at, size = np.zeros(3), 1.0
    for floating in found.vessels[:1]:
        vessel = floating.at_rest
        look_at, size = vessel.position, 2.0 * vessel.radius
    view = rrb.Spatial3DView(
        origin="world",
        name=found.title,
        background=rrb.Background(color=[24, 30, 40]),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            position=look_at + size * np.array([-0.6, -1.3, 0.5]),
            look_target=look_at,
            eye_up=[0, 0, 1],
        ),
    )
    beside: list[Any] = [rrb.TextDocumentView(origin="report", name="report")]
    if any(floating.righting is not None for floating in found.vessels):
        beside.append(rrb.TimeSeriesView(origin="righting", name="GZ [m] over heel [degrees]"))
    return rrb.Blueprint(
        rrb.Horizontal(
            view, rrb.Vertical(*beside, row_shares=[3, 2][: len(beside)]), column_shares=[3, 2]
        ),
        rrb.TimePanel(state="hidden"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _log(stream: rr.RecordingStream, entity: str, floating: VesselInspection) -> None:
    """One vessel."""
    vessel = floating.at_rest
    level = vessel.water.level
    size = 2.0 * vessel.radius
    for hull, mesh in zip(vessel.hulls, vessel.meshes, strict=True):
        placed = mesh.transformed(vessel.rotation, vessel.position)
        stream.log(
            f"{entity}/hull/{rr.escape_entity_path_part(hull.name)}",
            _hull(placed, level, size, WET if hull.fill == 1.0 else FLOODED),
            static=True,
        )
    centre = np.array([*vessel.position[:2], level])
    half = 0.9 * size
    corners = centre + half * np.array(
        [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]
    )
    sea = rr.Mesh3D(
        vertex_positions=corners,
        triangle_indices=[[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]],
        albedo_factor=SEA,
    )
    stream.log(f"{entity}/sea", sea, static=True)
    if floating.rest is None:
        _log_points(
            stream,
            entity,
            {"G": vessel.position, "B": vessel.position + vessel.rotation @ vessel.centroid},
            size,
        )
        return
    at = floating.rest.hydrostatics
    _log_waterplane(stream, entity, vessel, at.draft, size)
    points = {"G": at.centre_of_gravity, "B": at.centre_of_buoyancy}
    if at.waterplane_area > 0.0:
        points["F"] = at.centre_of_flotation
        # metacentres stand over the centre of buoyancy; those far above the vessel would dwarf it
        rises = {"Mt": at.BMt, "Ml": at.BMl}
        points |= {
            name: at.centre_of_buoyancy + np.array([0.0, 0.0, rise])
            for name, rise in rises.items()
            if rise < 2.0 * size
        }
    _log_points(stream, entity, points, size)
    arm = floating.righting
    if arm is not None:
        name = f"righting/{rr.escape_entity_path_part(floating.total.body)}"
        stream.send_columns(
            name,
            indexes=[
                rr.TimeColumn(
                    "heel [degrees]", sequence=np.round(np.degrees(arm.heel)).astype(np.int64)
                )
            ],
            columns=rr.Scalars.columns(scalars=arm.gz),
        )


def _hull(mesh: TriMesh, level: float, size: float, wet: tuple[int, int, int]) -> rr.Mesh3D:
    """A hull, coloured by what is under water."""
    vertices, faces = refine(mesh.vertices, mesh.faces, size / FINENESS)
    smooth = trimesh.graph.smooth_shade(trimesh.Trimesh(vertices, faces, process=False), angle=0.6)
    under = np.asarray(smooth.vertices)[:, 2] < level
    return rr.Mesh3D(
        vertex_positions=smooth.vertices,
        triangle_indices=smooth.faces,
        vertex_normals=smooth.vertex_normals,
        vertex_colors=np.where(under[:, None], wet, DRY).astype(np.uint8),
        # what is inside shows through
        albedo_factor=(255, 255, 255, TRANSLUCENT),
    )


def _log_waterplane(
    stream: rr.RecordingStream, entity: str, vessel: Vessel, draft: float, size: float
) -> None:
    """The waterline, and what it encloses."""
    lines = compute_waterline(vessel, vessel.rotation, draft)
    level = vessel.water.level
    segments = np.concatenate(
        [lines + vessel.position[:2], np.full((*lines.shape[:2], 1), level)], axis=-1
    )
    stream.log(
        f"{entity}/waterline",
        rr.LineStrips3D(segments, colors=WATERLINE, radii=0.003 * size),
        static=True,
    )
    triangles = [
        _cut(mesh.transformed(vessel.rotation, vessel.position), level) for mesh in vessel.meshes
    ]
    corners = np.concatenate(triangles)
    if len(corners):
        index = np.arange(len(corners)).reshape(-1, 3)
        plane = rr.Mesh3D(
            vertex_positions=corners,
            triangle_indices=np.vstack([index, index[:, ::-1]]),
            albedo_factor=WATERPLANE,
        )
        stream.log(f"{entity}/waterplane", plane, static=True)


def _cut(mesh: TriMesh, level: float) -> NDArray[np.float64]:
    """Corners (3 n, 3) [m] of triangles that fill a cut; none where the mesh is no manifold."""
    solid = to_manifold(*mesh.compact)
    polygons = [] if solid is None else solid.slice(level).to_polygons()
    if not polygons:
        return np.empty((0, 3))
    flat = np.concatenate(polygons)[np.asarray(manifold3d.triangulate(polygons)).ravel()]
    return np.column_stack([flat, np.full(len(flat), level)])


def _log_points(
    stream: rr.RecordingStream, entity: str, points: dict[str, NDArray[np.float64]], size: float
) -> None:
    names = list(points)
    stream.log(
        f"{entity}/centres",
        rr.Points3D(
            [points[name] for name in names],
            colors=[POINTS[name] for name in names],
            labels=names,
            radii=0.012 * size,
        ),
        static=True,
    )
    ends = [points["G"], points["B"]]
    stream.log(
        f"{entity}/centres/BG",
        rr.LineStrips3D([ends], colors=(200, 200, 200), radii=0.003 * size),
        static=True,
    )

"""`repair`: meshes as people have them become hulls, or are refused with the reason.

Each step repairs one kind of fault and notes it in a `Diagnosis`; each check refuses what no safe
repair can save.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.cache import Form, recall
from buoyancy_mj.meshes.cleaning import close_seams, merge_vertices, wind_alike
from buoyancy_mj.meshes.diagnosis import MEND, Diagnosis
from buoyancy_mj.meshes.holes import close_holes
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.pieces import find_crossings, join_pieces, turn_outward
from buoyancy_mj.meshes.surface import check_arrays, signed_volume

MOST_UNCERTAIN = 0.01
"""Fraction of a mesh's volume that may be uncertain before the mesh is refused."""
NOTICEABLE = 1e-3
"""Fraction of a mesh's volume enclosed wrongly that earns a notice; the rays err by less."""
SHORTEST = 1e-4
"""Longest side [m] of the smallest mesh that could float."""
SUSPICIOUS = 50.0
"""Longest side [m] above which a mesh was often drawn in millimetres."""
LONGEST = 1e3
"""Longest side [m] of the largest mesh that could float."""
_DIAGNOSES = Form("diagnosis", Diagnosis.to_arrays, Diagnosis.from_arrays)


def repair(vertices: ArrayLike, faces: ArrayLike, name: str = "mesh") -> tuple[TriMesh, list[str]]:
    """Make a hull of any mesh, and report each repair in a sentence.

    Vertices at the same place become one, and seams that rounding opened are closed. Faces without
    area are dropped. Faces are wound alike and outward. Small holes are closed; each makes the
    volume of a dome over it uncertain. Pieces that overlap are joined by a boolean union.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
        name: what messages call the mesh.

    Returns:
        The hull, and one sentence for each repair or doubt.

    Raises:
        MeshError: the mesh is empty, flat, absurdly scaled, open by more than 1 % of its volume,
            or crosses itself by as much. The message names `name` and says what to do.
    """
    report = diagnose(vertices, faces, name)
    if report.mesh is None:
        raise MeshError(report.refusal)
    return report.mesh, report.notices


def diagnose(
    vertices: ArrayLike, faces: ArrayLike, name: str = "mesh", mend: str = Diagnosis.mend
) -> Diagnosis:
    """Find the faults of a mesh and repair it as far as that is safe; see `repair`.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
        name: what messages call the mesh.
        mend: what helps beside a better mesh where no repair is safe: the end of a refusal.
    """
    return examine(vertices, faces).told_of(name, mend)


def examine(vertices: ArrayLike, faces: ArrayLike) -> Diagnosis:
    """Find the faults of a mesh that has no name yet, once for each mesh; see `diagnose`."""
    try:
        v, f = check_arrays(vertices, faces)
    except MeshError as error:
        return Diagnosis(refusal=str(error))
    return recall(_DIAGNOSES, (v, f), lambda: _diagnose(v, f))


def _diagnose(v: NDArray[np.float64], f: NDArray[np.int64]) -> Diagnosis:
    report = Diagnosis()
    try:
        report.mesh = _repair(report, v, f)
    except MeshError as error:
        report.refusal = str(error)
    return report


def _repair(report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]) -> TriMesh:
    """Repair a mesh step by step, each of which fills in its part of the report."""
    # measure it as it is
    report.triangles = len(f)
    report.original_volume = signed_volume(v, f)
    report.extents = tuple(np.ptp(v[np.unique(f)], axis=0).tolist())
    _check_scale(report)

    # one closed surface, wound outward
    v, f = merge_vertices(report, v, f)
    v, f = close_seams(report, v, f)
    f = wind_alike(report, v, f)
    v, f = close_holes(report, v, f)
    pieces = turn_outward(report, v, f)
    f = np.vstack(pieces)
    volume = signed_volume(v, f)
    _check_thickness(v, volume)
    _check_holes(report, volume)

    # no volume counted twice
    find_crossings(report, v, f)
    if report.doubled_volume > NOTICEABLE * volume and len(pieces) > 1:
        v, f = join_pieces(report, v, pieces)
    _check_crossings(report, signed_volume(v, f))
    return TriMesh(v, f)


def _check_scale(report: Diagnosis) -> None:
    """Refuse a size that no unit of length explains, and note one that suggests millimetres."""
    longest = max(report.extents)
    if SUSPICIOUS < longest <= LONGEST:
        report.notices.append(
            f"it is {longest:.3g} m long; "
            "if it was drawn in millimetres, set scale='0.001 0.001 0.001'"
        )
    elif not SHORTEST <= longest <= LONGEST:
        raise MeshError(
            f"its longest side is {longest:.3g} m, possible are {SHORTEST:g} to {LONGEST:g} m; "
            "scale the mesh (a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )


def _check_thickness(v: NDArray[np.float64], volume: float) -> None:
    """Refuse a flat mesh: one whose volume is nothing beside that of its bounding box."""
    sides = np.maximum(np.ptp(v, axis=0), 1e-300)
    if volume <= 1e-9 * float(np.prod(sides)):
        raise MeshError(
            "it is flat and encloses no volume; give it thickness, or leave the geom out"
        )


def _check_holes(report: Diagnosis, volume: float) -> None:
    """Refuse holes that make too much of the volume uncertain, and note the others."""
    if not report.holes:
        return
    uncertain = report.uncertain_volume
    edges = sum(hole.edges for hole in report.holes)
    count = len(report.holes)
    holes, put = ("hole", "puts") if count == 1 else ("holes", "put")
    finding = (
        f"{count} {holes} with {edges} edges {put} {uncertain:.3g} m^3 "
        f"({uncertain / volume:.2%} of its volume) in doubt"
    )
    if uncertain > MOST_UNCERTAIN * volume:
        raise MeshError(f"it is open: {finding}; close the mesh, {MEND}")
    report.notices.append(f"{finding}; they were closed")


def _check_crossings(report: Diagnosis, volume: float) -> None:
    """Refuse a surface that crosses itself too much, and note one that does so a little."""
    crossing = report.doubled_volume + report.inside_out_volume
    if crossing > MOST_UNCERTAIN * volume:
        raise MeshError(
            f"it crosses itself: about {report.doubled_volume:.3g} m^3 is enclosed twice and "
            f"{report.inside_out_volume:.3g} m^3 inside out, of {volume:.3g} m^3; "
            f"join its parts by a boolean union, {MEND}"
        )
    if crossing > NOTICEABLE * volume:
        report.notices.append(
            f"it crosses itself; about {crossing / volume:.2%} of its volume is in doubt"
        )

"""`GeomInspection`: a geom, whether it displaces water, and what is wrong with its mesh."""

import dataclasses
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.hulls.convex_choice import describe_convex_choice
from buoyancy_mj.hulls.geoms import diagnose_geom, find_sharing, read_geom_mesh
from buoyancy_mj.hulls.names import body_name, geom_kind, geom_name
from buoyancy_mj.hulls.verdicts import Verdict
from buoyancy_mj.meshes.convex import convex_hull
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.mesh import TriMesh

THIN = 0.02
"""Part of a mesh's size below which its walls are thin."""
HOLLOW = 0.3
"""Part of its convex hull's volume below which a mesh is hollow."""


@dataclasses.dataclass(frozen=True, eq=False)
class GeomInspection:
    """A geom, whether it displaces water, and its mesh."""

    name: str
    """Name of the geom."""
    body: str
    """Name of its body."""
    kind: str
    """Type of the geom: 'mesh', 'box', 'sphere', ..."""
    displaces: bool
    """Whether it displaces water."""
    reason: str
    """Why, or why not."""
    convex: bool
    """Whether it displaces as its convex hull."""
    fill: float
    """Part of its volume that displaces water."""
    mesh: TriMesh | None
    """Mesh in the frame of the geom; None where it displaces nothing, or was refused."""
    centroid: NDArray[np.float64] | None
    """Centroid of its volume in the frame of its body (3,) [m]; None without a mesh."""
    diagnosis: Diagnosis | None
    """What is wrong with its mesh; None for other geoms and for convex hulls."""
    problem: str
    """Why its mesh was refused, with the mend; '' if it was not."""
    notes: tuple[str, ...]
    """Sentences on what else looks odd."""


def inspect_geom(
    model: mujoco.MjModel,
    verdict: Verdict,
    geoms: Sequence[int],
    hull_shapes: Mapping[int, str],
    *,
    fill: float,
) -> GeomInspection:
    """Inspect a geom.

    Args:
        model: its model.
        verdict: whether it displaces water.
        geoms: indices of all geoms that displace water.
        hull_shapes: 'convex' by the index of each of them that displaces as its convex hull.
        fill: part of its volume that displaces water.
    """
    geom = verdict.geom
    mesh, diagnosis, problem = None, None, ""
    if verdict.displaces:
        mesh, diagnosis, problem = _read_mesh(model, geom, geoms, hull_shapes)
    notes: tuple[str, ...] = ()
    if mesh is not None and diagnosis is not None:
        convex = {g for g, shape in hull_shapes.items() if shape == "convex"}
        sharing = find_sharing(model, geom, geoms)
        choice = describe_convex_choice(model, convex | set(sharing), geoms)
        notes = _note_thin_walls(mesh, choice)
    return GeomInspection(
        name=geom_name(model, geom),
        body=body_name(model, int(model.geom_bodyid[geom])),
        kind=geom_kind(model, geom),
        displaces=verdict.displaces,
        reason=verdict.reason,
        convex=hull_shapes.get(geom) == "convex",
        fill=fill,
        mesh=mesh,
        centroid=None if mesh is None else _find_centroid(model, geom, mesh),
        diagnosis=diagnosis,
        problem=problem,
        notes=notes,
    )


def _read_mesh(
    model: mujoco.MjModel, geom: int, geoms: Sequence[int], hull_shapes: Mapping[int, str]
) -> tuple[TriMesh | None, Diagnosis | None, str]:
    """Mesh of a geom, its diagnosis, and why it is refused ('' if it is not)."""
    convex = hull_shapes.get(geom) == "convex"
    diagnosis = None if convex else diagnose_geom(model, geom, geoms, hull_shapes)
    if diagnosis is not None:
        return diagnosis.mesh, diagnosis, diagnosis.refusal
    arrays = read_geom_mesh(model, geom)
    assert arrays is not None
    try:
        if convex:
            return convex_hull(arrays[0], f"geom '{geom_name(model, geom)}'"), None, ""
        return TriMesh(*arrays), None, ""
    except MeshError as error:
        return None, None, str(error)


def _find_centroid(model: mujoco.MjModel, geom: int, mesh: TriMesh) -> NDArray[np.float64]:
    """Centroid of a geom's mesh in the frame of its body (3,) [m]."""
    body_from_geom = np.empty(9)
    mujoco.mju_quat2Mat(body_from_geom, model.geom_quat[geom])
    centroid = body_from_geom.reshape(3, 3) @ mesh.centroid + model.geom_pos[geom]
    return np.asarray(centroid, float)


def _note_thin_walls(mesh: TriMesh, choice: str) -> tuple[str, ...]:
    """Say so of a closed surface with two sides, whose inside the sea may enter.

    Args:
        mesh: the mesh.
        choice: how the user chooses its convex hull.
    """
    try:
        whole = convex_hull(mesh.compact[0]).volume
    except MeshError:
        # a plate so thin that it has no convex hull has no inside either
        return ()
    share = mesh.volume / whole
    thickness = 2.0 * mesh.volume / mesh.area
    if share >= HOLLOW or thickness >= THIN * whole ** (1.0 / 3.0):
        return ()
    return (
        f"its walls are about {1e3 * thickness:.3g} mm thick and it displaces {share:.1%} of its "
        "convex hull, as if the sea stood inside; if it is a closed hull, export its outer surface "
        f"alone, or take its convex hull ({choice})",
    )

"""From an `MjModel` to its hulls: the geoms that displace water, with their bodies and meshes."""

import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, MeshError
from buoyancy_mj.hulls.convex_choice import describe_convex_choice
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import geom_name
from buoyancy_mj.hulls.overlaps import join_overlapping
from buoyancy_mj.hulls.patterns import parse_fills, parse_shapes
from buoyancy_mj.hulls.places import locate_geom
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.verdicts import SOLID_TYPES, judge_geoms
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.cache import Form, recall
from buoyancy_mj.meshes.convex import convex_hull
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.repair import examine

_MESH, _BOX, _SPHERE, _ELLIPSOID, _CYLINDER, _CAPSULE = SOLID_TYPES
_PRIMITIVES: Mapping[int, Callable[[NDArray[np.float64]], TriMesh]] = {
    _BOX: shapes.box,
    _SPHERE: lambda size: shapes.sphere(size[0]),
    _ELLIPSOID: shapes.ellipsoid,
    _CYLINDER: lambda size: shapes.cylinder(size[0], size[1]),
    _CAPSULE: lambda size: shapes.capsule(size[0], size[1]),
}
"""What builds the mesh of a geom from its `geom_size`, by the type of the geom."""
_BUILT, _CONVEX = (
    Form(name, TriMesh.to_arrays, TriMesh.from_arrays) for name in ("primitive", "convex hull")
)


def find_hulls(
    model: mujoco.MjModel,
    selection: Selection = Selection(),
    bodies: Sequence[int] | None = None,
    leave_out: Collection[int] = (),
) -> tuple[Hull, ...]:
    """Find the hulls of a model; geoms of one body that overlap are joined into one.

    A repair of a mesh is reported as a `BuoyancyWarning`.

    Args:
        model: any model.
        selection: which geoms displace water, and as what.
        bodies: indices of the bodies whose geoms may displace; None for all.
        leave_out: indices of geoms that are left out of those that displace.

    Raises:
        ModelError: no geom is left, or a pattern or anything else in `<custom>` finds nothing to
            hold for.
        MeshError: a mesh that bounds no volume; the message names the geom.
    """
    verdicts = judge_geoms(model, selection, bodies)
    geoms = [verdict.geom for verdict in verdicts if verdict.displaces]
    shapes, fills = parse_shapes(model, geoms, selection), parse_fills(model, geoms, selection)
    return build_hulls(model, [geom for geom in geoms if geom not in leave_out], shapes, fills)


def build_hulls(
    model: mujoco.MjModel,
    geoms: Sequence[int],
    hull_shapes: Mapping[int, str],
    fills: Mapping[int, float],
) -> tuple[Hull, ...]:
    """Build the hulls of geoms; `find_hulls` chooses the geoms too.

    Args:
        model: any model.
        geoms: indices of the geoms that displace water.
        hull_shapes: 'convex' by the index of each geom that displaces as its convex hull.
        fills: the part of the volume that displaces, by the index of each geom that floods.

    Raises:
        MeshError: a mesh that bounds no volume; the message names the geom.
    """
    meshes: dict[tuple[Any, ...], TriMesh] = {}
    hulls = []
    for geom in geoms:
        mesh = _build_mesh(model, geom, geoms, hull_shapes, meshes)
        hulls.append(_build_hull(model, geom, mesh, fills.get(geom, 1.0)))
    return join_overlapping(hulls)


def diagnose_geom(
    model: mujoco.MjModel, geom: int, geoms: Sequence[int], hull_shapes: Mapping[int, str]
) -> Diagnosis | None:
    """Diagnose the mesh of a geom; None for a geom of another type.

    Args:
        model: any model.
        geom: index of the geom.
        geoms: indices of all geoms that displace water.
        hull_shapes: 'convex' by the index of each of them that displaces as its convex hull.
    """
    if model.geom_type[geom] != _MESH:
        return None
    arrays = read_geom_mesh(model, geom)
    assert arrays is not None
    found, name = examine(*arrays), describe_mesh(model, geom, geoms)
    if found.mesh is not None:
        return found.told_of(name)

    # the geoms that a convex hull would help, beside those that have theirs already
    sharing = find_sharing(model, geom, geoms)
    convex = {g for g, shape in hull_shapes.items() if shape == "convex"}
    choice = describe_convex_choice(model, convex | set(sharing), geoms)
    return found.told_of(name, f"take its convex hull ({choice}), or leave the geom out (--geoms)")


def read_geom_mesh(
    model: mujoco.MjModel, geom: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]] | None:
    """Vertices (n, 3) [m] and faces (m, 3) of a geom in its frame, unrepaired.

    None for a geom that bounds no volume: a plane, a height field, a signed distance field.
    """
    kind = int(model.geom_type[geom])
    if kind == _MESH:
        mesh = model.geom_dataid[geom]
        v, n = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        f, m = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        vertices = model.mesh_vert[v : v + n].astype(np.float64)
        return vertices, model.mesh_face[f : f + m].astype(np.int64)
    if kind not in _PRIMITIVES:
        return None
    primitive = _build_primitive(model, geom)
    return primitive.vertices, primitive.faces


def build_mesh(model: mujoco.MjModel, geom: int) -> TriMesh:
    """The mesh of one geom, repaired.

    Raises:
        MeshError: a mesh that bounds no volume; the message names the geom.
    """
    return _build_mesh(model, geom, [geom], {}, {})


def find_sharing(model: mujoco.MjModel, geom: int, geoms: Sequence[int]) -> list[int]:
    """Those of `geoms` that have the mesh of a geom."""
    of_mesh = (model.geom_type == _MESH) & (model.geom_dataid == model.geom_dataid[geom])
    return [g for g in geoms if of_mesh[g]]


def describe_mesh(model: mujoco.MjModel, geom: int, geoms: Sequence[int]) -> str:
    """What messages call the mesh of a geom: its asset, and those of `geoms` that share it."""
    asset = int(model.geom_dataid[geom])
    sharing = find_sharing(model, geom, geoms)
    others = f" and {len(sharing) - 1} more" if len(sharing) > 1 else ""
    return f"mesh '{model.mesh(asset).name}' of geom '{geom_name(model, sharing[0])}'{others}"


def _build_hull(model: mujoco.MjModel, geom: int, mesh: TriMesh, fill: float) -> Hull:
    """The hull of a geom, in the body that it moves with."""
    body = int(model.body_weldid[model.geom_bodyid[geom]])
    body_from_geom, position = locate_geom(model, geom, body)
    return Hull(
        geom=geom,
        body=body,
        name=geom_name(model, geom),
        mesh=mesh,
        body_from_geom=body_from_geom,
        position=position,
        fill=fill,
        geoms=(geom,),
    )


def _build_mesh(
    model: mujoco.MjModel,
    geom: int,
    geoms: Sequence[int],
    hull_shapes: Mapping[int, str],
    meshes: dict[tuple[Any, ...], TriMesh],
) -> TriMesh:
    """The mesh of a geom; `meshes` keeps one for all geoms of the same asset, or type and size."""
    is_mesh = model.geom_type[geom] == _MESH
    convex = hull_shapes.get(geom) == "convex"
    shape = [model.geom_dataid[geom]] if is_mesh else model.geom_size[geom]
    key = (convex, int(model.geom_type[geom]), *map(float, shape))
    if key not in meshes:
        if not is_mesh:
            meshes[key] = _build_primitive(model, geom)
        elif convex:
            arrays = read_geom_mesh(model, geom)
            assert arrays is not None
            meshes[key] = _wrap(arrays[0], describe_mesh(model, geom, geoms))
        else:
            meshes[key] = _repair_mesh(diagnose_geom(model, geom, geoms, hull_shapes))
    return meshes[key]


def _repair_mesh(diagnosis: Diagnosis | None) -> TriMesh:
    """The repaired mesh of a diagnosis, with a warning for each repair."""
    assert diagnosis is not None
    if diagnosis.mesh is None:
        raise MeshError(diagnosis.refusal)
    for notice in diagnosis.notices:
        warnings.warn(notice, BuoyancyWarning, stacklevel=2)
    return diagnosis.mesh


def _wrap(vertices: NDArray[np.float64], name: str) -> TriMesh:
    """The convex hull of the mesh of a geom, built once for each; messages call it `name`."""
    return recall(_CONVEX, (vertices,), lambda: convex_hull(vertices, name))


def _build_primitive(model: mujoco.MjModel, geom: int) -> TriMesh:
    """The mesh of a geom that is no mesh, built once for each type and size."""
    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    return recall(_BUILT, (kind, size), lambda: _PRIMITIVES[kind](size))

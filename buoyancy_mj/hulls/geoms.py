"""From `MjModel` to hulls: which geoms displace water, their body and their mesh."""

import functools
import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, MeshError
from buoyancy_mj.hulls.hull import Hull, join_overlapping
from buoyancy_mj.hulls.selection import (
    SOLIDS,
    Selection,
    geom_name,
    judge_geoms,
    parse_fills,
    parse_shapes,
)
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.repair import diagnose

_MESH, _BOX, _SPHERE, _ELLIPSOID, _CYLINDER, _CAPSULE = SOLIDS


def find_hulls(
    model: mujoco.MjModel,
    selection: Selection = Selection(),
    bodies: Sequence[int] | None = None,
) -> tuple[Hull, ...]:
    """The hulls of a model; geoms of one body that overlap are joined into one.

    Args:
        model: any model.
        selection: which geoms displace water, and as what.
        bodies: indices of the bodies whose geoms may; None for all.

    A repair of a mesh is reported as a `BuoyancyWarning`.

    Raises:
        ModelError: no geom is left, or a pattern matches none.
        MeshError: a mesh that bounds no volume; the message names the geom.
    """
    chosen = [v.geom for v in judge_geoms(model, selection, bodies) if v.displaces]
    shapes = parse_shapes(model, chosen, selection.hull)
    return build_hulls(model, chosen, shapes, parse_fills(model, chosen, selection.fill))


def build_hulls(
    model: mujoco.MjModel,
    chosen: Sequence[int],
    forms: Mapping[int, str],
    fills: Mapping[int, float],
) -> tuple[Hull, ...]:
    """The hulls of chosen geoms, with the shape and the fill of those that have one; see `find_hulls`."""
    known: dict[tuple[Any, ...], TriMesh] = {}
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return join_overlapping(
        [
            _hull(
                model, data, g, _mesh(model, g, forms.get(g) == "convex", known), fills.get(g, 1.0)
            )
            for g in chosen
        ]
    )


def diagnose_geom(model: mujoco.MjModel, geom: int) -> Diagnosis | None:
    """What is wrong with the mesh of a geom, once for each mesh; None for other geoms, with which nothing is."""
    if model.geom_type[geom] != _MESH:
        return None
    arrays = read_geom_mesh(model, geom)
    assert arrays is not None
    return _diagnosed(*(values.tobytes() for values in arrays), describe_mesh(model, geom))


def read_geom_mesh(
    model: mujoco.MjModel, geom: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]] | None:
    """Vertices (n, 3) [m] and faces (m, 3) of a geom in its frame as they are; None for planes and fields."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == _MESH:
        mesh = model.geom_dataid[geom]
        v, n = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        f, m = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        return model.mesh_vert[v : v + n].astype(np.float64), model.mesh_face[f : f + m].astype(
            np.int64
        )
    if kind not in SOLIDS:
        return None
    if kind == _BOX:
        solid = shapes.box(size)
    elif kind == _SPHERE:
        solid = shapes.sphere(size[0])
    elif kind == _ELLIPSOID:
        solid = shapes.ellipsoid(size)
    elif kind == _CYLINDER:
        solid = shapes.cylinder(size[0], size[1])
    else:
        solid = shapes.capsule(size[0], size[1])
    return solid.vertices, solid.faces


def _hull(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, mesh: TriMesh, fill: float
) -> Hull:
    """The hull of a geom, placed in the body that it moves with."""
    body = int(model.body_weldid[model.geom_bodyid[geom]])
    world_from_body = data.xmat[body].reshape(3, 3)
    return Hull(
        geom=geom,
        body=body,
        name=geom_name(model, geom),
        mesh=mesh,
        body_from_geom=world_from_body.T @ data.geom_xmat[geom].reshape(3, 3),
        position=world_from_body.T @ (data.geom_xpos[geom] - data.xpos[body]),
        fill=fill,
        geoms=(geom,),
    )


def _mesh(
    model: mujoco.MjModel, geom: int, convex: bool, known: dict[tuple[Any, ...], TriMesh]
) -> TriMesh:
    """The hull of a geom; one for all geoms of the same mesh asset, or of the same type and size."""
    is_mesh = model.geom_type[geom] == _MESH
    key = (convex, *((_MESH, int(model.geom_dataid[geom])) if is_mesh else _primitive(model, geom)))
    if key in known:
        return known[key]
    found = None if convex else diagnose_geom(model, geom)
    if found is not None:
        if found.mesh is None:
            raise MeshError(found.refusal)
        known[key] = found.mesh
        for notice in found.notices:
            warnings.warn(notice, BuoyancyWarning, stacklevel=2)
        return found.mesh
    arrays = read_geom_mesh(model, geom)
    assert arrays is not None
    known[key] = (
        shapes.convex_hull(arrays[0], describe_mesh(model, geom)) if is_mesh else TriMesh(*arrays)
    )
    return known[key]


def _primitive(model: mujoco.MjModel, geom: int) -> tuple[float, ...]:
    return (int(model.geom_type[geom]), *model.geom_size[geom].tolist())


def describe_mesh(model: mujoco.MjModel, geom: int) -> str:
    """What messages call the mesh of a geom."""
    asset = int(model.geom_dataid[geom])
    sharing = np.flatnonzero((model.geom_type == _MESH) & (model.geom_dataid == asset))
    others = f" and {len(sharing) - 1} more" if len(sharing) > 1 else ""
    return f"mesh '{model.mesh(asset).name}' of geom '{geom_name(model, int(sharing[0]))}'{others}"


@functools.lru_cache(maxsize=64)
def _diagnosed(vertices: bytes, faces: bytes, name: str) -> Diagnosis:
    """`diagnosed`, once for each mesh: the same vehicle is read again and again, for each run of a sweep."""
    return diagnose(
        np.frombuffer(vertices).reshape(-1, 3),
        np.frombuffer(faces, np.int64).reshape(-1, 3),
        name=name,
    )

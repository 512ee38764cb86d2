"""From `MjModel` to hulls: which geoms displace water, their body and their mesh."""

import dataclasses
import fnmatch
import functools
import warnings
from collections.abc import Sequence
from itertools import combinations

import manifold3d
import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj import shapes
from buoyancy_mj.errors import BuoyancyWarning, ModelError, choices
from buoyancy_mj.mending import mended
from buoyancy_mj.mesh import TriMesh

CUSTOM_TEXT = "buoyancy_geoms"
"""Name of the MJCF `<custom><text>` with which a vehicle chooses its own geoms."""
OVERLAP = 1e-3
"""Part of the smaller of two overlapping geoms that is worth a notice."""

_MESH, _BOX, _SPHERE, _ELLIPSOID, _CYLINDER, _CAPSULE = _SOLIDS = tuple(
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}")) for name in ("MESH", "BOX", "SPHERE", "ELLIPSOID", "CYLINDER", "CAPSULE")
)


@dataclasses.dataclass(frozen=True, eq=False)
class Hull:
    """One geom that displaces water."""

    geom: int
    """Index of the geom in the model."""
    body: int
    """Index of the body it moves with: bodies without a joint of their own are part of their parent."""
    name: str
    """Name of the geom, or 'BODY/TYPE ID' for one without."""
    mesh: TriMesh
    """Its mesh, in the geom's frame."""
    body_from_geom: NDArray[np.float64]
    """Rotation (3, 3) from the geom's frame to the body's."""
    position: NDArray[np.float64]
    """Origin of the geom's frame in the body's (3,) [m]."""

    @functools.cached_property
    def mesh_in_body(self) -> TriMesh:
        """The mesh in the frame of the body."""
        return self.mesh.transformed(self.body_from_geom, self.position)


def displacing_hulls(
    model: mujoco.MjModel, geoms: str | Sequence[str] | None = None, bodies: Sequence[int] | None = None
) -> tuple[Hull, ...]:
    """The hulls of a model.

    Of each moving body the collision geoms (contype or conaffinity not zero) displace water if it
    has any, otherwise its visual ones. `geoms`, or a text named 'buoyancy_geoms' in the model's
    `<custom>`, chooses otherwise: name globs, or `group:N`, separated by blanks or commas. Planes,
    height fields, signed distance fields and what cannot move never displace water.

    With `bodies` only geoms of those count.

    What was mended in a mesh, and volumes that overlap inside a body, are told as `BuoyancyWarning`.

    Raises:
        ModelError: no geom is left, or a pattern matches none.
        MeshError: a mesh that bounds no volume; the message names the geom.
    """
    solid = [g for g in range(model.ngeom) if model.geom_type[g] in _SOLIDS and model.body_weldid[model.geom_bodyid[g]]]
    if bodies is not None:
        solid = [g for g in solid if model.geom_bodyid[g] in bodies]
    chosen = _chosen(model, solid, _patterns(model, geoms))
    if not chosen:
        raise ModelError(
            "no geom of this model displaces water: it has no mesh, box, sphere, ellipsoid, capsule or cylinder "
            "on a body that can move; give the vehicle such a geom, and its body a joint"
        )
    known: dict[tuple[float, ...], TriMesh] = {}
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    hulls = tuple(_hull(model, data, g, _mesh(model, g, known)) for g in chosen)
    _tell_overlaps(model, hulls)
    return hulls


def geom_name(model: mujoco.MjModel, geom: int) -> str:
    """The geom's own name, or one made of its body, type and index."""
    name = model.geom(geom).name
    if name:
        return str(name)
    kind = mujoco.mjtGeom(int(model.geom_type[geom])).name.removeprefix("mjGEOM_").lower()
    return f"{body_name(model, int(model.geom_bodyid[geom]))}/{kind} {geom}"


def body_name(model: mujoco.MjModel, body: int) -> str:
    """The body's own name, or one made of its index."""
    return str(model.body(body).name) or f"body {body}"


def geom_mesh(model: mujoco.MjModel, geom: int) -> tuple[NDArray[np.float64], NDArray[np.int64]] | None:
    """Vertices (n, 3) [m] and faces (m, 3) of a geom in its frame as they are; None for planes and fields."""
    kind, size = model.geom_type[geom], model.geom_size[geom]
    if kind == _MESH:
        mesh = model.geom_dataid[geom]
        v, n = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        f, m = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
        return model.mesh_vert[v : v + n].astype(np.float64), model.mesh_face[f : f + m].astype(np.int64)
    if kind not in _SOLIDS:
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


def _patterns(model: mujoco.MjModel, geoms: str | Sequence[str] | None) -> list[str]:
    """The user's patterns, or the vehicle's own, or none."""
    if geoms is not None:
        parts = [geoms] if isinstance(geoms, str) else list(geoms)
        patterns = [word for part in parts for word in str(part).replace(",", " ").split()]
        if not patterns:
            raise ModelError("an empty choice of geoms displaces nothing; give name globs or group:N, or leave it out")
        return patterns
    texts = [i for i in range(model.ntext) if _text_name(model, i).rsplit("/", 1)[-1] == CUSTOM_TEXT]
    data = [bytes(model.text_data[model.text_adr[i] :][: model.text_size[i]]).split(b"\0")[0].decode() for i in texts]
    return [word for text in data for word in text.replace(",", " ").split()]


def _text_name(model: mujoco.MjModel, text: int) -> str:
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_TEXT, text) or ""


def _chosen(model: mujoco.MjModel, solid: list[int], patterns: list[str]) -> list[int]:
    """Geoms by pattern, or by the default of each body."""
    if not patterns:
        collides = {g: bool(model.geom_contype[g] or model.geom_conaffinity[g]) for g in solid}
        bodies_that_collide = {model.geom_bodyid[g] for g in solid if collides[g]}
        return [g for g in solid if collides[g] or model.geom_bodyid[g] not in bodies_that_collide]
    chosen: set[int] = set()
    for pattern in patterns:
        if pattern.startswith("group:"):
            found = [g for g in solid if str(model.geom_group[g]) == pattern.removeprefix("group:")]
        else:
            found = [g for g in solid if fnmatch.fnmatchcase(geom_name(model, g), pattern)]
        if not found:
            names = {geom_name(model, g) for g in solid} | {f"group:{model.geom_group[g]}" for g in solid}
            raise ModelError(f"no moving geom matches '{pattern}'; {choices(pattern, names)}")
        chosen.update(found)
    return sorted(chosen)


def _hull(model: mujoco.MjModel, data: mujoco.MjData, geom: int, mesh: TriMesh) -> Hull:
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
    )


def _mesh(model: mujoco.MjModel, geom: int, known: dict[tuple[float, ...], TriMesh]) -> TriMesh:
    """The hull of a geom; one for all geoms of the same mesh asset, or of the same type and size."""
    is_mesh = model.geom_type[geom] == _MESH
    asset = int(model.geom_dataid[geom])
    key = (_MESH, asset) if is_mesh else (int(model.geom_type[geom]), *model.geom_size[geom].tolist())
    if key in known:
        return known[key]
    arrays = geom_mesh(model, geom)
    assert arrays is not None
    if not is_mesh:
        known[key] = TriMesh(*arrays)
        return known[key]
    name = f"mesh '{model.mesh(asset).name}' of geom '{geom_name(model, geom)}'"
    mesh, notices = _mended(*(values.tobytes() for values in arrays), name)
    for notice in notices:
        warnings.warn(notice, BuoyancyWarning, stacklevel=2)
    known[key] = mesh
    return mesh


@functools.lru_cache(maxsize=64)
def _mended(vertices: bytes, faces: bytes, name: str) -> tuple[TriMesh, list[str]]:
    """`mended`, once for each mesh: the same vehicle is read again and again, for each run of a sweep."""
    return mended(np.frombuffer(vertices).reshape(-1, 3), np.frombuffer(faces, np.int64).reshape(-1, 3), name=name)


def _tell_overlaps(model: mujoco.MjModel, hulls: Sequence[Hull]) -> None:
    """Warn of volume that two geoms of one body both displace; geoms of one body never move apart."""
    boxes = {hull.geom: hull.mesh_in_body.bounds for hull in hulls}
    solid = functools.cache(_solid_in_body)
    by_body: dict[int, list[tuple[float, Hull, Hull]]] = {}
    for one, two in combinations(hulls, 2):
        (low, high), (other_low, other_high) = boxes[one.geom], boxes[two.geom]
        if one.body != two.body or (low >= other_high).any() or (other_low >= high).any():
            continue
        common = (solid(one) ^ solid(two)).volume()
        if common > OVERLAP * min(one.mesh.volume, two.mesh.volume):
            by_body.setdefault(one.body, []).append((common, one, two))
    for body, found in by_body.items():
        _, one, two = max(found, key=lambda overlap: overlap[0])
        whole = sum(hull.mesh.volume for hull in hulls if hull.body == body)
        doubled = sum(overlap[0] for overlap in found)
        more = f" and {len(found) - 1} more pairs" if len(found) > 1 else ""
        warnings.warn(
            f"body '{body_name(model, body)}': geoms '{one.name}' and '{two.name}'{more} overlap; {doubled:.3g} m^3 "
            f"({doubled / whole:.1%} of its volume) displaces water twice: choose geoms that do not overlap (--geoms)",
            BuoyancyWarning,
            stacklevel=4,
        )


def _solid_in_body(hull: Hull) -> manifold3d.Manifold:
    """A hull in the frame of its body, for booleans; empty, with a warning, where its mesh is no manifold."""
    mesh = hull.mesh_in_body
    solid = manifold3d.Manifold(manifold3d.Mesh64(mesh.vertices.copy(), mesh.faces.astype(np.uint64)))
    if solid.status() != manifold3d.Error.NoError:
        warnings.warn(
            f"geom '{hull.name}': more than two faces meet at an edge of its mesh; "
            "whether it overlaps other geoms is not known",
            BuoyancyWarning,
            stacklevel=5,
        )
        return manifold3d.Manifold()
    return solid

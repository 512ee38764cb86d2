"""Hulls of one body that overlap are joined, so that no volume displaces water twice."""

import dataclasses
import functools
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import manifold3d
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.hulls.hull import Hull, group_by_body
from buoyancy_mj.meshes.cache import Form, recall
from buoyancy_mj.meshes.components import label_components
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.overlaps import find_close_pairs
from buoyancy_mj.meshes.surface import to_manifold

OVERLAP = 1e-6
"""Common volume of two geoms, as a part of the smaller one, above which they are joined."""

_SolidOf = Callable[[int], manifold3d.Manifold | None]


class _Part(NamedTuple):
    """Hulls of one body that displace as one."""

    members: tuple[int, ...]
    """Their indices among the hulls of the body."""
    mesh: TriMesh | None
    """Their union, in the frame of the first; None for a hull that is joined with no other."""


class _Joints(NamedTuple):
    """How the hulls of one body are joined."""

    parts: tuple[_Part, ...]
    """Those that remain; a hull within a fuller one is in none."""
    crossed: tuple[int, ...]
    """Indices of hulls that may overlap others and are no manifold."""


def join_overlapping(hulls: Sequence[Hull]) -> tuple[Hull, ...]:
    """The hulls, those of one body that overlap joined into one, in the order of the model's geoms.

    Where hulls of different fill overlap, the common volume belongs to the fuller one. Where more
    than two faces meet at an edge of a hull, it is not joined, and a `BuoyancyWarning` says so.
    """
    joined: list[Hull] = []
    for of_body in group_by_body(hulls).values():
        joints = _find_joints(of_body)
        for index in joints.crossed:
            warnings.warn(
                f"geom '{of_body[index].name}': more than two faces meet at an edge of its mesh; "
                "where it overlaps other geoms, that volume displaces water twice",
                BuoyancyWarning,
                stacklevel=2,
            )
        for part in joints.parts:
            members = [of_body[index] for index in part.members]
            joined.append(_join(members, part.mesh) if part.mesh else members[0])
    return tuple(sorted(joined, key=lambda hull: hull.geom))


def _join(hulls: Sequence[Hull], mesh: TriMesh) -> Hull:
    """One hull in the place of several."""
    return dataclasses.replace(
        hulls[0],
        name=_join_names([hull.name for hull in hulls]),
        mesh=mesh,
        geoms=tuple(geom for hull in hulls for geom in hull.geoms),
    )


def _join_names(names: Sequence[str]) -> str:
    """All names of three at most, or two names and the number of the others."""
    return " + ".join(names if len(names) <= 3 else [*names[:2], f"{len(names) - 2} more"])


# finding, once for the same hulls


def _find_joints(hulls: Sequence[Hull]) -> _Joints:
    """Find how the hulls of one body are joined."""
    if len(hulls) == 1:
        return _Joints((_Part((0,), None),), ())
    parts = (
        *(hull.mesh.checksum for hull in hulls),
        np.array([hull.body_from_geom for hull in hulls]),
        np.array([hull.position for hull in hulls]),
        np.array([hull.fill for hull in hulls]),
    )
    return recall(_JOINTS, parts, lambda: _join_hulls(hulls))


def _join_hulls(hulls: Sequence[Hull]) -> _Joints:
    """Join the hulls of one body that overlap."""
    solid_of = functools.cache(lambda index: _build_solid(hulls[index]))

    # groups of hulls that overlap, directly or through others
    close = find_close_pairs([hull.mesh_in_body for hull in hulls])
    edges = [(i, j) for i, j in close if _overlap(hulls, i, j, solid_of)]
    labels = label_components(np.array(edges, np.int64), len(hulls))

    # one hull, or one for each fill, of each group
    parts: list[_Part] = []
    for label in dict.fromkeys(labels.tolist()):
        group = np.flatnonzero(labels == label).tolist()
        parts += _join_group(hulls, group, solid_of) if len(group) > 1 else [_Part((*group,), None)]
    looked_at = dict.fromkeys(index for pair in close for index in pair)
    crossed = tuple(index for index in looked_at if solid_of(index) is None)
    return _Joints(tuple(parts), crossed)


def _overlap(hulls: Sequence[Hull], i: int, j: int, solid_of: _SolidOf) -> bool:
    """Whether two hulls share more volume than rounding makes."""
    one, two = solid_of(i), solid_of(j)
    if one is None or two is None:
        return False
    common = float((one ^ two).volume())
    return common > OVERLAP * min(hulls[i].mesh.volume, hulls[j].mesh.volume)


def _build_solid(hull: Hull) -> manifold3d.Manifold | None:
    """A hull in the frame of its body, for booleans; None if it is no manifold."""
    return to_manifold(*hull.mesh_in_body.compact)


def _join_group(hulls: Sequence[Hull], group: Sequence[int], solid_of: _SolidOf) -> list[_Part]:
    """One part for each fill of a group, the fuller ones cut out of the others."""
    parts = []
    fuller = manifold3d.Manifold()
    for fill in sorted({hulls[i].fill for i in group}, reverse=True):
        alike = [i for i in group if hulls[i].fill == fill]
        union = manifold3d.Manifold.batch_boolean(
            [solid_of(i) for i in alike], manifold3d.OpType.Add
        )
        rest = union - fuller
        fuller = fuller + union

        # nothing is left of a hull that lies inside a fuller one
        if rest.volume() > OVERLAP * min(hulls[i].mesh.volume for i in alike):
            parts.append(_Part((*alike,), _to_mesh(hulls[alike[0]], rest)))
    return parts


def _to_mesh(hull: Hull, solid: manifold3d.Manifold) -> TriMesh:
    """The mesh of a solid in the frame of a hull's body, in the frame of the hull."""
    mesh = solid.to_mesh64()
    mesh_in_body = TriMesh(
        np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)
    )
    geom_from_body = hull.body_from_geom.T
    return mesh_in_body.transformed(geom_from_body, -geom_from_body @ hull.position)


# keeping


def _to_arrays(joints: _Joints) -> dict[str, NDArray[Any]]:
    """How hulls are joined as arrays, those of meshes by the number of their part."""
    sizes = [len(part.members) for part in joints.parts]
    arrays = {
        "crossed": np.array(joints.crossed, np.int64),
        "members": np.array([i for part in joints.parts for i in part.members], np.int64),
        "ends": np.cumsum(sizes, dtype=np.int64),
    }
    for number, part in enumerate(joints.parts):
        if part.mesh:
            arrays |= {f"{number} {name}": a for name, a in part.mesh.to_arrays().items()}
    return arrays


def _from_arrays(arrays: Mapping[str, NDArray[Any]]) -> _Joints:
    """How hulls are joined, of the arrays that `_to_arrays` gave."""
    meshes: dict[int, dict[str, NDArray[Any]]] = {}
    for title in arrays.keys() - {"crossed", "members", "ends"}:
        number, name = title.split()
        meshes.setdefault(int(number), {})[name] = arrays[title]
    members = np.split(arrays["members"], arrays["ends"][:-1])
    parts = [
        _Part((*group.tolist(),), TriMesh.from_arrays(meshes[i]) if i in meshes else None)
        for i, group in enumerate(members)
    ]
    return _Joints((*parts,), (*arrays["crossed"].tolist(),))


_JOINTS = Form("joints", _to_arrays, _from_arrays)

"""Hulls of one body that overlap are joined, so that no volume displaces water twice."""

import dataclasses
import functools
import warnings
from collections.abc import Callable, Sequence

import manifold3d
import numpy as np

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.hulls.hull import Hull, group_by_body
from buoyancy_mj.meshes.components import label_components
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.overlaps import find_close_pairs
from buoyancy_mj.meshes.surface import to_manifold

OVERLAP = 1e-6
"""Common volume of two geoms, as a part of the smaller one, above which they are joined."""

_SolidOf = Callable[[Hull], manifold3d.Manifold]


def join_overlapping(hulls: Sequence[Hull]) -> tuple[Hull, ...]:
    """The hulls, those of one body that overlap joined into one, in the order of the model's geoms.

    Where hulls of different fill overlap, the common volume belongs to the fuller one. Where more
    than two faces meet at an edge of a hull, it is not joined, and a `BuoyancyWarning` says so.
    """
    joined: list[Hull] = []
    for of_body in group_by_body(hulls).values():
        solid_of = functools.cache(_build_solid)

        # groups of hulls that overlap, directly or through others
        close = find_close_pairs([hull.mesh_in_body for hull in of_body])
        edges = [(i, j) for i, j in close if _overlap(of_body[i], of_body[j], solid_of)]
        labels = label_components(np.array(edges, np.int64), len(of_body))

        # one hull, or one for each fill, of each group
        for label in dict.fromkeys(labels.tolist()):
            group = [hull for hull, other in zip(of_body, labels, strict=True) if other == label]
            joined += _join_group(group, solid_of) if len(group) > 1 else group
    return tuple(sorted(joined, key=lambda hull: hull.geom))


def _overlap(one: Hull, two: Hull, solid_of: _SolidOf) -> bool:
    """Whether two hulls share more volume than rounding makes."""
    common = float((solid_of(one) ^ solid_of(two)).volume())
    return common > OVERLAP * min(one.mesh.volume, two.mesh.volume)


def _build_solid(hull: Hull) -> manifold3d.Manifold:
    """A hull in the frame of its body, for booleans; empty, with a warning, if no manifold."""
    solid = to_manifold(*hull.mesh_in_body.compact)
    if solid is None:
        warnings.warn(
            f"geom '{hull.name}': more than two faces meet at an edge of its mesh; "
            "where it overlaps other geoms, that volume displaces water twice",
            BuoyancyWarning,
            stacklevel=2,
        )
        return manifold3d.Manifold()
    return solid


def _join_group(group: Sequence[Hull], solid_of: _SolidOf) -> list[Hull]:
    """One hull for each fill of a group, the fuller ones cut out of the others."""
    joined = []
    fuller = manifold3d.Manifold()
    for fill in sorted({hull.fill for hull in group}, reverse=True):
        alike = [hull for hull in group if hull.fill == fill]
        union = manifold3d.Manifold.batch_boolean(
            [solid_of(hull) for hull in alike], manifold3d.OpType.Add
        )
        rest = union - fuller
        fuller = fuller + union

        # nothing is left of a hull that lies inside a fuller one
        if rest.volume() > OVERLAP * min(hull.mesh.volume for hull in alike):
            joined.append(_replace_mesh(alike, rest))
    return joined


def _replace_mesh(hulls: Sequence[Hull], solid: manifold3d.Manifold) -> Hull:
    """One hull in the place of several, with the mesh of a solid in the frame of their body."""
    mesh = solid.to_mesh64()
    mesh_in_body = TriMesh(
        np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)
    )
    first = hulls[0]
    geom_from_body = first.body_from_geom.T
    return dataclasses.replace(
        first,
        name=_join_names([hull.name for hull in hulls]),
        mesh=mesh_in_body.transformed(geom_from_body, -geom_from_body @ first.position),
        geoms=tuple(geom for hull in hulls for geom in hull.geoms),
    )


def _join_names(names: Sequence[str]) -> str:
    """All names of three at most, or two names and the number of the others."""
    return " + ".join(names if len(names) <= 3 else [*names[:2], f"{len(names) - 2} more"])

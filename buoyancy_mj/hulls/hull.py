"""`Hull`: a closed mesh on a body, that displaces water; and several of one body joined into one."""

import dataclasses
import functools
import warnings
from collections.abc import Callable, Sequence

import manifold3d
import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import to_manifold

_Solid = Callable[["Hull"], manifold3d.Manifold]
OVERLAP = 1e-6
"""Part of the smaller of two overlapping geoms from which on they are joined; below it is rounding."""


@dataclasses.dataclass(frozen=True, eq=False)
class Hull:
    """One geom that displaces water, or several of one body that overlap and displace as one."""

    geom: int
    """Index of the geom in the model; of the first of several."""
    body: int
    """Index of the body it moves with: bodies without a joint of their own are part of their parent."""
    name: str
    """Name of the geom, or 'BODY/TYPE ID' for one without; those of several with ' + ' between."""
    mesh: TriMesh
    """Its mesh, in the geom's frame."""
    body_from_geom: NDArray[np.float64]
    """Rotation (3, 3) from the geom's frame to the body's."""
    position: NDArray[np.float64]
    """Origin of the geom's frame in the body's (3,) [m]."""
    fill: float = 1.0
    """Part of the mesh's volume that displaces water, less than 1 for what floods."""
    geoms: tuple[int, ...] = ()
    """Indices of all geoms it is made of."""

    @property
    def displaced_volume(self) -> float:
        """Volume of water that it displaces fully submerged [m^3]."""
        return self.fill * self.mesh.volume

    @functools.cached_property
    def mesh_in_body(self) -> TriMesh:
        """The mesh in the frame of the body."""
        return self.mesh.transformed(self.body_from_geom, self.position)


def join_overlapping(hulls: Sequence[Hull]) -> tuple[Hull, ...]:
    """The hulls, those of one body that overlap joined by boolean union, so that no volume counts twice.

    Where hulls of different fill overlap, the common volume belongs to the fuller one.
    """
    result: list[Hull] = []
    for body in sorted({hull.body for hull in hulls}):
        own = [hull for hull in hulls if hull.body == body]
        solid = functools.cache(build_solid)
        near = find_close_pairs([hull.mesh_in_body for hull in own])
        edges = [(i, j) for i, j in near if _overlap(own[i], own[j], solid)]
        labels = trimesh.graph.connected_component_labels(
            np.array(edges, np.int64).reshape(-1, 2), len(own)
        )
        for label in dict.fromkeys(labels.tolist()):
            group = [hull for hull, other in zip(own, labels, strict=True) if other == label]
            result += _united(group, solid) if len(group) > 1 else group
    return tuple(sorted(result, key=lambda hull: hull.geom))


def build_solid(hull: Hull) -> manifold3d.Manifold:
    """A hull in the frame of its body, for booleans; empty, with a warning, where its mesh is no manifold."""
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


def find_close_pairs(meshes: Sequence[TriMesh]) -> list[tuple[int, int]]:
    """Pairs of meshes whose bounding boxes overlap."""
    bounds = np.array([mesh.bounds for mesh in meshes])
    apart = (bounds[:, None, 0] >= bounds[None, :, 1]).any(axis=-1)
    near = np.triu(~(apart | apart.T), 1)
    return [(int(i), int(j)) for i, j in np.argwhere(near)]


def _overlap(one: Hull, two: Hull, solid: _Solid) -> bool:
    return (solid(one) ^ solid(two)).volume() > OVERLAP * min(one.mesh.volume, two.mesh.volume)


def _united(group: list[Hull], solid: _Solid) -> list[Hull]:
    """One hull for each fill of a group, the fuller ones cut out of the others."""
    result, fuller = [], manifold3d.Manifold()
    for fill in sorted({hull.fill for hull in group}, reverse=True):
        alike = [hull for hull in group if hull.fill == fill]
        whole = manifold3d.Manifold.batch_boolean(
            [solid(hull) for hull in alike], manifold3d.OpType.Add
        )
        rest = whole - fuller
        fuller = fuller + whole
        # nothing is left of a hull that lies inside a fuller one
        if rest.volume() > OVERLAP * min(hull.mesh.volume for hull in alike):
            first, mesh = alike[0], rest.to_mesh64()
            in_body = TriMesh(
                np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts).astype(np.int64)
            )
            back = first.body_from_geom.T
            result.append(
                dataclasses.replace(
                    first,
                    name=_name(alike),
                    mesh=in_body.transformed(back, -back @ first.position),
                    geoms=tuple(geom for hull in alike for geom in hull.geoms),
                )
            )
    return result


def _name(hulls: Sequence[Hull]) -> str:
    names = [hull.name for hull in hulls]
    return " + ".join(names if len(names) <= 3 else [*names[:2], f"{len(names) - 2} more"])

"""`Hull`: a closed mesh fixed to a body, that displaces water."""

import dataclasses
import functools
from collections.abc import Sequence
from weakref import WeakKeyDictionary, WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh

_PLACED: WeakKeyDictionary[TriMesh, WeakValueDictionary[bytes, TriMesh]] = WeakKeyDictionary()
"""Meshes in the frames of bodies, by the mesh and its pose there, as long as a hull has them."""


@dataclasses.dataclass(frozen=True, eq=False)
class Hull:
    """One geom that displaces water, or several of one body that overlap and displace as one."""

    geom: int
    """Index of the geom in the model; of the first of several."""
    body: int
    """Index of the body it moves with: a body without a joint is part of its parent."""
    name: str
    """Name of the geom, or 'BODY/TYPE INDEX' for one without; those of several joined by ' + '."""
    mesh: TriMesh
    """Its mesh, in the geom's frame."""
    body_from_geom: NDArray[np.float64]
    """Rotation (3, 3) from the geom's frame to the body's."""
    position: NDArray[np.float64]
    """Origin of the geom's frame in the body's (3,) [m]."""
    fill: float = 1.0
    """Part of the mesh's volume that displaces water; less than 1 for a hull that floods."""
    geoms: tuple[int, ...] = ()
    """Indices of all geoms it is made of."""

    def __post_init__(self) -> None:
        self.body_from_geom.setflags(write=False)
        self.position.setflags(write=False)

    @property
    def displaced_volume(self) -> float:
        """Volume of water that it displaces fully submerged [m^3]."""
        return self.fill * self.mesh.volume

    @functools.cached_property
    def mesh_in_body(self) -> TriMesh:
        """The mesh in the frame of the body, one for all hulls that have it in the same pose."""
        placed = _PLACED.setdefault(self.mesh, WeakValueDictionary())
        pose = self.body_from_geom.tobytes() + self.position.tobytes()
        mesh = placed.get(pose)
        if mesh is None:
            mesh = placed[pose] = self.mesh.transformed(self.body_from_geom, self.position)
        return mesh


def group_by_body(hulls: Sequence[Hull]) -> dict[int, list[Hull]]:
    """The hulls of each body, by the index of the body, in the order of the model."""
    groups: dict[int, list[Hull]] = {body: [] for body in sorted({hull.body for hull in hulls})}
    for hull in hulls:
        groups[hull.body].append(hull)
    return groups


def combine_volumes(hulls: Sequence[Hull]) -> tuple[float, NDArray[np.float64]]:
    """The volume [m^3] that hulls of one body displace fully submerged, and its centroid (3,) [m].

    The centroid is in the frame of the body.
    """
    volumes = np.array([hull.displaced_volume for hull in hulls])
    volume = float(volumes.sum())
    centroids = [hull.body_from_geom @ hull.mesh.centroid + hull.position for hull in hulls]
    return volume, volumes @ centroids / volume

"""Overlaps of closed meshes: the volumes that two of them share."""

import functools
from collections.abc import Iterable, Iterator, Sequence

import manifold3d
import numpy as np

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import to_manifold


def find_close_pairs(meshes: Sequence[TriMesh]) -> list[tuple[int, int]]:
    """Pairs of indices of meshes whose bounding boxes overlap."""
    bounds = np.array([mesh.bounds for mesh in meshes])
    apart = (bounds[:, None, 0] >= bounds[None, :, 1]).any(axis=-1)
    close = np.triu(~(apart | apart.T), 1)
    return [(int(i), int(j)) for i, j in np.argwhere(close)]


def measure_overlaps(
    meshes: Sequence[TriMesh], pairs: Iterable[tuple[int, int]]
) -> Iterator[tuple[int, int, float]]:
    """Measure the volume [m^3] that two meshes share; 0 where one of them is no manifold.

    Args:
        meshes: the meshes, in one frame.
        pairs: indices of the meshes to compare.

    Yields:
        Both indices, and the volume.
    """

    @functools.cache
    def solid(index: int) -> manifold3d.Manifold | None:
        return to_manifold(*meshes[index].compact)

    for i, j in pairs:
        one, two = solid(i), solid(j)
        yield i, j, float((one ^ two).volume()) if one is not None and two is not None else 0.0

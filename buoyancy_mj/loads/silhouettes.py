"""Silhouettes of a body along its axes, and the drag that is estimated from them."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.rays import silhouette
from buoyancy_mj.meshes.mesh import TriMesh

CELLS = 200
"""Cells along each side of the grid on which a silhouette is measured."""


class Silhouettes(NamedTuple):
    """What a body shows along each of its axes, on a grid over its bounding box."""

    areas: NDArray[np.float64]
    """Area of each cell that the body covers, along x, y, z (3, CELLS, CELLS) [m^2]; 0 elsewhere.

    The cells of the silhouette along an axis run along the next axis, then the one after it."""
    middles: NDArray[np.float64]
    """Coordinates of the middles of the cells along x, y, z (CELLS, 3) [m], from the centre."""
    length: float
    """Longest side of the bounding box [m]."""


def measure_silhouettes(meshes: Sequence[TriMesh], centre: NDArray[np.float64]) -> Silhouettes:
    """Measure the silhouettes of meshes in the frame of their body, from a centre (3,) [m]."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    vertices = np.vstack([mesh.vertices for mesh in meshes]) - centre
    faces = np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)])
    low = vertices.min(axis=0)
    high = vertices.max(axis=0)
    step = (high - low) / CELLS

    areas = np.empty((3, CELLS, CELLS))
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        grid = np.zeros((CELLS, CELLS), np.bool_)
        silhouette(vertices[:, j], vertices[:, k], faces, low[[j, k]], step[[j, k]], grid)
        areas[axis] = step[j] * step[k] * grid
    middles = low + (np.arange(CELLS)[:, None] + 0.5) * step
    return Silhouettes(areas, middles, float((high - low).max()))


def estimate_drag(
    resistance: float, meshes: Sequence[TriMesh], silhouettes: Silhouettes
) -> NDArray[np.float64]:
    """Quadratic damping (6,) [N s^2/m^2, N m s^2] of a body about the centre of its silhouettes.

    `Silhouette` says where the formulas come from.

    Args:
        resistance: force per area and velocity squared of a flat face across the flow [kg/m^3].
        meshes: the hulls of the body, in its frame.
        silhouettes: theirs.
    """
    # how squarely the faces meet the flow along each axis: 1 for a box, 1/2 for a sphere
    shown = np.abs(np.vstack([mesh.area_vectors for mesh in meshes]))
    areas = np.maximum(np.concatenate([mesh.areas for mesh in meshes]), 1e-300)
    cosines = shown / areas[:, None]
    bluffness = (shown * cosines**2).sum(axis=0) / shown.sum(axis=0)

    drag = np.zeros(6)
    for axis in range(3):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        strips = resistance * bluffness[axis] * silhouettes.areas[axis]
        drag[axis] = strips.sum()
        # turning about j moves the strips at distance |k| along this axis, and the other way round
        drag[3 + j] += (strips * np.abs(silhouettes.middles[None, :, k]) ** 3).sum()
        drag[3 + k] += (strips * np.abs(silhouettes.middles[:, None, j]) ** 3).sum()
    return drag

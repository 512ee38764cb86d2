"""Silhouettes of a body along its axes, and the drag that is estimated from them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.rays import see
from buoyancy_mj.meshes.cache import Form, recall
from buoyancy_mj.meshes.mesh import TriMesh

CELLS = 200
"""Cells along each side of the grid on which a silhouette is measured."""
REATTACHING = (0.55, 2.2)
"""Length over width from which the flow along a blunt body begins to close on its sides, and from
which it has closed."""
RELIEF = 0.18
"""Part of its pressure drag that a body loses where the flow closes on its sides."""


class Silhouettes(NamedTuple):
    """What a body shows along each of its axes, measured on a grid over its bounding box.

    Only what is seen from outside counts: faces behind others add nothing.
    """

    areas: NDArray[np.float64]
    """Area of the silhouette along x, y, z (3,) [m^2]."""
    arms: NDArray[np.float64]
    """Integral over each silhouette of the cube of the distance from the centre (3, 2) [m^5].

    Along the axis after the one that it is seen along, and along the one after that."""
    extents: NDArray[np.float64]
    """Sides of the bounding box (3,) [m]."""
    bluffness: NDArray[np.float64]
    """Mean square cosine between the normals that are seen along each axis and it (3,)."""
    walls: NDArray[np.float64]
    """Area of the faces that water passes along each axis (3,) [m^2]: each times the square sine
    between its normal and the axis."""

    @property
    def length(self) -> float:
        """Longest side of the bounding box [m]."""
        return float(self.extents.max())


_SILHOUETTES = Form("silhouettes", Silhouettes._asdict, lambda arrays: Silhouettes(**arrays))


def measure_silhouettes(meshes: Sequence[TriMesh], centre: NDArray[np.float64]) -> Silhouettes:
    """Measure the silhouettes of meshes in the frame of their body, from a centre (3,) [m]."""
    parts = (*(mesh.checksum for mesh in meshes), centre)
    return recall(_SILHOUETTES, parts, lambda: _measure(meshes, centre))


def _measure(meshes: Sequence[TriMesh], centre: NDArray[np.float64]) -> Silhouettes:
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    vertices = np.vstack([mesh.vertices for mesh in meshes]) - centre
    faces = np.vstack([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)])
    sizes = np.concatenate([mesh.areas for mesh in meshes])
    vectors = np.vstack([mesh.area_vectors for mesh in meshes])
    normals = np.abs(vectors) / np.maximum(sizes, 1e-300)[:, None]
    low = vertices.min(axis=0)
    high = vertices.max(axis=0)
    step = (high - low) / CELLS

    middles = low + (np.arange(CELLS)[:, None] + 0.5) * step
    areas, arms, bluffness, walls = np.empty(3), np.empty((3, 2)), np.empty(3), np.zeros(3)
    for axis in range(3):
        # the faces that are seen first from both sides, and in how many cells
        j, k = (axis + 1) % 3, (axis + 2) % 3
        seen = np.full((2, CELLS, CELLS), -1, np.int64)
        u, v, w = vertices[:, j], vertices[:, k], vertices[:, axis]
        see(u, v, w, faces, low[[j, k]], step[[j, k]], seen)
        cells = np.bincount(seen[seen >= 0], minlength=len(faces))

        # a face is seen along all axes by shares of its area whose sum is 1: its square cosines
        cell = step[j] * step[k]
        covered = seen[0] >= 0
        areas[axis] = cell * covered.sum()
        arms[axis, 0] = cell * covered.sum(axis=1) @ np.abs(middles[:, j]) ** 3
        arms[axis, 1] = cell * covered.sum(axis=0) @ np.abs(middles[:, k]) ** 3
        bluffness[axis] = cells @ normals[:, axis] ** 2 / cells.sum()
        walls += cell * (cells * normals[:, axis]) @ (1.0 - normals**2)
    return Silhouettes(areas, arms, high - low, bluffness, walls)


def estimate_drag(
    coefficient: float, friction: float, density: float, silhouettes: Silhouettes
) -> NDArray[np.float64]:
    """Quadratic damping (6,) [N s^2/m^2, N m s^2] of a body about the centre of its silhouettes.

    `Silhouette` says where the formulas come from.

    Args:
        coefficient: drag coefficient of a flat face across the flow.
        friction: coefficient of skin friction.
        density: of the water [kg/m^3].
        silhouettes: of the body.
    """
    drag = np.zeros(6)
    for axis in range(3):
        # the drag coefficient along this axis: pressure, and friction on the sides
        j, k = (axis + 1) % 3, (axis + 2) % 3
        area = float(silhouettes.areas[axis])
        slenderness = silhouettes.extents[axis] / math.sqrt(4.0 * area / math.pi)
        closed = float(np.interp(slenderness, REATTACHING, (0.0, 1.0)))
        pressure = coefficient * silhouettes.bluffness[axis] * (1.0 - RELIEF * closed)
        total = pressure + friction * silhouettes.walls[axis] / area

        # turning about j moves the strips at distance |k| along this axis, and the other way round
        along_j, along_k = silhouettes.arms[axis]
        drag[axis] = 0.5 * density * total * area
        drag[3 + j] += 0.5 * density * total * along_k
        drag[3 + k] += 0.5 * density * total * along_j
    return drag

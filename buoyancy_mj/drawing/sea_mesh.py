"""`SeaMesh`: the surface of the sea as a mesh, fine where one looks and wide to the horizon."""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.sea.water import Water

TOLERANCE = 1e-3
"""How far the mesh may stand off the surface within its radius [m]."""
SPOKES = (160, 288)
"""Fewest and most vertices around a ring."""
HORIZON = 5000.0
"""Distance at which the sea ends [m]."""
WHOLE, LOST = 1.0 / 6.0, 1.0 / 3.0
"""Length of a cell over that of a wave, up to which the wave is whole and from which it is gone."""


class Surface(NamedTuple):
    """The surface of the sea at one instant."""

    vertices: NDArray[np.float32]
    """Its points (n, 3) [m]; x and y are relative to the middle of the mesh, z is that of the
    world."""
    normals: NDArray[np.float32]
    """Upward unit normals (n, 3) there."""


class SeaMesh:
    """Rings of triangles around a point, whose cells grow with the distance.

    Within its radius the mesh has all waves, and cells so small that it stands off the surface by a
    millimetre at most; where that would take too many, by some 1,500th of the radius. Beyond it,
    each wave fades where cells become too long for it.

    Args:
        radius: distance from the middle within which the surface is exact [m]: that of what floats.
        curvature: bound of the curvature of the surface [1/m], see `Water.curvature`.
        spokes: fewest and most vertices around a ring; with less than usual the surface is coarser.
    """

    def __init__(
        self, radius: float, curvature: float = 0.0, spokes: tuple[int, int] = SPOKES
    ) -> None:
        # a cell of length h stands off a curvature c by c h^2 / 4 at most
        wanted = math.pi * radius * math.sqrt(curvature / TOLERANCE)
        count = 8 * math.ceil(min(max(wanted, spokes[0]), spokes[1]) / 8)
        growth = 2.0 * math.pi / count
        core = np.linspace(0.0, radius, math.ceil(1.0 / growth) + 1)[1:]
        steps = math.ceil(math.log(HORIZON / radius) / math.log1p(growth))
        radii = np.append(core, radius * (1.0 + growth) ** np.arange(1, steps + 1))

        self.radius = radius
        """Distance from the middle within which the surface is exact [m]."""
        self.faces = join_rings(len(radii), count)
        """Corners of its triangles (m, 3), counterclockwise from above; they stay."""
        angles = growth * np.arange(count)
        self._x = np.append(0.0, np.outer(radii, np.cos(angles)))
        self._y = np.append(0.0, np.outer(radii, np.sin(angles)))
        self._cells = growth * np.append(0.0, np.repeat(radii, count))
        self._cells[: 1 + len(core) * count] = 0.0
        self.count = len(self._x)
        """Number of its vertices."""
        self._water: Water | None = None
        self._bands: list[Band] = []

    def shape(self, water: Water, centre: NDArray[np.float64], time: float) -> Surface:
        """The surface around a point at a time.

        Args:
            water: the sea.
            centre: the middle of the mesh (2,) [m], world frame.
            time: [s].
        """
        if water is not self._water:
            self._water, self._bands = water, split_waves(water, self._cells)
        heights = np.full(len(self._x), water.level)
        slopes = np.zeros((len(self._x), 2))
        for band in self._bands:
            some = slice(len(band.weights))
            x, y = self._x[some] + centre[0], self._y[some] + centre[1]
            heights[some] += band.weights * band.water.elevation(x, y, time)
            slopes[some] += band.weights[:, None] * band.water.slope(x, y, time)

        vertices = np.column_stack([self._x, self._y, heights])
        normals = np.column_stack([-slopes, np.ones(len(slopes))])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        return Surface(vertices.astype(np.float32), normals.astype(np.float32))


@dataclasses.dataclass(frozen=True, eq=False)
class _Rows:
    """Rows of a sea as a wave of their own."""

    rows: NDArray[np.float64]
    """Components (n, 6), see `sea.waves.Wave`."""


class Band(NamedTuple):
    """Waves of about one length, and how much of them each vertex has."""

    water: Water
    """A sea of these waves alone, whose level is 0."""
    weights: NDArray[np.float64]
    """The part of their elevation that each of the first vertices (k,) has; others have none."""


def split_waves(water: Water, cells: NDArray[np.float64]) -> list[Band]:
    """The waves of a sea by octaves of their lengths, on vertices with cells (n,) [m] long."""
    if not len(water.rows):
        return []
    rows = water.rows[:, :6]
    wavenumbers = np.hypot(rows[:, 1], rows[:, 2])
    octaves = np.floor(np.log2(np.maximum(wavenumbers, np.finfo(float).tiny)))
    bands = []
    for octave in np.unique(octaves):
        chosen = octaves == octave
        lengths = cells * wavenumbers[chosen].max() / (2.0 * math.pi)
        weights = np.clip((LOST - lengths) / (LOST - WHOLE), 0.0, 1.0)
        count = int(np.count_nonzero(weights))
        sea = Water(waves=_Rows(np.ascontiguousarray(rows[chosen])))
        bands.append(Band(sea, weights[:count]))
    return bands


def join_rings(rings: int, count: int) -> NDArray[np.uint32]:
    """Triangles (m, 3) between a middle, vertex 0, and rings of `count` vertices each around it.

    The first `count` of them are those around the middle.
    """
    here = np.arange(count)
    after = (here + 1) % count
    fan = np.column_stack([np.zeros(count, int), 1 + here, 1 + after])
    starts = 1 + count * np.arange(rings - 1)[:, None]
    a, b = (starts + here).ravel(), (starts + after).ravel()
    quads = np.concatenate(
        [np.column_stack([a, a + count, b + count]), np.column_stack([a, b + count, b])]
    )
    return np.concatenate([fan, quads]).astype(np.uint32)

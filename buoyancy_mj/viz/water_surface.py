"""`SurfaceDrawing`: the water's surface around the vehicles in a recording."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz.log import Log

CELLS = 24
"""Number of cells along each side of the surface."""
WIDTH = 4.0
"""Length of a side over the length of what floats on it."""
STRIDE = 4
"""Number of cells by which the surface moves when its middle is left."""
WATER = (70, 150, 215, 45)
GRID = (190, 225, 250, 45)


class SurfaceDrawing:
    """The water's surface, a square of cells that follows the vehicles.

    Args:
        water: the sea.
        size: length of what floats on it [m].
    """

    def __init__(self, water: Water, size: float) -> None:
        self._water = water
        self._size = size
        self._cell = WIDTH * size / CELLS
        self._centre: NDArray[np.float64] | None = None

    def draw_static(self, log: Log) -> None:
        """Draw the triangles and the colour of the surface."""
        row = np.arange(CELLS)
        a = (row[:, None] * (CELLS + 1) + row).ravel()
        b = a + CELLS + 1
        faces = np.vstack([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])
        mesh = rr.Mesh3D.from_fields(triangle_indices=faces, albedo_factor=WATER)
        log.keep("world/water", mesh)
        radius = 0.0015 * self._size
        log.keep("world/water/grid", rr.LineStrips3D.from_fields(colors=[GRID], radii=[radius]))

    def draw(self, log: Log, middle: NDArray[np.float64], time: float) -> None:
        """Draw the surface around a point (3,) [m] at a time [s]; still water when it moves."""
        stride = STRIDE * self._cell
        centre = np.round(middle[:2] / stride) * stride
        is_still = not self._water.waves
        if is_still and self._centre is not None and np.array_equal(centre, self._centre):
            return
        self._centre = centre

        # corners of the cells, and normals by their slopes
        along = (np.arange(CELLS + 1) - 0.5 * CELLS) * self._cell
        x, y = np.meshgrid(centre[0] + along, centre[1] + along, indexing="ij")
        z = self._water.elevation(x, y, time)
        slope_x, slope_y = _slope(z, self._cell), _slope(z.T, self._cell).T
        corners = np.stack([x, y, z], axis=-1)
        normals = np.stack([-slope_x, -slope_y, np.ones_like(z)], axis=-1)
        log.draw(
            "world/water",
            rr.Mesh3D,
            vertex_positions=corners.reshape(-1, 3),
            vertex_normals=normals.reshape(-1, 3),
        )

        # a grid over every second corner
        lattice = corners[::2, ::2]
        lines = np.concatenate([lattice, lattice.swapaxes(0, 1)])
        log.draw("world/water/grid", rr.LineStrips3D, strips=lines)


def _slope(heights: NDArray[np.float64], cell: float) -> NDArray[np.float64]:
    """How heights (n, m) [m] rise along the first axis, as `np.gradient` has it in more time."""
    slopes = np.empty_like(heights)
    slopes[1:-1] = (heights[2:] - heights[:-2]) / (2.0 * cell)
    slopes[0] = (heights[1] - heights[0]) / cell
    slopes[-1] = (heights[-1] - heights[-2]) / cell
    return slopes

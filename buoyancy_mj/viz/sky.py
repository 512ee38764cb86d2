"""`draw_sky`: a dome around the world, the sky above the horizon and the deep below it."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import DAYLIGHT
from buoyancy_mj.drawing.sea_mesh import HORIZON
from buoyancy_mj.drawing.sky import shade_depths, shade_sky
from buoyancy_mj.viz.log import Log

ENTITY = "world/sky"
SPOKES = 96
"""Number of corners around the dome."""
HEIGHTS = np.array([1, 2, 4, 6, 9, 12, 16, 20, 25, 30, 37, 45, 55, 65, 75, 90.0])
"""Angles over the horizon of its rings, and under it [degrees]."""


def draw_sky(log: Log) -> None:
    """Draw the dome, whose colours no light changes."""
    angles = np.radians(np.concatenate([-HEIGHTS[::-1], [0.0, 0.0], HEIGHTS]))
    around = np.linspace(0.0, 2.0 * np.pi, SPOKES + 1)
    flat, up = np.cos(angles)[:, None], np.sin(angles)[:, None]
    rays = np.stack(
        np.broadcast_arrays(flat * np.cos(around), flat * np.sin(around), up), axis=-1
    ).reshape(-1, 3)

    # two rings at the horizon, one of each colour
    is_sky = np.repeat(np.arange(len(angles)) > len(HEIGHTS), SPOKES + 1)[:, None]
    colours = np.where(is_sky, shade_sky(DAYLIGHT, rays), shade_depths(DAYLIGHT, rays))
    log.keep(
        ENTITY,
        rr.Mesh3D(
            vertex_positions=1.02 * HORIZON * rays,
            triangle_indices=_join_rings(len(angles), SPOKES + 1),
            vertex_colors=np.rint(255.0 * colours).astype(np.uint8),
        ),
    )


def _join_rings(rings: int, count: int) -> NDArray[np.int64]:
    """Triangles (m, 3) between rings of `count` corners, the last of which stands on the first."""
    corners = np.arange(rings * count).reshape(rings, count)
    a, b = corners[:-1, :-1].ravel(), corners[:-1, 1:].ravel()
    return np.concatenate(
        [np.column_stack([a, b, b + count]), np.column_stack([a, b + count, a + count])]
    )

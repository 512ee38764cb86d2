"""`tile_geom`: a geom in squares, by which motion past it shows."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.viz.textures import texture
from buoyancy_mj.viz.visible_geoms import VisibleGeom

PIXELS = 64
"""Pixels along a side of the picture that repeats, two squares wide."""
DARK = 222
"""Brightness of every second square, of 255."""


def tile_geom(geom: VisibleGeom, side: float) -> rr.Mesh3D:
    """Squares for the mesh of a geom that stays.

    Args:
        geom: the geom.
        side: side of a square [m]; one has a corner at the origin of the world.
    """
    points = geom.vertices @ geom.rotation.T + geom.position
    # the two axes along which each face lies, about
    across = np.abs(geom.normals @ geom.rotation.T).argmax(axis=1)
    along = np.array([[1, 2], [0, 2], [0, 1]])[across]
    return texture(_paint_squares(), np.take_along_axis(points, along, axis=1) / (2.0 * side))


def _paint_squares() -> NDArray[np.uint8]:
    """Two by two squares (PIXELS, PIXELS, 3), dark and light."""
    is_second = np.arange(PIXELS) >= PIXELS // 2
    shades = np.where(is_second[:, None] ^ is_second, DARK, 255).astype(np.uint8)
    return np.repeat(shades[:, :, None], 3, axis=2)

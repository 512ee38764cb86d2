"""A grid that lies still on the surface of the sea, by which motion over the water shows."""

import numpy as np
from numpy.typing import NDArray

PIXELS = 512
"""Pixels along a side of its picture."""
DARK = 205
"""Brightness between its lines, of 255."""
STEPS = np.array([1.0, 2.0, 5.0, 10.0])


def choose_cell(distance: float) -> float:
    """A round length of cells [m] for an eye at a distance [m]: 1, 2 or 5 times a power of 10."""
    wanted = 0.6 * distance
    decade = 10.0 ** np.floor(np.log10(wanted))
    return float(decade * STEPS[STEPS * decade <= wanted * (1.0 + 1e-9)][-1])


def paint_grid(radius: float, cell: float) -> NDArray[np.uint8]:
    """The grid as a picture (PIXELS, PIXELS, 3) that the colours of the sea are multiplied with.

    Its lines fade towards the rim, where they would be too close to be drawn.

    Args:
        radius: half of its side [m].
        cell: distance between lines [m]; one goes through the middle.
    """
    along = ((np.arange(PIXELS) + 0.5) / PIXELS * 2.0 - 1.0) * radius
    away = np.abs(along - cell * np.round(along / cell))
    line = np.clip(1.5 - away * PIXELS / (2.0 * radius), 0.0, 1.0)
    lines = np.maximum(line[:, None], line)
    far = np.hypot(along[:, None], along) / radius
    lines *= np.clip(1.6 * (0.75 - far), 0.0, 1.0)
    shades = np.rint(DARK + (255 - DARK) * lines).astype(np.uint8)
    return np.repeat(shades[:, :, None], 3, axis=2)

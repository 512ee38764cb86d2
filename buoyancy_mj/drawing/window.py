"""Snell's window: where one looks out of the water from below, and where it is a mirror."""

import numpy as np
from numpy.typing import NDArray

WINDOW = 0.66
"""Cosine of the angle from the vertical within which one looks out: 48.6 degrees."""


def find_mirrored(cosines: NDArray[np.float64]) -> NDArray[np.float64]:
    """How much the surface mirrors the depths (n,), from 0 to 1.

    Args:
        cosines: of the angles between upward rays and the normals of the surface (n,).
    """
    return np.clip((WINDOW - cosines) / WINDOW, 0.0, 1.0)

"""Ripples too short to act, as a normal map that repeats over the surface."""

import math
import random

import numpy as np
from numpy.typing import NDArray

COMPONENTS = 60
"""Number of ripples."""
ORDERS = (2, 40)
"""Least and most crests along a side of the map."""


def paint_ripples(size: int, slope: float) -> NDArray[np.uint8]:
    """A normal map (size, size, 3) of random ripples, whose opposite edges fit.

    Args:
        size: pixels along an edge.
        slope: root mean square of the slope.
    """
    draw = random.Random(5)
    along = 2.0 * math.pi * np.arange(size) / size
    x, y = np.meshgrid(along, along)
    slopes = np.zeros((size, size, 2))
    for _ in range(COMPONENTS):
        order = ORDERS[0] * (ORDERS[1] / ORDERS[0]) ** draw.random()
        turn, phase = draw.uniform(0.0, 2.0 * math.pi), draw.uniform(0.0, 2.0 * math.pi)
        # whole crests along each edge
        wave = np.round(order * np.array([math.cos(turn), math.sin(turn)]))
        # short ripples are less steep
        steep = order**-0.25
        slopes += steep * np.sin(wave[0] * x + wave[1] * y + phase)[..., None] * wave / order
    slopes *= slope / np.sqrt((slopes**2).sum(axis=-1).mean())
    normals = np.dstack([slopes, np.ones((size, size))])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    # what lies between two numbers is drawn at random, or the surface would have steps
    noise = np.random.default_rng(5).random(normals.shape)
    return np.floor(127.5 + 127.5 * normals + noise).clip(0, 255).astype(np.uint8)

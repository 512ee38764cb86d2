"""How much of a propeller's disc is under water, and what air does to the rest."""

import math

from buoyancy_mj.kernels.compiling import njit

LEAST_TILT = 0.1
"""Sine of the least angle between a disc and the surface: a disc that lies flat comes out over the
height of its duct, about a tenth of its diameter, and not at once."""
DEEP = 1.3
"""Depth of the shaft over the disc's radius from which on no air comes down to it."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def wet_share(
    depth,  # of the middle of the disc under the surface [m]
    tilt,  # sine of the angle between the disc and the surface
    radius,  # [m]
):
    """Share of a disc that is under water: a circle without the segment that a line cuts off."""
    x = depth / (max(tilt, LEAST_TILT) * radius)
    if x >= 1.0:
        return 1.0
    if x <= -1.0:
        return 0.0
    return 1.0 - (math.acos(x) - x * math.sqrt(1.0 - x * x)) / math.pi


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def ventilated_share(
    depth,  # of the middle of the disc under the surface [m]
    radius,  # [m]
    wet,  # share of the disc under water
):
    """Share of the thrust that air leaves to the wet part of a disc; 0 for a disc in the air.

    1 - 0.675 (1 - 0.769 h/R)^1.258 of the thrust is left for h/R below 1.3 (Minsaas, Faltinsen and
    Persson 1983, PRADS, Tokyo). That holds the loss of the disc's area too, which is the wet share.
    """
    x = depth / radius
    if x >= DEEP:
        return 1.0
    if wet <= 0.0:
        return 0.0
    left = 1.0 - 0.675 * (1.0 - 0.769 * x) ** 1.258
    return min(max(left / wet, 0.0), 1.0)

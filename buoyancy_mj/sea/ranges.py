"""Ranges of the numbers that describe water: what lies outside is refused in one sentence."""

import math

from buoyancy_mj.errors import WaterError, describe
from buoyancy_mj.values import is_number, read_number

SMALLEST = 1e-6
"""Least period, frequency or depth, in SI units; none in nature comes near it."""
LARGEST = 1e6
"""Greatest period, wavelength or level, in SI units; none in nature comes near it."""
STRONGEST = 1e12
"""Greatest acceleration of gravity in a dispersion relation [m/s^2]."""
SHORTEST = 0.017
"""Least length of a wave [m].

Shorter ripples are held by surface tension more than by gravity (Lamb, Hydrodynamics, 1932, art.
267: 1.7 cm on clean water)."""


def read_positive(name: str, value: object, what: str) -> float:
    """A number above 0, which may be infinite, as a float.

    Args:
        name: what messages call the value.
        value: any value.
        what: what it must be, in words.

    Raises:
        WaterError: it is none.
    """
    if is_number(value) and value == math.inf:
        return math.inf
    try:
        return read_number(WaterError, name, value, above=0.0)
    except WaterError:
        raise WaterError(f"{name} is {describe(value)}; it must be {what}") from None


def read_depth(value: object) -> float:
    """A depth of water [m]; infinity is deep water.

    Raises:
        WaterError: the value is no number, or less than `SMALLEST`.
    """
    what = f"at least {SMALLEST:g} m (inf is deep water)"
    depth = read_positive("wave depth", value, what)
    if depth < SMALLEST:
        raise WaterError(f"wave depth is {describe(value)}; it must be {what}")
    return depth

"""Ranges of the numbers that describe water: what lies outside is refused in one sentence."""

import math

import numpy as np

from buoyancy_mj.errors import WaterError

SMALLEST = 1e-6
"""Least frequency, period, wavelength or depth, in SI units; none in nature comes near it."""
LARGEST = 1e6
"""Greatest frequency, period, wavelength or level, in SI units; none in nature comes near it."""


def check_number(
    name: str,
    value: object,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
) -> None:
    """Refuse a value that is not a finite number in a range.

    Raises:
        WaterError: the value is none, or it is not greater than `above`, less than `least` or
            greater than `most`; the message calls it `name`.
    """
    if (
        isinstance(value, bool)
        or not isinstance(value, int | float | np.number)
        or not math.isfinite(value)
    ):
        raise WaterError(f"{name} is {value!r}; it must be a finite number")
    if not value > above:
        raise WaterError(f"{name} is {value}; it must be above {above:g}")
    if not value >= least:
        raise WaterError(f"{name} is {value}; it must be at least {least:g}")
    if not value <= most:
        raise WaterError(f"{name} is {value}; it must be at most {most:g}")


def check_whole_number(name: str, value: object, least: int, most: int) -> None:
    """Refuse a value that is not a whole number from `least` to `most`.

    Raises:
        WaterError: the message calls the value `name`.
    """
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise WaterError(f"{name} is {value!r}; it must be a whole number from {least} to {most}")


def check_depth(value: object) -> None:
    """Refuse a value that is no depth of water; infinity is deep water.

    Raises:
        WaterError: the value is no number, or less than `SMALLEST`.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not value >= SMALLEST:
        raise WaterError(
            f"wave depth is {value!r}; it must be at least {SMALLEST:g} m (inf is deep water)"
        )

"""Distributions of irregular seas: energy over frequency, and waves over direction."""

import functools
import math

import numpy as np
from numpy.typing import NDArray

CUTOFF = 10.0
"""Highest frequency over that of the peak: above it lies about 1e-4 of the energy."""
_LOWEST = 0.2
"""Lowest frequency over that of the peak: below it lies no energy to speak of."""
_SAMPLES = 40_001
"""Frequencies, or directions, at which a distribution is integrated."""


def jonswap_shape(ratio: NDArray[np.float64], gamma: float) -> NDArray[np.float64]:
    """The JONSWAP spectrum without its scale (Hasselmann et al. 1973; DNV-RP-C205, 3.5.5).

    r^-5 exp(-5/4 r^-4) gamma^exp(-(r - 1)^2 / (2 sigma^2)), sigma 0.07 below the peak, 0.09 above.

    Args:
        ratio: frequencies over that of the peak, r (any shape).
        gamma: height of the peak over that of Pierson and Moskowitz's spectrum.
    """
    r = np.maximum(ratio, 1e-3)
    peak = np.exp(-0.5 * ((r - 1.0) / np.where(r <= 1.0, 0.07, 0.09)) ** 2)
    shape: NDArray[np.float64] = r**-5.0 * np.exp(-1.25 * r**-4.0) * gamma**peak
    return shape


@functools.lru_cache(maxsize=32)
def jonswap_moments(
    gamma: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies over that of the peak (n,), and `jonswap_shape`'s moments up to each.

    Returns:
        Ratios r up to `CUTOFF`; integrals of the shape up to each; and integrals of r^2 times the
        shape.
    """
    from scipy.integrate import cumulative_trapezoid

    ratio = np.linspace(_LOWEST, CUTOFF, _SAMPLES)
    density = jonswap_shape(ratio, gamma)
    zeroth = cumulative_trapezoid(density, ratio, initial=0.0)
    return (
        ratio,
        zeroth,
        cumulative_trapezoid(density * ratio**2, ratio, initial=0.0),
    )


def spreading_angles(exponent: float, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles b (n,) [rad] below which lie these shares (n,) of cos^2s(b / 2).

    This spreading about the mean direction is that of Longuet-Higgins et al. (1963).

    Args:
        exponent: s.
        shares: parts of the whole, from 0 to 1 (n,).
    """
    from scipy.integrate import cumulative_trapezoid

    angle = np.linspace(-math.pi, math.pi, _SAMPLES)
    density = np.cos(0.5 * angle) ** (2.0 * exponent)
    total = cumulative_trapezoid(density, angle, initial=0.0)
    angles: NDArray[np.float64] = np.interp(shares * total[-1], total, angle)
    return angles

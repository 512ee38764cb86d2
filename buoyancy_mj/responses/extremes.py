"""What a response comes to in a sea: its spectrum, significant and most probable largest values."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea

Sea = JonswapSea | PiersonMoskowitzSea
"""A sea that has a spectrum."""
HOURS_3 = 3.0 * 3600.0
"""How long a sea state is taken to last [s] (DNV-RP-C205, 3.3.1.4)."""
FINE = 2000
"""Frequencies at which spectra are summed up."""


class SeaResponse(NamedTuple):
    """What one response comes to in a sea, as a narrow-banded Gaussian process."""

    significant: float
    """Significant amplitude, the mean of the highest third: 2 sqrt(m0)."""
    largest: float
    """Most probable largest amplitude in the duration: sqrt(2 m0 ln N), with N cycles."""
    period: float
    """Mean time between upward crossings of the mean, 2 pi sqrt(m0 / m2) [s]."""


def respond_to_sea(
    omegas: NDArray[np.float64],
    sizes: NDArray[np.float64],
    sea: Sea,
    duration: float = HOURS_3,
) -> SeaResponse:
    """Sum up the spectrum of a response, S |H|^2, over the frequencies that were measured.

    m_n is the integral of omega^n S |H|^2 (St. Denis and Pierson 1953). Amplitudes are those of
    Rayleigh's distribution (Longuet-Higgins 1952), whose most probable largest of N cycles is
    sqrt(2 m0 ln N), with N the duration over the period (Ochi 1973).

    Args:
        omegas: frequencies (n,) [rad/s], ascending.
        sizes: |H| there (n,), between which it goes straight.
        sea: the sea.
        duration: how long it lasts [s].
    """
    omega = np.linspace(omegas[0], omegas[-1], FINE)
    spectrum = spectrum_of(sea, omega) * np.interp(omega, omegas, sizes) ** 2
    m0, m2 = (float(np.trapezoid(omega**n * spectrum, omega)) for n in (0, 2))
    if not m2 > 0.0:
        return SeaResponse(0.0, 0.0, math.nan)
    period = 2.0 * math.pi * math.sqrt(m0 / m2)
    cycles = max(duration / period, 1.0)
    return SeaResponse(2.0 * math.sqrt(m0), math.sqrt(2.0 * m0 * math.log(cycles)), period)


def spectrum_of(sea: Sea, omega: NDArray[np.float64]) -> NDArray[np.float64]:
    """Energy density of a sea [m^2 s] at frequencies [rad/s]."""
    jonswap = sea if isinstance(sea, JonswapSea) else sea.as_jonswap
    return jonswap.spectrum(omega)


def find_covered_part(omegas: NDArray[np.float64], sea: Sea) -> float:
    """Part of a sea's energy that lies between the first and the last of frequencies [rad/s]."""
    omega = np.linspace(omegas[0], omegas[-1], FINE)
    energy = float(np.trapezoid(spectrum_of(sea, omega), omega))
    return min(1.0, 16.0 * energy / sea.significant_height**2)

"""Irregular seas: spectra of the field, as sums of Airy waves that a seed makes the same everywhere."""

import dataclasses
import functools
import math
import random

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import cumulative_trapezoid

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.waves import GRAVITY, LARGEST, SMALLEST, finite, water_depth, wavenumber

MOST_COMPONENTS = 10_000
"""Waves of one sea."""
CUTOFF = 10.0
"""Highest frequency over that of the peak: above it lies about 1e-4 of the energy."""
ALPHA = 0.0081
"""Pierson and Moskowitz's constant of fully developed seas, S = ALPHA g^2 omega^-5 exp(...)."""
_GRID = 40_001
"""Frequencies, or directions, at which a distribution is summed."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Sea:
    """What all irregular seas have."""

    components: int = 64
    """How many waves."""
    seed: int = 0
    """Of phases and directions."""
    direction: float = 0.0
    """Where the sea runs to, from x towards y [rad]."""
    spreading: float = math.inf
    """Exponent s: infinite for long crests, 10 to 25 for swell, 2 to 5 for wind sea."""
    depth: float = math.inf
    """Depth of the water [m]; it shortens the waves, and leaves the spectrum as it is."""
    gravity: float = GRAVITY
    """g in the dispersion relation [m/s^2]."""


@dataclasses.dataclass(frozen=True)
class JonswapSea(_Sea):
    """A sea of the JONSWAP spectrum, and with gamma 1 of Pierson and Moskowitz's, as `components` Airy waves.

    S = A alpha omega^-5 exp(-5/4 (omega / omega_p)^-4) gamma^exp(-(omega / omega_p - 1)^2 / (2 sigma^2)), sigma
    0.07 below the peak and 0.09 above (Hasselmann et al. 1973; DNV-RP-C205, 3.5.5), scaled so that its
    area is significant_height^2 / 16.

    The spectrum is cut into bands of equal energy, up to `CUTOFF`. Each is one wave, at the band's
    root mean square frequency, so that height and zero-crossing period are those of the spectrum
    whatever the seed; no two bands are equally wide, so that the sea does not repeat. Phases are
    drawn by the seed from the Mersenne Twister, the same on every platform. So are directions, one
    for each wave, from equal shares of cos^2s((b - direction) / 2) (Longuet-Higgins et al. 1963).

    Raises:
        WaterError: a value out of its range.
    """

    significant_height: float
    """Hs, four times the standard deviation of the elevation [m]."""
    peak_period: float
    """Tp, of the waves with the most energy [s]."""
    gamma: float = dataclasses.field(default=3.3, kw_only=True)
    """How much the peak stands out of Pierson and Moskowitz's; 1 to 20."""

    def __post_init__(self) -> None:
        finite("significant_height", self.significant_height, least=0.0)
        finite("peak_period", self.peak_period, least=SMALLEST, most=LARGEST)
        finite("gamma", self.gamma, least=1.0, most=20.0)
        finite("direction", self.direction)
        finite("gravity", self.gravity, above=0.0)
        water_depth(self.depth)
        for name, least, most in (("components", 1, MOST_COMPONENTS), ("seed", 0, 2**63 - 1)):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
                raise WaterError(
                    f"{name} is {value!r}; it must be a whole number from {least} to {most}"
                )
        if (
            isinstance(self.spreading, bool)
            or not isinstance(self.spreading, int | float)
            or not self.spreading > 0.0
        ):
            raise WaterError(
                f"spreading is {self.spreading!r}; it must be an exponent above 0, or inf for long crests"
            )
        if self.significant_height > self.depth:
            raise WaterError(
                f"significant_height is {self.significant_height} m in water {self.depth} m deep; such waves break far "
                "outside: make them lower, or the water deeper"
            )

    def spectrum(self, omega: ArrayLike) -> NDArray[np.float64]:
        """Energy density S [m^2 s] at angular frequencies (any shape) [rad/s], whose integral is Hs^2 / 16."""
        ratio = np.asarray(omega, float) * self.peak_period / (2.0 * math.pi)
        scale = (
            (self.significant_height / 4.0) ** 2
            / self._moments[0]
            * self.peak_period
            / (2.0 * math.pi)
        )
        return scale * _shape(ratio, self.gamma)

    @property
    def zero_crossing_period(self) -> float:
        """Mean time between two crossings of the still level upwards, 2 pi sqrt(m0 / m2) [s]."""
        return self.peak_period * math.sqrt(self._moments[0] / self._moments[1])

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """The waves as rows (components, 6), see `Wave`."""
        n = self.components
        stream = random.Random(self.seed)
        phases = [2.0 * math.pi * stream.random() for _ in range(n)]
        ratio, energy, second = _summed(self.gamma)
        edges = np.interp(np.arange(n + 1) * energy[-1] / n, energy, ratio)
        omegas = (
            np.sqrt(np.diff(np.interp(edges, ratio, second)) / (energy[-1] / n))
            * 2.0
            * math.pi
            / self.peak_period
        )
        directions = np.full(n, self.direction)
        if math.isfinite(self.spreading):
            shares = [(i + 0.5) / n for i in range(n)]
            stream.shuffle(shares)
            directions = directions + _angles(self.spreading, np.array(shares))
        k = np.array([wavenumber(omega, self.depth, self.gravity) for omega in omegas])
        rows = np.empty((n, 6))
        rows[:, 0] = self.significant_height / 4.0 * math.sqrt(2.0 / n)
        rows[:, 1], rows[:, 2] = k * np.cos(directions), k * np.sin(directions)
        rows[:, 3], rows[:, 4], rows[:, 5] = omegas, phases, self.depth
        return rows

    @property
    def warning(self) -> str:
        """What speaks against such a sea in nature, a clause; empty if nothing does.

        Its mean steepness 2 pi Hs / (g Tp^2) stays below 1/15 up to a Tp of 8 s, and below 1/25 from 15 s up,
        with straight lines between (DNV-RP-C205, 3.5.4).
        """
        steepest = float(np.interp(self.peak_period, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))
        most = steepest * self.gravity * self.peak_period**2 / (2.0 * math.pi)
        if self.significant_height <= most:
            return ""
        return (
            f"a sea {self.significant_height:.3g} m high at {self.peak_period:.3g} s, {self.significant_height / most:.2f} "
            f"times as steep as seas get before their waves break; make it at most {most:.3g} m high"
        )

    @property
    def _moments(self) -> tuple[float, float]:
        """Zeroth and second moment of the shape over omega / omega_p."""
        _, energy, second = _summed(self.gamma)
        return float(energy[-1]), float(second[-1])


@dataclasses.dataclass(frozen=True)
class PiersonMoskowitzSea(_Sea):
    """A wind sea of the spectrum of Pierson and Moskowitz (1964): `JonswapSea` with gamma 1.

    Without a peak period it is fully developed, alpha = 0.0081: omega_p = (16 alpha g^2 / (5 Hs^2))^(1/4).

    Raises:
        WaterError: a value out of its range.
    """

    significant_height: float
    """Hs, four times the standard deviation of the elevation [m]."""
    peak_period: float = math.nan
    """Tp, of the waves with the most energy [s]; follows from the height if not given."""

    def __post_init__(self) -> None:
        if isinstance(self.peak_period, float) and math.isnan(self.peak_period):
            finite("significant_height", self.significant_height, above=0.0)
            finite("gravity", self.gravity, above=0.0)
            omega = (16.0 * ALPHA * self.gravity**2 / (5.0 * self.significant_height**2)) ** 0.25
            object.__setattr__(self, "peak_period", 2.0 * math.pi / omega)
        _ = self.as_jonswap

    @functools.cached_property
    def as_jonswap(self) -> JonswapSea:
        """The same sea under its more general name."""
        return JonswapSea(
            **{f.name: getattr(self, f.name) for f in dataclasses.fields(self)}, gamma=1.0
        )

    @property
    def rows(self) -> NDArray[np.float64]:
        """The waves as rows (components, 6), see `Wave`."""
        return self.as_jonswap.rows

    @property
    def warning(self) -> str:
        """What speaks against such a sea in nature, see `JonswapSea.warning`."""
        return self.as_jonswap.warning


def _shape(ratio: NDArray[np.float64], gamma: float) -> NDArray[np.float64]:
    """The spectrum over omega / omega_p, but for its scale."""
    r = np.maximum(ratio, 1e-3)
    bump = np.exp(-0.5 * ((r - 1.0) / np.where(r <= 1.0, 0.07, 0.09)) ** 2)
    shape: NDArray[np.float64] = r**-5.0 * np.exp(-1.25 * r**-4.0) * gamma**bump
    return shape


@functools.lru_cache(maxsize=32)
def _summed(gamma: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies over that of the peak, and up to each the zeroth and the second moment."""
    ratio = np.linspace(0.2, CUTOFF, _GRID)
    density = _shape(ratio, gamma)
    energy = cumulative_trapezoid(density, ratio, initial=0.0)
    return ratio, energy, cumulative_trapezoid(density * ratio**2, ratio, initial=0.0)


def _angles(s: float, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles below which lie these shares of cos^2s(b / 2)."""
    angle = np.linspace(-math.pi, math.pi, _GRID)
    total = cumulative_trapezoid(np.cos(0.5 * angle) ** (2.0 * s), angle, initial=0.0)
    return np.interp(shares * total[-1], total, angle)

"""Irregular seas: spectra of the field as sums of Airy waves, the same everywhere for a seed."""

import dataclasses
import functools
import math
import random

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.distributions import jonswap_moments, jonswap_shape, spreading_angles
from buoyancy_mj.sea.ranges import (
    LARGEST,
    SHORTEST,
    SMALLEST,
    STRONGEST,
    read_depth,
    read_positive,
)
from buoyancy_mj.sea.waves import GRAVITY, wavenumber
from buoyancy_mj.values import read_number, read_whole_number, set_number

MOST_COMPONENTS = 10_000
"""Most waves of one sea."""
ALPHA = 0.0081
"""Pierson and Moskowitz's constant of fully developed seas, S = ALPHA g^2 omega^-5 exp(...)."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class IrregularSea:
    """Options that all irregular seas share."""

    components: int = 64
    """Number of waves."""
    seed: int = 0
    """Seed of phases and directions."""
    direction: float = 0.0
    """Mean direction that the sea runs to, from x towards y [rad]."""
    spreading: float = math.inf
    """Exponent s of the spreading cos^2s(b / 2) over directions b.

    It is infinite for long crests, 10 to 25 for swell, and 2 to 5 for a wind sea."""
    depth: float = math.inf
    """Depth of the water [m]; it shortens the waves and leaves the spectrum as it is."""
    gravity: float = GRAVITY
    """Acceleration of gravity in the dispersion relation, g [m/s^2]."""


@dataclasses.dataclass(frozen=True)
class JonswapSea(IrregularSea):
    """A sea of the JONSWAP spectrum as a sum of Airy waves.

    S = A omega^-5 exp(-5/4 (omega / omega_p)^-4) gamma^exp(-(omega / omega_p - 1)^2 / (2 sigma^2)),
    sigma 0.07 below the peak and 0.09 above (Hasselmann et al. 1973; DNV-RP-C205, 3.5.5), with A
    such that the area is significant_height^2 / 16. With gamma 1 it is Pierson and Moskowitz's.

    The spectrum is cut into bands of equal energy, up to `distributions.CUTOFF`. Each band is one
    wave at the band's root mean square frequency, so that height and zero-crossing period are those
    of the spectrum whatever the seed. No two bands are equally wide, so that the sea does not
    repeat. The seed draws the phases from the Mersenne Twister, the same on every platform. It also
    deals out the directions, one for each wave, from equal shares of cos^2s((b - direction) / 2)
    (Longuet-Higgins et al. 1963).

    Raises:
        WaterError: a value out of its range.

    Example:
        >>> sea = JonswapSea(significant_height=0.5, peak_period=3.0, spreading=10.0, seed=7)
        >>> water = Water(waves=sea)
        >>> sea.zero_crossing_period
        2.34...
    """

    significant_height: float
    """Significant wave height Hs, four times the standard deviation of the elevation [m]."""
    peak_period: float
    """Period Tp of the waves with the most energy [s]."""
    gamma: float = dataclasses.field(default=3.3, kw_only=True)
    """Height of the peak over that of Pierson and Moskowitz's spectrum; 1 to 20."""

    def __post_init__(self) -> None:
        # numbers
        set_number(self, WaterError, "significant_height", least=0.0, most=LARGEST)
        set_number(self, WaterError, "peak_period", least=SMALLEST, most=LARGEST)
        set_number(self, WaterError, "gamma", least=1.0, most=20.0)
        set_number(self, WaterError, "direction")
        set_number(self, WaterError, "gravity", least=SMALLEST, most=STRONGEST)
        whole = {"components": (1, MOST_COMPONENTS), "seed": (0, 2**63 - 1)}
        for name, (least, most) in whole.items():
            number = read_whole_number(WaterError, name, getattr(self, name), least, most)
            object.__setattr__(self, name, number)
        object.__setattr__(self, "depth", read_depth(self.depth))
        spreading = read_positive(
            "spreading", self.spreading, "an exponent above 0, or inf for long crests"
        )
        object.__setattr__(self, "spreading", spreading)

        # what they mean together
        if self.significant_height > self.depth:
            raise WaterError(
                f"significant_height is {self.significant_height} m in water {self.depth} m deep; "
                "such waves break far outside: make them lower, or the water deeper"
            )
        k = wavenumber(2.0 * math.pi / self.peak_period, self.depth, self.gravity)
        shortest = max(SHORTEST, self.significant_height)
        if 2.0 * math.pi / k < shortest:
            raise WaterError(
                f"a sea with a peak_period of {self.peak_period:g} s and a significant_height of "
                f"{self.significant_height:g} m would have waves {2.0 * math.pi / k:.3g} m long at "
                f"its peak; they must be at least {SHORTEST} m long, and longer than high"
            )

    def spectrum(self, omega: ArrayLike) -> NDArray[np.float64]:
        """Energy density S [m^2 s], whose integral over omega is Hs^2 / 16.

        Args:
            omega: angular frequencies (any shape) [rad/s].
        """
        ratio = np.asarray(omega, float) * self.peak_period / (2.0 * math.pi)
        zeroth, _ = self._moments
        energy = (self.significant_height / 4.0) ** 2
        scale = energy / zeroth * self.peak_period / (2.0 * math.pi)
        return scale * jonswap_shape(ratio, self.gamma)

    @property
    def zero_crossing_period(self) -> float:
        """Mean time between two upward crossings of the still level, 2 pi sqrt(m0 / m2) [s]."""
        zeroth, second = self._moments
        return self.peak_period * math.sqrt(zeroth / second)

    @property
    def _moments(self) -> tuple[float, float]:
        """Zeroth and second moment of the spectrum's shape over omega / omega_p."""
        _, zeroth, second = jonswap_moments(self.gamma)
        return float(zeroth[-1]), float(second[-1])

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """The waves as rows (components, 6), see `Wave.rows`."""
        n = self.components
        stream = random.Random(self.seed)
        phases = [2.0 * math.pi * stream.random() for _ in range(n)]
        omegas = self._frequencies()
        directions = self._directions(stream)
        k = np.array([wavenumber(omega, self.depth, self.gravity) for omega in omegas])
        amplitude = self.significant_height / 4.0 * math.sqrt(2.0 / n)
        rows = np.column_stack(
            [
                np.full(n, amplitude),
                k * np.cos(directions),
                k * np.sin(directions),
                omegas,
                phases,
                np.full(n, self.depth),
            ]
        )
        # the same for all who ask
        rows.setflags(write=False)
        return rows

    def _frequencies(self) -> NDArray[np.float64]:
        """Root mean square frequency of each band of equal energy (components,) [rad/s]."""
        n = self.components
        ratio, zeroth, second = jonswap_moments(self.gamma)
        edges = np.interp(np.arange(n + 1) * zeroth[-1] / n, zeroth, ratio)
        squares = np.diff(np.interp(edges, ratio, second)) / (zeroth[-1] / n)
        omegas: NDArray[np.float64] = np.sqrt(squares) * 2.0 * math.pi / self.peak_period
        return omegas

    def _directions(self, stream: random.Random) -> NDArray[np.float64]:
        """Direction of each wave (components,) [rad], dealt out by a stream of random numbers."""
        n = self.components
        directions = np.full(n, self.direction)
        if math.isinf(self.spreading):
            return directions
        shares = [(i + 0.5) / n for i in range(n)]
        stream.shuffle(shares)
        return directions + spreading_angles(self.spreading, np.array(shares))

    @property
    def warning(self) -> str:
        """A clause that says how much too steep the sea is for nature; empty if it is not.

        The mean steepness 2 pi Hs / (g Tp^2) stays below 1/15 up to a Tp of 8 s, and below 1/25
        from 15 s up, with straight lines between (DNV-RP-C205, 3.5.4).
        """
        steepest = float(np.interp(self.peak_period, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))
        limit = steepest * self.gravity * self.peak_period**2 / (2.0 * math.pi)
        if self.significant_height <= limit:
            return ""
        return (
            f"a sea {self.significant_height:.3g} m high at {self.peak_period:.3g} s, "
            f"{self.significant_height / limit:.2f} times as steep as seas get before their waves "
            f"break; make it at most {limit:.3g} m high"
        )


@dataclasses.dataclass(frozen=True)
class PiersonMoskowitzSea(IrregularSea):
    """A wind sea of the spectrum of Pierson and Moskowitz (1964): `JonswapSea` with gamma 1.

    Without a peak period it is fully developed, with alpha = 0.0081:
    omega_p = (16 alpha g^2 / (5 Hs^2))^(1/4).

    Raises:
        WaterError: a value out of its range.

    Example:
        >>> PiersonMoskowitzSea(significant_height=2.0).peak_period
        7.07...
    """

    significant_height: float
    """Significant wave height Hs, four times the standard deviation of the elevation [m]."""
    peak_period: float = math.nan
    """Period Tp of the waves with the most energy [s]; by default it follows from the height."""

    def __post_init__(self) -> None:
        if isinstance(self.peak_period, float) and math.isnan(self.peak_period):
            height = read_number(
                WaterError, "significant_height", self.significant_height, above=0.0
            )
            gravity = read_number(
                WaterError, "gravity", self.gravity, least=SMALLEST, most=STRONGEST
            )
            omega = (16.0 * ALPHA / 5.0) ** 0.25 * math.sqrt(gravity / height)
            object.__setattr__(self, "peak_period", 2.0 * math.pi / omega)

        # this checks all the rest
        _ = self.as_jonswap

    @functools.cached_property
    def as_jonswap(self) -> JonswapSea:
        """The same sea under its more general name."""
        options = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return JonswapSea(**options, gamma=1.0)

    @property
    def rows(self) -> NDArray[np.float64]:
        """The waves as rows (components, 6), see `Wave.rows`."""
        return self.as_jonswap.rows

    @property
    def warning(self) -> str:
        """A clause that says how much too steep the sea is, see `JonswapSea.warning`."""
        return self.as_jonswap.warning

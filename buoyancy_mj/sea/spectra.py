"""Irregular seas: spectra of the field as sums of Airy waves, the same everywhere for a seed."""

import dataclasses
import functools
import math
import random
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.currents import Current, is_still
from buoyancy_mj.sea.dispersion import (
    Dispersion,
    intrinsic_frequency,
    read_frame,
    wavenumber,
)
from buoyancy_mj.sea.distributions import jonswap_moments, jonswap_shape, spreading_angles
from buoyancy_mj.sea.gravity import or_default, read_stated
from buoyancy_mj.sea.irregular import (
    MOST_COMPONENTS,
    IrregularSea,
    SeaOnCurrent,
    describe_blocked,
)
from buoyancy_mj.sea.ranges import (
    LARGEST,
    SHORTEST,
    SMALLEST,
    read_depth,
    read_positive,
)
from buoyancy_mj.sea.waves import Wave
from buoyancy_mj.values import read_number, read_whole_number, set_number

ALPHA = 0.0081
"""Pierson and Moskowitz's constant of fully developed seas, S = ALPHA g^2 omega^-5 exp(...)."""


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

    On a current the spectrum is what an observer at rest measures there, or with `frame` "water"
    what one measures who drifts with the current. Waves that the current blocks are left out, with
    a warning, up to `irregular.MOST_BLOCKED` of the energy.

    Raises:
        WaterError: a value out of its range. `Water` raises it if the current blocks more.

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
        object.__setattr__(self, "gravity", read_stated(self.gravity))
        whole = {"components": (1, MOST_COMPONENTS), "seed": (0, 2**63 - 1)}
        for name, (least, most) in whole.items():
            number = read_whole_number(WaterError, name, getattr(self, name), least, most)
            object.__setattr__(self, name, number)
        object.__setattr__(self, "depth", read_depth(self.depth))
        object.__setattr__(self, "frame", read_frame(self.frame))
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
        k = wavenumber(2.0 * math.pi / self.peak_period, self.depth, or_default(self.gravity))
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
        """The waves in still water as rows (components, 6), see `Wave.rows`."""
        omegas, directions, phases = self._waves
        k = np.array([wavenumber(omega, self.depth, or_default(self.gravity)) for omega in omegas])
        return self._rows_of(k, directions, omegas, phases)

    def on(self, current: Current) -> Wave:
        """The sea on a current, as its water sees it, see `waves.CurrentWave.on`.

        Raises:
            WaterError: the current blocks more than `irregular.MOST_BLOCKED` of the energy.
        """
        if self.frame == "water" or is_still(current):
            return self

        # those that run there
        omegas, directions, phases = self._waves
        peak = 2.0 * math.pi / self.peak_period
        least, greatest = min(peak, omegas.min()), omegas.max()
        dispersion = Dispersion(current, self.depth, or_default(self.gravity), (least, greatest))
        k = np.array(list(map(dispersion.wavenumber, omegas, directions)))
        runs = np.isfinite(k)
        blocked = describe_blocked(omegas[~runs], self.components, self.peak_period)

        # as the water sees them
        k = k[runs]
        sigma = intrinsic_frequency(k, self.depth, or_default(self.gravity))
        rows = self._rows_of(k, directions[runs], sigma, phases[runs])
        at_peak = np.array([dispersion.wavenumber(peak, self.direction)])
        (seen,) = intrinsic_frequency(at_peak, self.depth, or_default(self.gravity))
        steep = self._describe_steepness(2.0 * math.pi / float(seen))
        return SeaOnCurrent(rows, ", and ".join(clause for clause in (blocked, steep) if clause))

    @functools.cached_property
    def _waves(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Frequencies [rad/s], directions [rad] and phases [rad] of the waves (components,)."""
        stream = random.Random(self.seed)
        phases = [2.0 * math.pi * stream.random() for _ in range(self.components)]
        return self._frequencies(), self._directions(stream), np.array(phases)

    def _rows_of(
        self,
        k: NDArray[np.float64],
        directions: NDArray[np.float64],
        omegas: NDArray[np.float64],
        phases: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Rows (n, 6) of waves with these wavenumbers, directions, frequencies and phases (n,)."""
        amplitude = self.significant_height / 4.0 * math.sqrt(2.0 / self.components)
        kx, ky = k * np.cos(directions), k * np.sin(directions)
        amplitudes, depths = np.full(len(k), amplitude), np.full(len(k), self.depth)
        rows = np.column_stack([amplitudes, kx, ky, omegas, phases, depths])
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
        """A clause that says how much too steep the sea is for nature; empty if it is not."""
        return self._describe_steepness(self.peak_period)

    def _describe_steepness(self, peak_period: float) -> str:
        """A clause that says how much too steep the sea is; empty if it is not.

        The mean steepness 2 pi Hs / (g Tp^2) stays below 1/15 up to a Tp of 8 s, and below 1/25
        from 15 s up, with straight lines between (DNV-RP-C205, 3.5.4).

        Args:
            peak_period: Tp as the water sees it [s]; NaN if no such wave runs.
        """
        steepest = float(np.interp(peak_period, [8.0, 15.0], [1.0 / 15.0, 1.0 / 25.0]))
        limit = steepest * or_default(self.gravity) * peak_period**2 / (2.0 * math.pi)
        if not self.significant_height > limit:
            return ""
        return (
            f"a sea {self.significant_height:.3g} m high at {peak_period:.3g} s, "
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
    is_developed = False
    """Whether the peak period was left to follow from the height."""

    def __post_init__(self) -> None:
        if isinstance(self.peak_period, float) and math.isnan(self.peak_period):
            height = read_number(
                WaterError, "significant_height", self.significant_height, above=0.0
            )
            gravity = or_default(read_stated(self.gravity))
            omega = (16.0 * ALPHA / 5.0) ** 0.25 * math.sqrt(gravity / height)
            object.__setattr__(self, "peak_period", 2.0 * math.pi / omega)
            object.__setattr__(self, "is_developed", True)

        # this checks all the rest
        _ = self.as_jonswap

    @functools.cached_property
    def as_jonswap(self) -> JonswapSea:
        """The same sea under its more general name."""
        options = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        return JonswapSea(**options, gamma=1.0)

    @property
    def rows(self) -> NDArray[np.float64]:
        """The waves in still water as rows (components, 6), see `Wave.rows`."""
        return self.as_jonswap.rows

    def with_gravity(self, gravity: float) -> Self:
        """The same sea under this acceleration of gravity [m/s^2], see `sea.gravity`.

        A peak period that follows from the height does so again.
        """
        peak_period = math.nan if self.is_developed else self.peak_period
        return dataclasses.replace(self, gravity=gravity, peak_period=peak_period)

    def on(self, current: Current) -> Wave:
        """The sea on a current, as its water sees it, see `JonswapSea.on`."""
        return self.as_jonswap.on(current)

    @property
    def warning(self) -> str:
        """A clause that says how much too steep the sea is, see `JonswapSea.warning`."""
        return self.as_jonswap.warning

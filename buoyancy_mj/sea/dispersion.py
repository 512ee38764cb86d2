"""How long a wave is: the dispersion relation of linear waves, in still water and on a current."""

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import WaterError, choices, describe
from buoyancy_mj.sea.currents import Current, current_rows, effective_current
from buoyancy_mj.sea.ranges import LARGEST, SHORTEST, SMALLEST, STRONGEST, read_depth
from buoyancy_mj.values import read_number

GRAVITY = 9.81
"""Default acceleration of gravity [m/s^2], the same as MuJoCo's."""
FRAMES = ("earth", "water")
"""Who sees a frequency: an observer at rest, or one that drifts with the current."""
_STEP = 0.02
"""Step of the wavenumbers among which roots are looked for, over the wavenumber."""


def read_frame(value: object) -> str:
    """One of `FRAMES`.

    Raises:
        WaterError: the value is none.
    """
    if not isinstance(value, str) or value not in FRAMES:
        raise WaterError(f"frame is {describe(value)}; {choices(value, FRAMES)}")
    return value


def wavenumber(
    omega: float, depth: float = math.inf, gravity: float = GRAVITY, current: float = 0.0
) -> float:
    """Wavenumber k [rad/m] that solves the dispersion relation (omega - k U)^2 = g k tanh(k h).

    Against a current two waves may have one frequency; this is the longer one, which also runs
    where the current ends.

    Args:
        omega: angular frequency that an observer at rest sees [rad/s].
        depth: depth of the water, h [m].
        gravity: acceleration of gravity, g [m/s^2].
        current: speed of the current along the wave, U [m/s]; negative against it.

    Raises:
        WaterError: a value out of its range, or a current that blocks the wave.

    Example:
        >>> wavenumber(0.785, depth=10.0)
        0.0885...
        >>> wavenumber(0.785, depth=10.0, current=-1.0)
        0.1036...
    """
    # values in their ranges: frequencies and periods of waves lie from `SMALLEST` to `LARGEST`
    omega = read_number(WaterError, "omega", omega, least=SMALLEST, most=10.0 * LARGEST)
    depth = read_depth(depth)
    gravity = read_number(WaterError, "gravity", gravity, least=SMALLEST, most=STRONGEST)
    current = read_number(WaterError, "current", current, least=-LARGEST, most=LARGEST)

    if current == 0.0:
        return _wavenumber_in_still_water(omega, depth, gravity)
    dispersion = Dispersion((current, 0.0, 0.0), depth, gravity, (omega, omega))
    k = dispersion.wavenumber(omega, 0.0)
    if math.isnan(k):
        limit = describe_limit(dispersion.highest_frequency(0.0))
        raise WaterError(
            f"no wave with an omega of {omega:g} rad/s runs against a current of {-current:g} m/s, "
            f"which blocks {limit}; make omega or the current less"
        )
    return k


def _wavenumber_in_still_water(omega: float, depth: float, gravity: float) -> float:
    """Wavenumber k [rad/m] that solves omega^2 = g k tanh(k h)."""
    # tanh is 1 to round-off
    deep = omega**2 / gravity
    if math.isinf(depth) or deep * depth > 20.0:
        return deep

    # k h lies above both its deep value and its shallow one, sqrt(deep h), and below their sum
    shallow = math.sqrt(deep * depth)
    low, high = max(deep * depth, shallow), deep * depth + shallow
    kh = scipy.optimize.brentq(
        lambda q: q * math.tanh(q) - deep * depth, low * 0.999, high, xtol=1e-300, rtol=1e-14
    )
    return float(kh) / depth


def intrinsic_frequency(
    wavenumbers: NDArray[np.float64], depth: float, gravity: float
) -> NDArray[np.float64]:
    """Angular frequency sigma = sqrt(g k tanh(k h)) that the water sees (n,) [rad/s].

    Args:
        wavenumbers: k (n,) [rad/m].
        depth: depth of the water, h [m].
        gravity: acceleration of gravity, g [m/s^2].
    """
    frequencies: NDArray[np.float64] = np.sqrt(gravity * wavenumbers * np.tanh(wavenumbers * depth))
    return frequencies


def describe_limit(highest: float) -> str:
    """Which waves are blocked that may have an angular frequency of at most `highest` [rad/s]."""
    if highest <= 0.0:
        return "waves of any period"
    return f"waves with a period of less than {2.0 * math.pi / highest:.4g} s"


class Dispersion:
    """The dispersion relation on a current, omega = sqrt(g k tanh(k h)) + k . U(k).

    omega is what an observer at rest sees, and U(k) the current that the wave feels, see
    `currents.effective_current`.

    Args:
        current: the current.
        depth: depth of the water, h [m].
        gravity: acceleration of gravity, g [m/s^2].
        frequencies: least and greatest omega that will be asked for [rad/s].
    """

    def __init__(
        self, current: Current, depth: float, gravity: float, frequencies: tuple[float, float]
    ) -> None:
        self._current, self._depth, self._gravity = current, depth, gravity

        # from waves too long to have the least frequency on any current to the shortest of all
        least, greatest = frequencies
        fastest = float(np.linalg.norm(current_rows(current)[:, 1:3], axis=1).max())
        longest = _wavenumber_in_still_water(0.5 * least, depth, gravity)
        if fastest > 0.0:
            longest = min(longest, 0.5 * least / fastest)
        shortest = 8.0 * _wavenumber_in_still_water(greatest, depth, gravity)
        shortest = max(2.0 * math.pi / SHORTEST, shortest)
        low, high = math.log(1e-4 * longest), math.log(shortest)
        self._k = np.exp(np.linspace(low, high, math.ceil((high - low) / _STEP)))
        """Wavenumbers (n,) among which roots are looked for [rad/m]."""
        self._sigma = intrinsic_frequency(self._k, depth, gravity)
        self._felt = effective_current(current, self._k, depth)

    def wavenumber(self, omega: float, direction: float) -> float:
        """Wavenumber [rad/m] of the longest wave with a frequency; NaN if the current blocks it.

        Args:
            omega: angular frequency that an observer at rest sees [rad/s].
            direction: that the wave runs to, from x towards y [rad].
        """
        # the first wavenumbers between which it lies
        frequencies = self._frequencies(direction)
        at = int(np.argmax(frequencies >= omega))
        low, high = float(self._k[at - 1]), float(self._k[at])
        if frequencies[at] < omega:
            low, high = float(self._k[0]), self._highest(direction)
            if self._frequency(high, direction) < omega:
                return math.nan
        return float(
            scipy.optimize.brentq(
                lambda k: self._frequency(k, direction) - omega, low, high, xtol=1e-300, rtol=1e-14
            )
        )

    def highest_frequency(self, direction: float) -> float:
        """Greatest omega of waves in a direction [rad/s], as far as they are not too short."""
        return self._frequency(self._highest(direction), direction)

    def _highest(self, direction: float) -> float:
        """Wavenumber with the greatest omega in a direction [rad/m]."""
        at = int(np.argmax(self._frequencies(direction)))
        low, high = self._k[max(at - 1, 0)], self._k[min(at + 1, len(self._k) - 1)]
        found = scipy.optimize.minimize_scalar(
            lambda k: -self._frequency(k, direction),
            bounds=(low, high),
            method="bounded",
            options={"xatol": 1e-9 * high},
        )
        return float(found.x)

    def _frequencies(self, direction: float) -> NDArray[np.float64]:
        """Frequency at rest of all wavenumbers in a direction (n,) [rad/s]."""
        along = self._felt @ [math.cos(direction), math.sin(direction)]
        frequencies: NDArray[np.float64] = self._sigma + self._k * along
        return frequencies

    def _frequency(self, k: float, direction: float) -> float:
        """Frequency at rest of one wavenumber in a direction [rad/s]."""
        ((u, v),) = effective_current(self._current, np.array([k]), self._depth)
        sigma = math.sqrt(self._gravity * k * math.tanh(k * self._depth))
        return sigma + k * (float(u) * math.cos(direction) + float(v) * math.sin(direction))

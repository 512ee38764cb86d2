"""Waves: the protocol that all follow, the regular wave, and a level that goes up and down."""

import dataclasses
import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.ranges import LARGEST, SHORTEST, SMALLEST, STRONGEST, read_depth
from buoyancy_mj.values import read_number, set_number

GRAVITY = 9.81
"""Default acceleration of gravity [m/s^2], the same as MuJoCo's."""
STEEPEST = 0.142
"""Height over wavelength above which regular waves break in deep water (Miche 1944).

In water of depth h the limit is this times tanh(k h)."""
FASTEST = 100.0
"""Greatest frequency of a level that goes up and down [Hz]; timesteps resolve no more."""


class Wave(Protocol):
    """Anything whose elevation is a sum of A cos(kx x + ky y - omega t + phase)."""

    @property
    def rows(self) -> NDArray[np.float64]:
        """Components of the wave as rows (n, 6), as `kernels.waves` reads them.

        The columns are amplitude A [m], wavenumbers kx and ky [rad/m], angular frequency omega
        [rad/s], phase [rad] and depth of the water [m].
        """
        ...


@dataclasses.dataclass(frozen=True)
class RegularWave:
    """A linear (Airy) wave with the elevation A cos(k (x cos b + y sin b) - omega t + phase).

    Exactly one of `frequency`, `period` and `wavelength` is needed. The other two follow from the
    dispersion relation omega^2 = g k tanh(k h) (Newman 1977, 6.2). Waves in nature break where they
    are steeper than `STEEPEST`; this one does not, but `warning` says so.

    Raises:
        WaterError: none or several of the three, a value out of its range, a wave shorter than
            `ranges.SHORTEST`, or one that is higher than long.

    Example:
        >>> RegularWave(0.3, period=4.0).wavelength
        24.98...
    """

    amplitude: float
    """Half the height from trough to crest, A [m]."""
    frequency: float = dataclasses.field(default=math.nan, kw_only=True)
    """Cycles per second [Hz]."""
    period: float = dataclasses.field(default=math.nan, kw_only=True)
    """Time between two crests at one place [s]."""
    wavelength: float = dataclasses.field(default=math.nan, kw_only=True)
    """Distance between two crests [m]."""
    direction: float = dataclasses.field(default=0.0, kw_only=True)
    """Direction that the wave runs to, b, from x towards y [rad]."""
    phase: float = dataclasses.field(default=0.0, kw_only=True)
    """Phase at the origin at time 0 [rad]; 0 is a crest."""
    depth: float = dataclasses.field(default=math.inf, kw_only=True)
    """Depth of the water, h [m]."""
    gravity: float = dataclasses.field(default=GRAVITY, kw_only=True)
    """Acceleration of gravity in the dispersion relation, g [m/s^2]."""

    def __post_init__(self) -> None:
        # values in their ranges
        set_number(self, WaterError, "amplitude", least=0.0, most=LARGEST)
        set_number(self, WaterError, "direction")
        set_number(self, WaterError, "phase")
        set_number(self, WaterError, "gravity", least=SMALLEST, most=STRONGEST)
        object.__setattr__(self, "depth", read_depth(self.depth))
        if self.amplitude > self.depth:
            raise WaterError(
                f"amplitude is {self.amplitude} m in water {self.depth} m deep; "
                "the trough would lie below the bottom"
            )

        # one of three; the other two follow
        three = {name: getattr(self, name) for name in ("frequency", "period", "wavelength")}
        known = {name: value for name, value in three.items() if not _is_default(value)}
        if len(known) != 1:
            raise WaterError(
                f"a regular wave got {' and '.join(known) or 'none'}; "
                "give exactly one of frequency [Hz], period [s], wavelength [m]"
            )
        ((name, value),) = known.items()
        number = read_number(WaterError, name, value, least=SMALLEST, most=LARGEST)
        self._complete(name, number)
        self._check_length(name, number)

    def _complete(self, name: str, value: float) -> None:
        """Set the two of frequency, period and wavelength that follow from the third."""
        object.__setattr__(self, name, value)
        if name == "wavelength":
            k = 2.0 * math.pi / value
            frequency = math.sqrt(self.gravity * k * math.tanh(k * self.depth)) / (2.0 * math.pi)
        else:
            frequency = value if name == "frequency" else 1.0 / value
        object.__setattr__(self, "frequency", frequency)
        if name != "period":
            object.__setattr__(self, "period", 1.0 / frequency)
        if name != "wavelength":
            k = wavenumber(2.0 * math.pi * frequency, self.depth, self.gravity)
            object.__setattr__(self, "wavelength", 2.0 * math.pi / k)

    def _check_length(self, name: str, value: float) -> None:
        """Refuse a length that no wave has, and a wave that is higher than long."""
        if not SHORTEST <= self.wavelength <= LARGEST**3:
            raise WaterError(
                f"a wave with a {name} of {value:g} would be {self.wavelength:.3g} m long; waves "
                f"that gravity makes are at least {SHORTEST} m long"
            )
        height = 2.0 * self.amplitude
        if height > self.wavelength:
            raise WaterError(
                f"a wave {height:.3g} m high and {self.wavelength:.3g} m long is higher than long; "
                f"it would break at {STEEPEST * self.wavelength:.3g} m: make it lower or longer"
            )

    @property
    def rows(self) -> NDArray[np.float64]:
        """The wave as one row (1, 6), see `Wave.rows`."""
        k, omega = 2.0 * math.pi / self.wavelength, 2.0 * math.pi * self.frequency
        kx, ky = k * math.cos(self.direction), k * math.sin(self.direction)
        return np.array([[self.amplitude, kx, ky, omega, self.phase, self.depth]])

    @property
    def warning(self) -> str:
        """A clause that says how much too steep the wave is for nature; empty if it is not."""
        height = 2.0 * self.amplitude
        limit = STEEPEST * self.wavelength * math.tanh(2.0 * math.pi / self.wavelength * self.depth)
        if height <= limit:
            return ""
        return (
            f"a wave {height:.3g} m high and {self.wavelength:.3g} m long, {height / limit:.2f} "
            f"times as steep as one that breaks; make it at most {limit:.3g} m high"
        )


@dataclasses.dataclass(frozen=True)
class LevelOscillation:
    """The whole level goes up and down, A cos(omega t - phase): an infinitely long wave.

    It is the moving plane of Mahbub and Shaharear (2025), "water height fluctuating between -0.3 m
    and 0.3 m at 0.5 Hz". The water moves with its level, all of it vertically.

    Raises:
        WaterError: a value out of its range.

    Example:
        >>> water = Water(waves=LevelOscillation(amplitude=0.3, frequency=0.5))
        >>> float(water.elevation(x=0.0, y=0.0, time=1.0))
        -0.3
    """

    amplitude: float
    """Half the distance between the highest and the lowest level, A [m]."""
    frequency: float
    """Cycles per second [Hz]."""
    phase: float = 0.0
    """Phase at time 0 [rad]; 0 starts at the highest level, pi/2 at the mean one, going up."""

    def __post_init__(self) -> None:
        set_number(self, WaterError, "amplitude", least=0.0, most=LARGEST)
        set_number(self, WaterError, "frequency", least=SMALLEST, most=FASTEST)
        set_number(self, WaterError, "phase")

    @property
    def rows(self) -> NDArray[np.float64]:
        """The oscillation as one row (1, 6), see `Wave.rows`."""
        omega = 2.0 * math.pi * self.frequency
        return np.array([[self.amplitude, 0.0, 0.0, omega, self.phase, math.inf]])


def wavenumber(omega: float, depth: float = math.inf, gravity: float = GRAVITY) -> float:
    """Wavenumber k [rad/m] that solves the dispersion relation omega^2 = g k tanh(k h).

    Args:
        omega: angular frequency [rad/s].
        depth: depth of the water, h [m].
        gravity: acceleration of gravity, g [m/s^2].

    Example:
        >>> wavenumber(0.785, depth=10.0)
        0.0885...
    """
    # tanh is 1 to round-off
    deep = omega**2 / gravity
    if math.isinf(depth) or deep * depth > 20.0:
        return deep

    # k h lies above both its deep value and its shallow one, sqrt(deep h), and below their sum
    shallow = math.sqrt(deep * depth)
    low, high = max(deep * depth, shallow), deep * depth + shallow
    kh = brentq(
        lambda q: q * math.tanh(q) - deep * depth, low * 0.999, high, xtol=1e-15, rtol=1e-14
    )
    return float(kh) / depth


def _is_default(value: object) -> bool:
    """Whether a field was left at its default."""
    return isinstance(value, float) and math.isnan(value)

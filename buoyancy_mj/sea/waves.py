"""Waves: the protocol that all follow, the regular one, and a level that goes up and down."""

import dataclasses
import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from buoyancy_mj.errors import WaterError

SMALLEST, LARGEST = 1e-6, 1e6
"""Bounds of frequencies, periods, wavelengths, depths and levels, in SI units: none in nature comes near them."""
GRAVITY = 9.81
"""Acceleration [m/s^2] in the dispersion relation when nobody says otherwise: MuJoCo's default."""
STEEPEST = 0.142
"""Height over wavelength above which regular waves break in deep water; times tanh k h in others (Miche 1944)."""


class Wave(Protocol):
    """Anything whose elevation is a sum of A cos(kx x + ky y - omega t + phase)."""

    @property
    def rows(self) -> NDArray[np.float64]:
        """(n, 6) of amplitude [m], kx, ky [rad/m], omega [rad/s], phase [rad], water depth [m]."""
        ...


@dataclasses.dataclass(frozen=True)
class RegularWave:
    """A linear (Airy) wave, elevation A cos(k (x cos b + y sin b) - omega t + phase).

    Give exactly one of `frequency`, `period`, `wavelength`; the others follow from the dispersion
    relation omega^2 = g k tanh(k h) (Newman 1977, 6.2). Real waves break where they are steeper than
    `STEEPEST`, which this one does not; `warning` tells.

    Raises:
        WaterError: none or several of the three given, or a value out of its range.
    """

    amplitude: float
    """Half the crest-to-trough height [m]."""
    frequency: float = dataclasses.field(default=math.nan, kw_only=True)
    """Cycles per second [Hz]."""
    period: float = dataclasses.field(default=math.nan, kw_only=True)
    """Time between two crests at one place [s]."""
    wavelength: float = dataclasses.field(default=math.nan, kw_only=True)
    """Distance between two crests [m]."""
    direction: float = dataclasses.field(default=0.0, kw_only=True)
    """Where the wave runs to, b, from x towards y [rad]."""
    phase: float = dataclasses.field(default=0.0, kw_only=True)
    """Phase at the origin at time 0 [rad]; 0 is a crest."""
    depth: float = dataclasses.field(default=math.inf, kw_only=True)
    """Depth of the water h [m]."""
    gravity: float = dataclasses.field(default=GRAVITY, kw_only=True)
    """g in the dispersion relation [m/s^2]."""

    def __post_init__(self) -> None:
        finite("amplitude", self.amplitude, least=0.0)
        finite("direction", self.direction)
        finite("phase", self.phase)
        finite("gravity", self.gravity, above=0.0)
        water_depth(self.depth)
        if self.amplitude > self.depth:
            raise WaterError(
                f"amplitude is {self.amplitude} m in water {self.depth} m deep; the trough would lie below the bottom"
            )
        given = {name: getattr(self, name) for name in ("frequency", "period", "wavelength")}
        told = {name: value for name, value in given.items() if not _is_nan(value)}
        if len(told) != 1:
            got = " and ".join(told) or "none"
            raise WaterError(
                f"a regular wave got {got}; give exactly one of frequency [Hz], period [s], wavelength [m]"
            )
        (name, value), *_ = told.items()
        finite(name, value, least=SMALLEST, most=LARGEST)
        # the other two follow
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
        if not SMALLEST**2 <= self.wavelength <= LARGEST**3:
            raise WaterError(
                f"a wave with a {name} of {value} would be {self.wavelength:.3g} m long; give another {name}"
            )

    @property
    def rows(self) -> NDArray[np.float64]:
        """The wave as one row (1, 6), see `Wave`."""
        k, omega = 2.0 * math.pi / self.wavelength, 2.0 * math.pi * self.frequency
        kx, ky = k * math.cos(self.direction), k * math.sin(self.direction)
        return np.array([[self.amplitude, kx, ky, omega, self.phase, self.depth]])

    @property
    def warning(self) -> str:
        """What speaks against such a wave in nature, a clause; empty if nothing does."""
        most = STEEPEST * self.wavelength * math.tanh(2.0 * math.pi / self.wavelength * self.depth)
        if 2.0 * self.amplitude <= most:
            return ""
        return (
            f"a wave {2.0 * self.amplitude:.3g} m high and {self.wavelength:.3g} m long, {2.0 * self.amplitude / most:.2f} "
            f"times as steep as one that breaks; make it at most {most:.3g} m high"
        )


@dataclasses.dataclass(frozen=True)
class LevelOscillation:
    """The whole level going up and down, A cos(omega t - phase): an infinitely long wave.

    It is the moving plane of Mahbub and Shaharear (2025), "water height fluctuating between -0.3 m
    and 0.3 m at 0.5 Hz". The water moves with its level, all of it vertically.

    Raises:
        WaterError: a value out of its range.
    """

    amplitude: float
    """Half the distance between highest and lowest level [m]."""
    frequency: float
    """Cycles per second [Hz]."""
    phase: float = 0.0
    """Phase at time 0 [rad]; 0 starts at the highest level, pi/2 at the mean one, going up."""

    def __post_init__(self) -> None:
        finite("amplitude", self.amplitude, least=0.0)
        finite("frequency", self.frequency, least=SMALLEST, most=LARGEST)
        finite("phase", self.phase)

    @property
    def rows(self) -> NDArray[np.float64]:
        """The oscillation as one row (1, 6), see `Wave`."""
        return np.array(
            [[self.amplitude, 0.0, 0.0, 2.0 * math.pi * self.frequency, self.phase, math.inf]]
        )


def wavenumber(omega: float, depth: float = math.inf, gravity: float = GRAVITY) -> float:
    """Wavenumber k [rad/m] with omega^2 = g k tanh(k h), for omega [rad/s], depth h [m], g [m/s^2]."""
    deep = omega**2 / gravity
    if math.isinf(depth) or deep * depth > 20.0:
        return deep
    # k h lies above both its deep value and its shallow one, sqrt(deep h), and below their sum
    low, high = max(deep * depth, math.sqrt(deep * depth)), deep * depth + math.sqrt(deep * depth)
    kh = brentq(
        lambda q: q * math.tanh(q) - deep * depth, low * 0.999, high, xtol=1e-15, rtol=1e-14
    )
    return float(kh) / depth


def water_depth(value: object) -> None:
    """Refuse what is no depth of water."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not value >= SMALLEST:
        raise WaterError(
            f"wave depth is {value!r}; it must be at least {SMALLEST:g} m (inf is deep water)"
        )


def _is_nan(value: object) -> bool:
    """Whether a field was left at its default."""
    return isinstance(value, float) and math.isnan(value)


def finite(
    name: str,
    value: object,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
) -> None:
    """Refuse what is not a finite number in range."""
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

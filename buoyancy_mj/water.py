"""`Water` and its waves: everything the sea is."""

import dataclasses
import functools
import math
from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from buoyancy_mj.errors import WaterError
from buoyancy_mj.kernels import waves as kernels

SMALLEST, LARGEST = 1e-6, 1e6
"""Bounds of frequencies, periods, wavelengths, depths and levels, in SI units: none in nature comes near them."""
MOST_WAVES = 10_000
"""Waves at once: each costs its time in every step."""
GRAVITY = 9.81
"""Acceleration [m/s^2] in the dispersion relation when nobody says otherwise: MuJoCo's default."""


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
    relation omega^2 = g k tanh(k h) (Newman 1977, 6.2). Above an amplitude of 0.07 wavelengths real
    waves break, which this one does not.

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
        _finite("amplitude", self.amplitude, least=0.0)
        _finite("direction", self.direction)
        _finite("phase", self.phase)
        _finite("gravity", self.gravity, above=0.0)
        if isinstance(self.depth, bool) or not isinstance(self.depth, int | float) or not self.depth >= SMALLEST:
            raise WaterError(f"wave depth is {self.depth!r}; it must be at least {SMALLEST:g} m (inf is deep water)")
        if self.amplitude > self.depth:
            raise WaterError(
                f"amplitude is {self.amplitude} m in water {self.depth} m deep; the trough would lie below the bottom"
            )
        given = {name: getattr(self, name) for name in ("frequency", "period", "wavelength")}
        told = {name: value for name, value in given.items() if not _is_nan(value)}
        if len(told) != 1:
            got = " and ".join(told) or "none"
            raise WaterError(f"a regular wave got {got}; give exactly one of frequency [Hz], period [s], wavelength [m]")
        (name, value), *_ = told.items()
        _finite(name, value, least=SMALLEST, most=LARGEST)
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
            raise WaterError(f"a wave with a {name} of {value} would be {self.wavelength:.3g} m long; give another {name}")

    @property
    def rows(self) -> NDArray[np.float64]:
        """The wave as one row (1, 6), see `Wave`."""
        k, omega = 2.0 * math.pi / self.wavelength, 2.0 * math.pi * self.frequency
        kx, ky = k * math.cos(self.direction), k * math.sin(self.direction)
        return np.array([[self.amplitude, kx, ky, omega, self.phase, self.depth]])


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
        _finite("amplitude", self.amplitude, least=0.0)
        _finite("frequency", self.frequency, least=SMALLEST, most=LARGEST)
        _finite("phase", self.phase)

    @property
    def rows(self) -> NDArray[np.float64]:
        """The oscillation as one row (1, 6), see `Wave`."""
        return np.array([[self.amplitude, 0.0, 0.0, 2.0 * math.pi * self.frequency, self.phase, math.inf]])


@dataclasses.dataclass(frozen=True)
class Water:
    """The sea: its density, its still level, the waves on it and the current in it.

    Raises:
        WaterError: a value out of its range, or a wave that is none.
    """

    density: float = 1000.0
    """Mass density rho [kg/m^3]; sea water has about 1025."""
    level: float = 0.0
    """World height of the still surface [m]."""
    waves: Wave | Sequence[Wave] = ()
    """One wave or several; elevations and velocities add up."""
    current: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Velocity of the water without the waves (3,) [m/s], world frame, everywhere the same."""

    def __post_init__(self) -> None:
        _finite("density", self.density, above=0.0)
        _finite("level", self.level, least=-LARGEST, most=LARGEST)
        waves = (self.waves,) if hasattr(self.waves, "rows") or not isinstance(self.waves, Sequence) else tuple(self.waves)
        for wave in waves:
            if not hasattr(wave, "rows"):
                raise WaterError(f"{wave!r} is no wave; possible are RegularWave and LevelOscillation")
        count = sum(len(wave.rows) for wave in waves)
        if count > MOST_WAVES:
            raise WaterError(f"the sea has {count} waves; it may have {MOST_WAVES} at most, so leave out the smallest")
        object.__setattr__(self, "waves", waves)
        try:
            current = np.asarray(self.current, float)
        except (TypeError, ValueError):
            current = np.array(np.nan)
        if current.shape != (3,) or not np.isfinite(current).all():
            raise WaterError(f"current is {self.current!r}; it must be three finite numbers [m/s]")
        object.__setattr__(self, "current", tuple(current.tolist()))

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """All waves as rows (n, 6), see `Wave`."""
        return np.concatenate([np.zeros((0, 6)), *(wave.rows for wave in self.waves)])  # type: ignore[union-attr]

    @functools.cached_property
    def curvature(self) -> float:
        """Bound of the surface's curvature, sum of A k^2 [1/m]."""
        rows = self.rows
        return float(np.sum(np.abs(rows[:, 0]) * (rows[:, 1] ** 2 + rows[:, 2] ** 2)))

    def elevation(self, x: ArrayLike, y: ArrayLike, time: float) -> NDArray[np.float64]:
        """Height of the surface [m], world frame, at points x, y (any shape) [m] and a time [s]."""
        xs, ys = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        out = np.empty(xs.size)
        kernels.elevations(self.rows, xs.ravel(), ys.ravel(), float(time), out)
        return self.level + out.reshape(xs.shape)

    def depth(self, points: ArrayLike, time: float) -> NDArray[np.float64]:
        """How deep points (..., 3) [m] are under the surface at a time [s]; positive in the water."""
        p = np.asarray(points, float)
        return self.elevation(p[..., 0], p[..., 1], time) - p[..., 2]

    def velocity(self, points: ArrayLike, time: float) -> NDArray[np.float64]:
        """Velocity of the water (..., 3) [m/s] at points (..., 3) [m] and a time [s]: current and waves."""
        p = np.asarray(points, float)
        out = np.tile(np.array(self.current), (p.size // 3, 1))
        kernels.velocities(self.rows, p.reshape(-1, 3), self.level, float(time), out)
        return out.reshape(p.shape)


def wavenumber(omega: float, depth: float = math.inf, gravity: float = GRAVITY) -> float:
    """Wavenumber k [rad/m] with omega^2 = g k tanh(k h), for omega [rad/s], depth h [m], g [m/s^2]."""
    deep = omega**2 / gravity
    if math.isinf(depth) or deep * depth > 20.0:
        return deep
    # k h lies above both its deep value and its shallow one, sqrt(deep h), and below their sum
    low, high = max(deep * depth, math.sqrt(deep * depth)), deep * depth + math.sqrt(deep * depth)
    kh = brentq(lambda q: q * math.tanh(q) - deep * depth, low * 0.999, high, xtol=1e-15, rtol=1e-14)
    return float(kh) / depth


def _is_nan(value: object) -> bool:
    """Whether a field was left at its default."""
    return isinstance(value, float) and math.isnan(value)


def _finite(name: str, value: object, *, above: float = -math.inf, least: float = -math.inf, most: float = math.inf) -> None:
    """Refuse what is not a finite number in range."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.number) or not math.isfinite(value):
        raise WaterError(f"{name} is {value!r}; it must be a finite number")
    if not value > above:
        raise WaterError(f"{name} is {value}; it must be above {above:g}")
    if not value >= least:
        raise WaterError(f"{name} is {value}; it must be at least {least:g}")
    if not value <= most:
        raise WaterError(f"{name} is {value}; it must be at most {most:g}")

"""Waves: the protocol that all follow, the regular wave, and a level that goes up and down."""

import dataclasses
import math
from typing import Any, Protocol, TypeGuard

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import WaterError
from buoyancy_mj.sea.currents import Current, is_still
from buoyancy_mj.sea.dispersion import (
    Dispersion,
    describe_limit,
    intrinsic_frequency,
    read_frame,
    wavenumber,
)
from buoyancy_mj.sea.gravity import or_default, read_stated
from buoyancy_mj.sea.ranges import LARGEST, SHORTEST, SMALLEST, read_depth
from buoyancy_mj.values import read_number, set_number

STEEPEST = 0.142
"""Height over wavelength above which regular waves break in deep water (Miche 1944).

In water of depth h the limit is this times tanh(k h)."""
LENGTHS = ("frequency", "period", "wavelength")
"""Fields of a regular wave of which any one gives the others."""
FASTEST = 100.0
"""Greatest frequency of a level that goes up and down [Hz]; timesteps resolve no more."""


class Wave(Protocol):
    """Anything whose elevation is a sum of A cos(kx x + ky y - omega t + phase).

    A wave whose length depends on the current is a `CurrentWave`.
    """

    @property
    def rows(self) -> NDArray[np.float64]:
        """Components of the wave as rows (n, 6).

        The columns are amplitude A [m], wavenumbers kx and ky [rad/m], angular frequency omega
        [rad/s], phase [rad] and depth of the water [m]. omega is what an observer at rest sees.
        """
        ...


class CurrentWave(Wave, Protocol):
    """A wave whose length, or whose frequency at rest, depends on the current that it meets.

    Its own rows are those in still water.
    """

    def on(self, current: Current) -> Wave:
        """The wave on a current, as its water sees it, which drifts with the current.

        omega of its rows is the intrinsic frequency sigma; `Water` adds k . U, with U the current
        that the wave feels, see `currents.effective_current`.
        """
        ...


def depends_on_current(wave: Wave) -> TypeGuard[CurrentWave]:
    """Whether a wave is a `CurrentWave`."""
    return callable(getattr(wave, "on", None))


@dataclasses.dataclass(frozen=True)
class RegularWave:
    """A linear (Airy) wave with the elevation A cos(k (x cos b + y sin b) - omega t + phase).

    Exactly one of `frequency`, `period` and `wavelength` is needed. The other two follow from the
    dispersion relation omega^2 = g k tanh(k h) (Newman 1977, 6.2). Waves in nature break where they
    are steeper than `STEEPEST`; this one does not, but `warning` says so.

    On a current, frequency and period are what an observer at rest sees, or with `frame` "water"
    what one sees who drifts with the current. They differ by k U / (2 pi), with U the current along
    the wave, and the length follows from (omega - k U)^2 = g k tanh(k h) (Peregrine 1976, Adv.
    Appl. Mech. 16, 9). `wavelength` here is that in still water; `Water.rows` has what the current
    makes of it. The amplitude is that on the current.

    Raises:
        WaterError: none or several of the three, a value out of its range, a wave shorter than
            `ranges.SHORTEST`, or one that is higher than long. `Water` raises it if the current
            blocks the wave.

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
    gravity: float | None = dataclasses.field(default=None, kw_only=True)
    """Acceleration of gravity in the dispersion relation, g [m/s^2].

    By default it is the model's, and 9.81 where there is no model."""
    frame: str = dataclasses.field(default="earth", kw_only=True)
    """Who sees the frequency: "earth", an observer at rest, or "water", one that drifts along.

    It is "water" wherever the wavelength is given, for that is the same to both."""
    given = "frequency"
    """Which of frequency, period and wavelength was given; under another gravity it stays."""

    def __post_init__(self) -> None:
        # values in their ranges
        object.__setattr__(self, "frame", read_frame(self.frame))
        set_number(self, WaterError, "amplitude", least=0.0, most=LARGEST)
        set_number(self, WaterError, "direction")
        set_number(self, WaterError, "phase")
        object.__setattr__(self, "gravity", read_stated(self.gravity))
        object.__setattr__(self, "depth", read_depth(self.depth))
        if self.amplitude > self.depth:
            raise WaterError(
                f"amplitude is {self.amplitude} m in water {self.depth} m deep; "
                "the trough would lie below the bottom"
            )

        # one of three; the other two follow
        three = {name: getattr(self, name) for name in LENGTHS}
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
        object.__setattr__(self, "given", name)
        gravity = or_default(self.gravity)
        if name == "wavelength":
            object.__setattr__(self, "frame", "water")
            k = 2.0 * math.pi / value
            frequency = math.sqrt(gravity * k * math.tanh(k * self.depth)) / (2.0 * math.pi)
        else:
            frequency = value if name == "frequency" else 1.0 / value
        object.__setattr__(self, "frequency", frequency)
        if name != "period":
            object.__setattr__(self, "period", 1.0 / frequency)
        if name != "wavelength":
            k = wavenumber(2.0 * math.pi * frequency, self.depth, gravity)
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
        """The wave in still water as one row (1, 6), see `Wave.rows`."""
        k, omega = 2.0 * math.pi / self.wavelength, 2.0 * math.pi * self.frequency
        kx, ky = k * math.cos(self.direction), k * math.sin(self.direction)
        return np.array([[self.amplitude, kx, ky, omega, self.phase, self.depth]])

    def with_gravity(self, gravity: float) -> "RegularWave":
        """The same wave under this acceleration of gravity [m/s^2], see `sea.gravity`.

        Of frequency, period and wavelength the one that was given stays.

        Raises:
            WaterError: it would be too short, or higher than long.
        """
        others: dict[str, Any] = {name: math.nan for name in LENGTHS if name != self.given}
        return dataclasses.replace(self, gravity=gravity, **others)

    def on(self, current: Current) -> "RegularWave":
        """The wave on a current, as its water sees it, see `CurrentWave.on`.

        Raises:
            WaterError: the current blocks the wave, or makes it shorter than waves can be.
        """
        if self.frame == "water" or is_still(current):
            return self
        omega = 2.0 * math.pi * self.frequency
        dispersion = Dispersion(current, self.depth, or_default(self.gravity), (omega, omega))
        k = dispersion.wavenumber(omega, self.direction)
        if math.isnan(k):
            limit = describe_limit(dispersion.highest_frequency(self.direction))
            raise WaterError(
                f"a wave with a period of {self.period:g} s cannot run against the current, which "
                f"blocks {limit}; give it a longer period or a weaker current, or say frame = "
                "'water' if the period is what the water sees"
            )

        # by the frequency that the water sees, from which its length follows as in still water
        (sigma,) = intrinsic_frequency(np.array([k]), self.depth, or_default(self.gravity))
        seen = {"frequency": float(sigma) / (2.0 * math.pi), "period": math.nan}
        try:
            return dataclasses.replace(self, **seen, wavelength=math.nan, frame="water")
        except WaterError as error:
            raise WaterError(
                f"a wave with a period of {self.period:g} s cannot run on the current: {error}"
            ) from error

    @property
    def warning(self) -> str:
        """A clause that says how much too steep the wave is for nature; empty if it is not.

        It is that in still water; on a current that of what `on` gives.
        """
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


def _is_default(value: object) -> bool:
    """Whether a field was left at its default."""
    return isinstance(value, float) and math.isnan(value)

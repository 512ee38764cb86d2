"""`Seakeeping`: how a vehicle moved in a run, in the terms of naval architects."""

import dataclasses
import math
from collections.abc import Iterator

from buoyancy_mj.scenes.windows import Window


@dataclasses.dataclass(frozen=True)
class Spread:
    """How far a motion goes to and fro over a window."""

    range: float
    """Greatest less least, in the unit of the motion."""
    rms: float
    """Root of the mean square about the mean, likewise."""

    @property
    def significant(self) -> float:
        """Significant double amplitude, four times the rms: the mean of the highest third of the
        ranges, where many waves of a narrow spectrum pass by.
        """
        return 4.0 * self.rms


@dataclasses.dataclass(frozen=True)
class Seakeeping:
    """How a vehicle moved: over the window what stands first, over the whole run the peaks.

    Motions and accelerations are those of its centre of gravity. Roll and pitch are angles of its
    root body [rad].
    """

    window: Window
    """Over which part of the run."""
    heave: Spread
    """Upward motion [m]."""
    roll: Spread
    """Roll [rad]."""
    pitch: Spread
    """Pitch [rad]."""
    surge: Spread
    """Motion along its heading [m], less the drift of each part of the window."""
    drift: tuple[float, float]
    """Mean velocity along x and y [m/s], world frame."""
    vertical_acceleration: Spread
    """Upward acceleration [m/s^2]."""
    horizontal_acceleration_rms: float
    """Root of the mean square of the horizontal acceleration [m/s^2]."""
    deck_wetness: float
    """Share of the window in which a point of its deck is under water, from 0 to 1."""
    peak_acceleration: float
    """Greatest acceleration of the whole run [m/s^2]."""
    peak_load: float
    """Greatest force of the whole run on it [N], of all but gravity: water, moorings, contacts."""
    load_factor: float
    """That load over the weight of its mass: 1 at rest."""
    slams: int
    """How often a point of its keel at the bow came out of the water and back faster than
    0.093 sqrt(g L), over the whole run."""

    @property
    def drift_speed(self) -> float:
        """Speed of the drift [m/s]."""
        return math.hypot(*self.drift)

    def values(self) -> dict[str, float]:
        """All numbers by their names in tables."""
        return dict(zip(NAMES, self._list_values(), strict=True))

    def _list_values(self) -> Iterator[float]:
        """The numbers in the order of `NAMES`."""
        yield from (self.window.start, self.window.end)
        for name in SPREADS:
            spread: Spread = getattr(self, name)
            yield from (spread.range, spread.rms, spread.significant)
        yield from self.drift
        yield from (getattr(self, name) for name in _REST)


SPREADS = ("heave", "roll", "pitch", "surge", "vertical_acceleration")
"""Fields that are a `Spread`."""
_REST = (
    "horizontal_acceleration_rms", "deck_wetness", "peak_acceleration", "peak_load",
    "load_factor", "slams",
)  # fmt: skip
NAMES = (
    "window_start",
    "window_end",
    *(f"{name}_{part}" for name in SPREADS for part in ("range", "rms", "significant")),
    "drift_x",
    "drift_y",
    *_REST,
)
"""Names of the numbers in tables, as the columns of a sweep."""

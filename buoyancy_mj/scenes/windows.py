"""`Window`: the part of a run over which its motions are measured."""

import dataclasses
import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.sea_state import SeaState

STILL = 2.0
"""Length of the window in still water [s]."""
SHARE = 0.5
"""Share of a run in waves, its end, that may be measured; the transient lies before it."""
_HAIR = 1e-6
"""Part of a period that rounding may take away from it."""


@dataclasses.dataclass(frozen=True)
class Window:
    """A part of a run."""

    start: float
    """Its beginning [s]."""
    end: float
    """Its end [s]."""
    periods: int
    """Number of whole periods of the longest wave in it; 0 if it is not made of such."""

    @property
    def length(self) -> float:
        """How long it is [s]."""
        return self.end - self.start

    @property
    def name(self) -> str:
        """What it is called behind the name of a measure: 'last 2 waves', 'last 2 s'."""
        if self.periods:
            return "last wave" if self.periods == 1 else f"last {self.periods} waves"
        return f"last {self.length:.3g} s" if self.start > 0.0 else "whole run"

    @property
    def text(self) -> str:
        """Where it lies: '6 to 10 s'."""
        return f"{self.start:.4g} to {self.end:.4g} s"


@dataclasses.dataclass(frozen=True)
class Beat:
    """Instants that divide a run into parts of one length, of which windows are made.

    In waves a part is a period of the longest, and a window is as many as the second half of the
    run holds, or the last one. In still water a window is the last part. The parts are counted back
    from the end of the run, so that the last is whole there.
    """

    length: float
    """Length of a part [s]."""
    offset: float
    """Beginning of the first whole part [s], at least 0."""
    is_wave: bool
    """Whether a part is a period of a wave."""

    def number(self, time: float) -> int:
        """Which part a time [s] is in; below 0 before the first whole one."""
        return math.floor((time - self.offset) / self.length + _HAIR)

    def numbers(self, times: NDArray[np.float64]) -> NDArray[np.int64]:
        """Which part each of times (n,) [s] is in; below 0 before the first whole one."""
        return np.floor((times - self.offset) / self.length + _HAIR).astype(np.int64)

    def start(self, number: int) -> float:
        """Beginning of a part [s]."""
        return self.offset + number * self.length

    def count(self, time: float) -> int:
        """How many parts make the window of a run that has lasted for a time [s], if it has any."""
        return max(1, math.floor(SHARE * time / self.length + _HAIR)) if self.is_wave else 1


def find_beat(sea: SeaState, duration: float) -> Beat:
    """How the windows of a run are made.

    Args:
        sea: the sea.
        duration: how long the run is to last [s]; not finite if nobody knows.
    """
    length = STILL if sea.is_still else sea.period
    offset = duration % length if math.isfinite(duration) else 0.0
    # whole up to rounding
    if length - offset < _HAIR * length:
        offset = 0.0
    return Beat(length, offset, is_wave=not sea.is_still)

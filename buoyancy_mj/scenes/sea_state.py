"""`SeaState`: how high and how long the waves are that measures of a run are told beside."""

import dataclasses
import math

import numpy as np

from buoyancy_mj.sea.water import Water

CALM = 0.01
"""Share of the sea's variance whose waves may be longer than its longest energetic period."""


@dataclasses.dataclass(frozen=True)
class SeaState:
    """A sea in two numbers."""

    height: float
    """Crest to trough of a regular wave; of several, the significant height 4 sqrt(m0) [m]."""
    period: float
    """Period of the longest wave, with all but a hundredth of the variance in shorter ones [s]; inf
    in still water."""

    @property
    def is_still(self) -> bool:
        """Whether there are no waves."""
        return not math.isfinite(self.period)


def find_sea_state(water: Water) -> SeaState:
    """The height of a sea's waves and the period of the longest that has a part in it.

    The period is the one at a fixed place: a vehicle that moves along meets its waves at another.

    Args:
        water: the sea.
    """
    amplitude, omega = np.abs(water.rows[:, 0]), np.abs(water.rows[:, 3])
    energies = np.where(omega > 0.0, 0.5 * amplitude**2, 0.0)
    variance = float(energies.sum())
    if variance == 0.0:
        return SeaState(0.0, math.inf)
    order = np.argsort(omega, kind="stable")
    first = int(np.argmax(np.cumsum(energies[order]) > CALM * variance))
    is_regular = np.count_nonzero(energies) == 1
    height = 2.0 * math.sqrt(2.0 * variance) if is_regular else 4.0 * math.sqrt(variance)
    return SeaState(height, 2.0 * math.pi / float(omega[order[first]]))

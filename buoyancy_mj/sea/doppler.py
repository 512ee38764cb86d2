"""What a current does to the frequencies of waves: at rest and from the water they differ."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.waves import AMPLITUDE, DEPTH, KX, KY, OMEGA, SIGMA
from buoyancy_mj.sea.currents import Current, CurrentSeries, effective_current, is_still

MOST_CHANGE = 0.05
"""Most that a current by time may leave its mean without a warning, over the speed of a wave."""


def add_doppler(
    rows: NDArray[np.float64], current: Current, *, at_rest: bool
) -> NDArray[np.float64]:
    """Rows (n, 7) from rows (n, 6): omega at rest, and sigma, which is omega - k . U.

    Args:
        rows: those of a wave.
        current: that it runs on.
        at_rest: whether the frequency of the rows is omega; otherwise it is sigma.
    """
    both = np.column_stack([rows, rows[:, OMEGA]])
    if is_still(current):
        return both

    # a level that goes up and down has no length, and no shift
    k = np.hypot(rows[:, KX], rows[:, KY])
    felt = effective_current(current, np.where(k > 0.0, k, 1.0), rows[:, DEPTH])
    shift = rows[:, KX] * felt[:, 0] + rows[:, KY] * felt[:, 1]
    if at_rest:
        both[:, SIGMA] -= shift
    else:
        both[:, OMEGA] += shift
    return both


def describe_change(series: CurrentSeries, rows: NDArray[np.float64]) -> str:
    """A clause that says how far a current by time leaves its mean; empty if waves are faster.

    Waves keep the length and the frequency that they have on the mean, so that a body that drifts
    along sees their frequency wrong by the change of the current over their speed, sigma / k.
    """
    waves = rows[(rows[:, AMPLITUDE] != 0.0) & (rows[:, SIGMA] != 0.0)]
    changes = (np.array(series.velocities) - series.mean)[:, :2] @ waves[:, [KX, KY]].T
    worst = float(np.max(np.abs(changes / waves[:, SIGMA]), initial=0.0))
    if worst <= MOST_CHANGE:
        return ""
    return (
        f"waves on a current that leaves its mean by up to {100.0 * worst:.2g} % of their speed "
        "through the water; they keep the length that they have on its mean: give the current of a "
        "shorter time"
    )

"""How calls are timed."""

import itertools
import statistics
import time
from collections.abc import Callable

from scipy.spatial.transform import Rotation

ATTITUDES = [Rotation.random(random_state=i).as_matrix() for i in range(5)]
"""Rotations (3, 3) in which bodies are measured, one after the other."""
SHORT = 1e-3
"""Calls that are shorter [s] are timed several at once: looking at the clock takes a while."""
AT_ONCE = 4 * len(ATTITUDES)
"""How many."""


def least_duration(quick: bool) -> float:
    """How long [s] the repeats of a call take together at least."""
    return 0.0 if quick else 0.5


def median_time(call: Callable[[int], object], quick: bool, fewest: int = 5) -> float:
    """Median processor time of one call [s], after one that warms.

    Args:
        call: takes the index of one of the `ATTITUDES`.
        quick: measure as few calls as may be.
        fewest: number of repeats otherwise, at least.
    """
    started = time.perf_counter()
    call(0)
    call(0)
    count = AT_ONCE if time.perf_counter() - started < 2.0 * SHORT else 1
    attitudes = itertools.cycle(range(len(ATTITUDES)))
    least = least_duration(quick)
    fewest = 1 if quick else fewest
    times: list[float] = []
    while count * sum(times) < least or len(times) < fewest:
        started = time.process_time()
        for _ in range(count):
            call(next(attitudes))
        times.append((time.process_time() - started) / count)
    return statistics.median(times)


def _measure_clock() -> float:
    """How long it takes to look at the clock of the thread [s]."""
    looks = [time.thread_time() for _ in range(100)]
    return min(after - before for before, after in itertools.pairwise(looks))


CLOCK = _measure_clock()
"""Time between two looks at the clock of the thread [s], one right after the other."""


def spent_since(started: float) -> float:
    """Time of the thread [s] since `time.thread_time()` was `started`."""
    return time.thread_time() - started - CLOCK

"""How calls are timed."""

import statistics
import time
from collections.abc import Callable

from scipy.spatial.transform import Rotation

ATTITUDES = [Rotation.random(random_state=i).as_matrix() for i in range(5)]
"""Rotations (3, 3) in which bodies are measured, one after the other."""


def least_duration(quick: bool) -> float:
    """How long [s] the repeats of a call take together at least."""
    return 0.0 if quick else 0.5


def median_time(call: Callable[[int], object], quick: bool, fewest: int = 5) -> float:
    """Median time of one call [s], after one that warms.

    Args:
        call: takes the index of one of the `ATTITUDES`.
        quick: measure one call alone.
        fewest: number of repeats otherwise, at least.
    """
    call(0)
    least = least_duration(quick)
    fewest = 1 if quick else fewest
    times: list[float] = []
    while sum(times) < least or len(times) < fewest:
        started = time.perf_counter()
        call(len(times) % len(ATTITUDES))
        times.append(time.perf_counter() - started)
    return statistics.median(times)

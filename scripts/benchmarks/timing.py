"""How calls are timed."""

import statistics
import time
from collections.abc import Callable

from scipy.spatial.transform import Rotation

ATTITUDES = [Rotation.random(random_state=i).as_matrix() for i in range(5)]
"""Rotations (3, 3) in which bodies are measured, one after the other."""


def least_duration(quick: bool) -> float:
    """How long [s] the repeats of a call take together at least."""
    return 0.05 if quick else 0.5


def median_time(call: Callable[[int], object], least: float, fewest: int = 5) -> float:
    """Median time of one call [s].

    Args:
        call: takes the index of one of the `ATTITUDES`.
        least: duration of all repeats together, at least [s].
        fewest: number of repeats, at least.
    """
    call(0)
    times: list[float] = []
    while sum(times) < least or len(times) < fewest:
        started = time.perf_counter()
        call(len(times) % len(ATTITUDES))
        times.append(time.perf_counter() - started)
    return statistics.median(times)

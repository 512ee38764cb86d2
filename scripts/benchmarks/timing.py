"""How calls are timed."""

import itertools
import math
import time
from collections.abc import Callable, Mapping

from scipy.spatial.transform import Rotation

ATTITUDES = [Rotation.random(random_state=i).as_matrix() for i in range(5)]
"""Rotations (3, 3) in which bodies are measured, one after the other."""
SHORT = 1e-3
"""Calls that are shorter [s] are timed several at once: looking at the clock takes a while."""
AT_ONCE = 4
"""How often in each attitude."""

Call = Callable[[int], object]
"""Something that is timed; it takes the index of one of the `ATTITUDES`."""


def least_duration(quick: bool) -> float:
    """How long [s] the repeats of a call take together at least."""
    return 0.0 if quick else 0.5


def time_calls(
    calls: Mapping[str, Call], quick: bool, fewest: Mapping[str, int] | None = None
) -> dict[str, float]:
    """Processor time of each call [s], mean over attitudes, of each the least one.

    Calls take turns, so that all see the same machine. Each is made once before, to warm.

    Args:
        calls: the calls, by name.
        quick: measure long calls once.
        fewest: how often a long call is measured otherwise, at least; by default once in each
            attitude.
    """
    fewest = dict.fromkeys(calls, 1) if quick else fewest or {}
    series = {name: _Series(call, fewest.get(name)) for name, call in calls.items()}
    least = least_duration(quick)
    waiting = list(series)
    while waiting:
        for name in waiting:
            series[name].measure()
        waiting = [
            name
            for name in waiting
            if series[name].count < series[name].fewest or series[name].spent < least
        ]
    return {name: one.mean for name, one in series.items()}


class _Series:
    """Measurements of one call."""

    def __init__(self, call: Call, fewest: int | None) -> None:
        call(0)
        started = time.perf_counter()
        call(0)
        self._call = call
        self._is_short = time.perf_counter() - started < SHORT
        self._least: dict[int, float] = {}
        self.fewest = len(ATTITUDES) if fewest is None or self._is_short else fewest
        self.count = 0
        self.spent = 0.0

    def measure(self) -> None:
        """Measure it once more: all attitudes together if it is short, else the next one."""
        attitudes = range(len(ATTITUDES))
        if self._is_short:
            # the last one that was measured has left the caches in its own state
            for i in attitudes:
                self._call(i)
            key, indices = 0, [*attitudes] * AT_ONCE
        else:
            key = self.count % len(ATTITUDES)
            indices = [key]
        started = time.process_time()
        for i in indices:
            self._call(i)
        spent = time.process_time() - started
        self._least[key] = min(self._least.get(key, math.inf), spent / len(indices))
        self.count += 1
        self.spent += spent

    @property
    def mean(self) -> float:
        """Mean over attitudes of the least time [s]."""
        return sum(self._least.values()) / len(self._least)


def _measure_clock() -> float:
    """How long it takes to look at the clock of the thread [s]."""
    looks = [time.thread_time() for _ in range(100)]
    return min(after - before for before, after in itertools.pairwise(looks))


CLOCK = _measure_clock()
"""Time between two looks at the clock of the thread [s], one right after the other."""


def spent_since(started: float) -> float:
    """Time of the thread [s] since `time.thread_time()` was `started`."""
    return time.thread_time() - started - CLOCK

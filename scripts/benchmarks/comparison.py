"""A run beside an earlier one: what became slower, and is so when it is measured again.

The work of others on a machine makes a time longer and never shorter. So what seems slower is
measured again, and of all measurements the best counts. Only what is slower in each is told.
"""

import statistics
from collections.abc import Callable, Iterator, Mapping
from fnmatch import fnmatch
from typing import Any, NamedTuple

TOLERATED = 0.05
"""By how much more a value may be before it counts as slower."""
AGAIN = 2
"""How often what seems slower is measured again."""
GAINS = ("batch/*", "real_time/*", "fleet/*")
"""Values of which more is better, by the patterns of their names; of all others less is."""
LEFT_OUT = ("*triangles", "profile/*", "caches/*", "memory/steps")
"""Values that are no measurements, small differences of large ones, and what the machine does."""


class Change(NamedTuple):
    """A value that two runs have."""

    name: str
    """Of the value, with all that it is part of, as 'sea/auv_sea_state_2/archimedes/1 wave'."""
    before: float
    now: float
    slowdown: float
    """How many times as slow it is now, or as large."""

    @property
    def benchmark(self) -> str:
        """Which benchmark measured it."""
        return self.name.partition("/")[0]


def compare(
    results: dict[str, Any],
    earlier: Mapping[str, Any],
    measure: Callable[[str], Any],
) -> list[Change]:
    """All values that an earlier run has too, of which what seems slower is measured again.

    Args:
        results: what was measured, by benchmark; what is better when measured again goes here.
        earlier: the results of an earlier run.
        measure: measures the benchmark of a name.
    """
    for _ in range(AGAIN):
        slower = {change.benchmark for change in find_slower(find_changes(results, earlier))}
        for name in slower:
            results[name] = keep_best(results[name], measure(name), name)
    return find_changes(results, earlier)


def find_changes(results: Mapping[str, Any], earlier: Mapping[str, Any]) -> list[Change]:
    """All values that an earlier run has too."""
    before, changes = flatten(earlier), []
    for name, now in flatten(results).items():
        if name not in before or _matches(name, LEFT_OUT):
            continue
        numbers = (before[name], now) if _matches(name, GAINS) else (now, before[name])
        slowdown = numbers[0] / numbers[1] if numbers[1] else float("nan")
        changes.append(Change(name, before[name], now, slowdown))
    return changes


def find_slower(changes: list[Change]) -> list[Change]:
    """Those that are slower by more than is tolerated."""
    return [change for change in changes if change.slowdown > 1.0 + TOLERATED]


def describe_changes(changes: list[Change]) -> Iterator[str]:
    """Yield a line for each value that differs by more than is tolerated, and one for all others.

    A line of what is slower begins with SLOWER.
    """
    apart = 0
    for name, before, now, slowdown in changes:
        values = f"{name}: {now:.4g}, was {before:.4g}"
        if slowdown > 1.0 + TOLERATED:
            yield f"SLOWER {slowdown:.2f} x  {values}"
        elif slowdown < 1.0 / (1.0 + TOLERATED):
            yield f"faster {1.0 / slowdown:.2f} x  {values}"
        else:
            continue
        apart += 1
    if changes:
        middle = statistics.median(change.slowdown for change in changes)
        yield (
            f"{len(changes) - apart} of {len(changes)} values are within {TOLERATED:.0%}; "
            f"the middle one is {middle:.2f} x as slow"
            + (", so the machine may be busier than it was" if middle > 1.0 + TOLERATED else "")
        )


def keep_best(results: Any, others: Any, name: str) -> Any:
    """The better of each value of two runs of the benchmark or part of a name."""
    if isinstance(results, dict):
        return {key: keep_best(results[key], others[key], f"{name}/{key}") for key in results}
    return max(results, others) if _matches(name, GAINS) else min(results, others)


def flatten(results: Mapping[str, Any], prefix: str = "") -> dict[str, float]:
    """Nested results in one mapping, their names joined by slashes."""
    flat: dict[str, float] = {}
    for key, value in results.items():
        if isinstance(value, dict):
            flat |= flatten(value, f"{prefix}{key}/")
        else:
            flat[prefix + key] = value
    return flat


def _matches(name: str, patterns: tuple[str, ...]) -> bool:
    return any(fnmatch(name, pattern) for pattern in patterns)

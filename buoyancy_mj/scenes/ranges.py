"""The values that a sweep gives to fields of a scene: a grid, a list, or random draws."""

import dataclasses
import itertools
import math
from collections.abc import Sequence

import numpy as np

from buoyancy_mj.errors import SweepError, describe
from buoyancy_mj.values import read_text

Value = float | str
"""What a field of a run may be given."""

MOST_RUNS = 1_000_000
"""Most runs of one sweep."""


@dataclasses.dataclass(frozen=True)
class FieldRange:
    """One field of the scene and the range of its values."""

    key: str
    """Key of the field, as for `--set`: 'water.waves.0.amplitude'."""
    low: float
    """First value."""
    high: float
    """Last value."""
    count: int
    """Number of values in a grid; random draws do not use it."""
    listed: tuple[Value, ...] = ()
    """Values one by one; evenly spaced ones if there are none."""

    @property
    def values(self) -> list[Value]:
        """The values in a grid."""
        if self.listed:
            return list(self.listed)
        values: list[Value] = np.linspace(self.low, self.high, self.count).tolist()
        return values

    @property
    def text(self) -> str:
        """The field and its values, as they are given."""
        if self.listed:
            return f"{self.key}={','.join(map(_write, self.listed))}"
        return f"{self.key}={self.low:g}:{self.high:g}{f':{self.count}' if self.count else ''}"


def parse_range(text: str) -> FieldRange:
    """Parse 'KEY=a:b:n', n values from a to b, 'KEY=v1,v2,v3', or 'KEY=a:b' for random draws.

    Raises:
        SweepError: the text is none of them.
    """
    key, _, span = read_text(SweepError, "--over", text).partition("=")
    try:
        if "," in span:
            listed = _parse_list(span)
            if not key.strip():
                raise ValueError
            return FieldRange(key.strip(), math.nan, math.nan, len(listed), listed)
        low, high, count = _parse_span(span)
        if not key.strip():
            raise ValueError
    except ValueError:
        raise SweepError(
            f"--over is {describe(text)}; it must be KEY=a:b:n, n values from a to b, as "
            "start.position.2=0:0.5:6, or a list KEY=v1,v2,v3, or KEY=a:b with --draws"
        ) from None
    return FieldRange(key.strip(), low, high, count)


def grid(ranges: Sequence[FieldRange]) -> list[tuple[Value, ...]]:
    """All combinations of values, the last field fastest.

    Raises:
        SweepError: a range without a number of values, or more than `MOST_RUNS` combinations.
    """
    for one in ranges:
        if one.count == 0:
            raise SweepError(
                f"--over {one.text} has no number of values; add it (:n), or give --draws"
            )
    _check_runs(math.prod(one.count for one in ranges))
    return list(itertools.product(*(one.values for one in ranges)))


def draws(ranges: Sequence[FieldRange], count: int, seed: int) -> list[tuple[Value, ...]]:
    """Random combinations of values, each uniform in its range; the same for the same seed.

    Raises:
        SweepError: a range with a number of values, which draws do not use, more than `MOST_RUNS`
            draws, or a seed below 0.
    """
    for one in ranges:
        if one.listed:
            raise SweepError(
                f"--over {one.text} is a list, which --draws does not use; give {one.key}=a:b, or "
                "leave out --draws"
            )
        if one.count:
            raise SweepError(
                f"--over {one.key}={one.low:g}:{one.high:g}:{one.count} has a number of values, "
                f"which --draws does not use; leave out ':{one.count}', or leave out --draws"
            )
    _check_runs(count)
    if seed < 0:
        raise SweepError(f"--seed is {describe(seed)}; it must be at least 0")
    low = np.array([one.low for one in ranges])
    high = np.array([one.high for one in ranges])
    rows = np.random.default_rng(seed).uniform(low, high, (count, len(ranges)))
    return [tuple(row) for row in rows.tolist()]


def _check_runs(count: int) -> None:
    """Refuse more runs than a sweep can keep."""
    if count > MOST_RUNS:
        raise SweepError(
            f"the sweep would have {describe(count)} runs; it may have {MOST_RUNS} at most, so "
            "give fewer values (--over KEY=a:b:n) or --draws"
        )


def _parse_span(span: str) -> tuple[float, float, int]:
    """The numbers of 'a:b:n', or of 'a:b' with n = 0; a ValueError where they make no sense."""
    first, last, *counts = span.split(":")
    low, high = float(first), float(last)
    if not math.isfinite(high - low):
        raise ValueError
    if not counts:
        return low, high, 0
    (count,) = map(int, counts)
    if count < 1:
        raise ValueError
    return low, high, count


def _parse_list(span: str) -> tuple[Value, ...]:
    """The values of 'v1,v2,v3', numbers or words; a ValueError where they make no sense."""
    words = [word.strip() for word in span.split(",")]
    if not all(words) or len(set(words)) < len(words):
        raise ValueError
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return tuple(words)
    if not all(map(math.isfinite, numbers)):
        raise ValueError
    return tuple(numbers)


def _write(value: Value) -> str:
    """A value as it is given."""
    return value if isinstance(value, str) else f"{value:g}"

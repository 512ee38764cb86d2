"""`Tally`: ranges and means of numbers over the window of a run, kept part by part of it."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.windows import Beat, Window


class _Parts(NamedTuple):
    """What is kept of whole parts of a run, in arrays (..., p); numbers less the first sample's."""

    number: NDArray[np.int64]
    """Which parts (p,)."""
    samples: NDArray[np.int64]
    """Number of samples in each (p,)."""
    first: NDArray[np.float64]
    """The first sample of each, its time before all (1 + q, p)."""
    after: NDArray[np.float64]
    """The first sample after each (1 + q, p)."""
    least: NDArray[np.float64]
    """Least of each number (q, p)."""
    most: NDArray[np.float64]
    """Greatest (q, p)."""
    total: NDArray[np.float64]
    """Sum (q, p)."""
    squares: NDArray[np.float64]
    """Sum of squares (q, p)."""


class Spreads(NamedTuple):
    """Numbers over a window."""

    window: Window
    """The window."""
    mean: NDArray[np.float64]
    """Mean of each (q,)."""
    least: NDArray[np.float64]
    """Least (q,)."""
    most: NDArray[np.float64]
    """Greatest (q,)."""
    rms: NDArray[np.float64]
    """Root of the mean square about the mean (q,)."""
    rate: NDArray[np.float64]
    """Change from the beginning to the end, over time (q,)."""


class Tally:
    """Keeps numbers of a run, sample by sample, in little memory: that of one part and a few sums.

    Args:
        beat: parts of the run.
        count: how many numbers.
        drifting: which of them are taken less the straight line that leads from the beginning of
            each part to the next.
    """

    def __init__(self, beat: Beat, count: int, drifting: Sequence[int] = ()) -> None:
        self._beat, self._count, self._drifting = beat, count, list(drifting)
        self._origin = np.zeros(0)
        self._open: list[NDArray[np.float64]] = []
        self._opened = -1
        self._parts: list[_Parts] = []

    def add(self, times: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        """Add samples (q, n) at times (n,) [s], which go on where the last ones ended."""
        if not self._open:
            self._origin = np.where(np.isfinite(values[:, :1]), values[:, :1], 0.0)
            self._opened = self._beat.number(float(times[0]))
        self._open.append(np.vstack([times, values - self._origin]))
        latest = self._beat.number(float(times[-1]))
        if latest > self._opened:
            parts, rest = self._close(np.hstack(self._open))
            self._parts.append(parts)
            self._open, self._opened = [rest], latest

    def measure(self, now: float, last: NDArray[np.float64] | None = None) -> Spreads:
        """The numbers over the window of the run so far; NaN without samples.

        Args:
            now: the present [s].
            last: the numbers (q,) at the present, if they are known.
        """
        if not self._open:
            unknown = np.full(self._count, math.nan)
            return Spreads(Window(now, now, 0), *[unknown] * 5)

        # an instant behind the last step ends a part that is whole
        samples = np.hstack(self._open)
        end = samples[:, -1:].copy()
        if last is not None:
            end[1:] = last[:, None] - self._origin
        end[0] = now
        closed, _ = self._close(np.hstack([samples, end]))
        every = _join([*self._parts, closed])
        whole = every.number >= 0
        if not whole.any():
            # all that there is
            rest = self._sum_up(samples, np.array([0, samples.shape[1]]), np.array([0]), end)
            every = _join([every, rest])
            return self._spread(every, Window(float(every.first[0, 0]), now, 0))

        # the last parts
        beat, latest = self._beat, int(every.number.max())
        chosen = whole & (every.number > latest - beat.count(beat.start(latest + 1)))
        start = beat.start(int(every.number[chosen].min()))
        periods = int(chosen.sum()) if beat.is_wave else 0
        window = Window(start, beat.start(latest + 1), periods)
        return self._spread(_choose(every, chosen), window)

    def _close(self, samples: NDArray[np.float64]) -> tuple[_Parts, NDArray[np.float64]]:
        """Sum up the parts that have ended among samples (1 + q, n); the samples of the last."""
        numbers = self._beat.numbers(samples[0])
        starts = np.flatnonzero(np.diff(numbers, prepend=numbers[0] - 1))
        parts = self._sum_up(samples, starts, numbers[starts[:-1]], samples[:, starts[1:]])
        return parts, samples[:, starts[-1] :]

    def _sum_up(
        self,
        samples: NDArray[np.float64],
        starts: NDArray[np.int64],
        numbers: NDArray[np.int64],
        after: NDArray[np.float64],
    ) -> _Parts:
        """Parts (p,) of samples (1 + q, n) from starts (p + 1,) on, the last of which is an end."""
        count, first, samples = np.diff(starts), samples[:, starts[:-1]], samples[:, : starts[-1]]
        if not len(count):
            nothing = np.empty((self._count, 0))
            return _Parts(numbers, count, first, after, nothing, nothing, nothing, nothing)
        values = samples[1:]
        if self._drifting:
            # less the straight line to the next part
            values = values.copy()
            spans = np.where(after[0] > first[0], after[0] - first[0], math.inf)
            passed = samples[0] - np.repeat(first[0], count)
            for row in self._drifting:
                slopes = (after[1 + row] - first[1 + row]) / spans
                values[row] -= np.repeat(first[1 + row], count) + passed * np.repeat(slopes, count)
        sums = (
            ufunc.reduceat(array, starts[:-1], axis=1)
            for ufunc, array in (
                (np.minimum, values),
                (np.maximum, values),
                (np.add, values),
                (np.add, values * values),
            )
        )
        return _Parts(numbers, count, first, after, *sums)

    def _spread(self, parts: _Parts, window: Window) -> Spreads:
        """The numbers over parts that follow each other."""
        origin = self._origin[:, 0].copy()
        origin[self._drifting] = 0.0
        samples = parts.samples.sum()
        mean = parts.total.sum(axis=1) / samples
        variance = parts.squares.sum(axis=1) / samples - mean * mean
        first, after = parts.first[:, 0], parts.after[:, -1]
        span = after[0] - first[0]
        return Spreads(
            window=window,
            mean=mean + origin,
            least=parts.least.min(axis=1) + origin,
            most=parts.most.max(axis=1) + origin,
            rms=np.sqrt(np.maximum(variance, 0.0)),
            rate=(after[1:] - first[1:]) / span if span > 0.0 else np.zeros_like(mean),
        )


def _choose(parts: _Parts, chosen: NDArray[np.bool_]) -> _Parts:
    """Some of the parts."""
    arrays: Any = parts
    return _Parts(*(array[..., chosen] for array in arrays))


def _join(some: Sequence[_Parts]) -> _Parts:
    """Parts of several, one after the other."""
    return _Parts(*(np.concatenate(arrays, axis=-1) for arrays in zip(*some, strict=True)))

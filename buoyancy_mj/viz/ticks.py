"""`choose_range`: the range of an axis on which at least three labels can be read.

The viewer labels whole multiples of one step. On a value's axis that is a power of ten, on the axis
of time 1, 10 or 60 s and so on. The step is the finest whose labels have room, so that an axis
which is cut at its data may have one label or none.
"""

import math
from collections.abc import Iterator

LABELS = 3
"""Number of labels that an axis has at least."""
MARGIN = 0.06
"""Part of the range that stays free at each end, where a label would be cut."""
TEXT_HEIGHT, TEXT_WIDTH = 22.0, 60.0
"""Distance of labels along an upright axis and along that of time, from which on the viewer draws
them [pixels]."""
TIME_STEPS = (
    *(10.0**power for power in range(-6, 2)), 60.0, 600.0, 3600.0, 12 * 3600.0,
    *(24 * 3600.0 * 10.0**power for power in range(5)),
)  # fmt: skip
"""Steps between labels on the axis of time [s]."""


def choose_range(low: float, high: float, pixels: float) -> tuple[float, float]:
    """Choose the range of an upright axis around its values.

    Args:
        low: least value.
        high: greatest value.
        pixels: length of the axis.

    Returns:
        Both ends of the axis.
    """
    middle, span = 0.5 * (low + high), high - low
    # what hardly changes is a level line, not noise that fills the plot
    least = max(1e-4, 1e-3 * abs(middle)) if middle or span else 1.0
    half = 0.5 * max(span, least) / (1.0 - 2.0 * MARGIN)
    low, high = middle - half, middle + half
    span = high - low
    step = next(step for step in _decades(span) if span / step * TEXT_HEIGHT <= pixels)
    return _widen(low, high, step)


def choose_end(begin: float, end: float, free: float, pixels: float) -> float:
    """Choose where the axis of time ends.

    Args:
        begin: first time [s], where the axis begins.
        end: last time [s].
        free: part of the axis that stays free behind it.
        pixels: length of the axis.

    Returns:
        The last time of the axis [s].
    """
    # a run of one frame has an axis all the same
    span = max(end - begin, 1e-3) / (1.0 - free)
    for step in TIME_STEPS:
        last = max(math.ceil(begin / step) + LABELS - 1, math.floor((begin + span) / step))
        # the last label is not cut
        high = max(begin + span, (last + 0.4) * step)
        if (high - begin) / step * TEXT_WIDTH <= pixels:
            break
    return high


def _widen(low: float, high: float, step: float) -> tuple[float, float]:
    """Widen a range until it holds enough multiples of a step, each clear of its ends."""
    while True:
        edge = MARGIN * (high - low)
        first, last = math.ceil((low + 0.5 * edge) / step), math.floor((high - 0.5 * edge) / step)
        if last - first + 1 >= LABELS:
            return low, high
        # the next multiple on the side where it is nearer
        below, above = (first - 1) * step - edge, (last + 1) * step + edge
        if low - below <= above - high:
            low = min(low, below)
        else:
            high = max(high, above)


def _decades(span: float) -> Iterator[float]:
    """Powers of ten from far below a span upwards."""
    power = math.floor(math.log10(span)) - 3
    while True:
        yield 10.0**power
        power += 1

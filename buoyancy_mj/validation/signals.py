"""What is read off a motion: when it crosses zero, its period, its amplitude at a frequency."""

import math

import numpy as np
from numpy.typing import NDArray


def crossings(times: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Times [s] at which values (n,) cross zero, by linear interpolation."""
    i = np.flatnonzero(np.sign(values[1:]) * np.sign(values[:-1]) < 0)
    steps = times[i + 1] - times[i]
    crossed: NDArray[np.float64] = times[i] + steps * values[i] / (values[i] - values[i + 1])
    return crossed


def period(times: NDArray[np.float64], values: NDArray[np.float64], count: int = 6) -> float:
    """Mean period [s] of an oscillation about zero, over the first `count` half periods."""
    crossed = crossings(times, values)[: count + 1]
    return float(2.0 * np.diff(crossed).mean())


def amplitude(times: NDArray[np.float64], values: NDArray[np.float64], omega: float) -> float:
    """Amplitude of an oscillation at a frequency, by least squares beside a mean and a trend.

    Args:
        times: (n,) [s].
        values: (n,) at these times.
        omega: angular frequency [rad/s].
    """
    columns = np.column_stack(
        [np.cos(omega * times), np.sin(omega * times), np.ones_like(times), times]
    )
    a, b, *_ = np.linalg.lstsq(columns, values, rcond=None)[0]
    return math.hypot(a, b)

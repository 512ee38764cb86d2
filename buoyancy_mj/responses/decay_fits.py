"""Period and damping of a free decay, from its peaks."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ResponseError

LEAST = 0.03
"""Part of the first peak below which peaks are left out."""
LEAST_PEAKS = 4
"""Peaks that a fit of two damping coefficients needs."""


class Peaks(NamedTuple):
    """The turning points of a decay, crests and troughs in turn."""

    times: NDArray[np.float64]
    """When they are (n,) [s]."""
    values: NDArray[np.float64]
    """The motion there (n,)."""


class DecayFit(NamedTuple):
    """A decay as x'' + p1 x' + p2 |x'| x' + w^2 x = 0."""

    period: float
    """Mean period between peaks, damped, T [s]."""
    linear: float
    """Linear damping over inertia, p1 [1/s]."""
    quadratic: float
    """Quadratic damping over inertia, p2 [1/m, or 1/rad]."""
    amplitudes: NDArray[np.float64]
    """Amplitude of each swing (n,), between a peak and the next but one."""
    decrements: NDArray[np.float64]
    """Logarithmic decrement of each over a whole period (n,)."""

    @property
    def omega(self) -> float:
        """Undamped natural frequency, w [rad/s]: w^2 = (2 pi / T)^2 + (p1 / 2)^2."""
        return math.hypot(2.0 * math.pi / self.period, 0.5 * self.linear)

    def decrement(self, amplitude: float) -> float:
        """The decrement that the fit gives at an amplitude."""
        whole = self.linear + 16.0 / 3.0 * self.quadratic * amplitude / self.period
        return 0.5 * self.period * whole

    def damping_ratio(self, amplitude: float) -> float:
        """Part of critical damping at an amplitude: the decrement over 2 pi."""
        return self.decrement(amplitude) / (2.0 * math.pi)


def find_peaks(times: NDArray[np.float64], values: NDArray[np.float64]) -> Peaks:
    """Turning points, each by a parabola through three samples, and the release first.

    Those after the motion has died down to `LEAST` of its first are left out.

    Args:
        times: (n,) [s], the release first, and equally spaced after it.
        values: the motion (n,).
    """
    slope = np.diff(values)
    rows = np.flatnonzero(slope[:-1] * slope[1:] < 0.0) + 1
    left, middle, right = values[rows - 1], values[rows], values[rows + 1]
    bend = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / bend
    step = float(times[-1] - times[-2])
    peak_times = np.append(times[0], times[rows] + step * shift)
    peaks = np.append(values[0], middle - 0.25 * (left - right) * shift)

    # as long as it swings: in turn, and not too small
    keep = 1
    least = LEAST * abs(float(values[0]))
    while keep < len(peaks) and abs(peaks[keep] - peaks[keep - 1]) > 2.0 * least:
        keep += 1
    return Peaks(peak_times[:keep], peaks[:keep])


def fit_decay(peaks: Peaks) -> DecayFit:
    """Fit linear and quadratic damping to the decrements of a decay.

    Over a period T the amplitude X goes down by the factor e^-d, with
    2 d / T = p1 + 16 / 3 p2 X / T (Faltinsen 1990, 7.3; the energy that the damping takes over a
    cycle, as Froude 1874). Amplitudes are half the way from a peak to the next, so that where the
    motion comes to rest does not matter.

    Args:
        peaks: the turning points.

    Raises:
        ResponseError: there are fewer than `LEAST_PEAKS`.
    """
    if len(peaks.times) < LEAST_PEAKS:
        raise ResponseError(
            f"the motion turned {len(peaks.times) - 1} times before it died down, and a fit needs "
            f"{LEAST_PEAKS - 1} times: it is damped too much to swing; let it go from further away"
        )
    halves = 0.5 * np.abs(np.diff(peaks.values))
    period = 2.0 * float(np.diff(peaks.times).mean())

    # from a half swing to the next but one, a whole period later
    decrements = np.log(halves[:-2] / halves[2:])
    amplitudes = halves[1:-1]
    if len(amplitudes) == 1:
        linear, quadratic = 2.0 * float(decrements[0]) / period, 0.0
    else:
        design = np.column_stack([np.ones(len(amplitudes)), 16.0 / 3.0 * amplitudes / period])
        # what a small swing says is worth less
        weights = amplitudes[:, None]
        (linear, quadratic), *_ = np.linalg.lstsq(
            weights * design, weights[:, 0] * 2.0 * decrements / period, rcond=None
        )
    return DecayFit(period, float(linear), float(quadratic), amplitudes, decrements)

"""Period and damping of a free decay, from its peaks."""

import math
from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ResponseError

LEAST = 0.03
"""Part of the first peak below which peaks are left out."""
LEAST_PEAKS = 4
"""Peaks that a fit of two damping coefficients needs."""


ROUNDS = 3
"""How often the fit is put right."""


class Peaks(NamedTuple):
    """The turning points of a decay, crests and troughs in turn."""

    times: NDArray[np.float64]
    """When they are (n,) [s]."""
    values: NDArray[np.float64]
    """The motion there (n,)."""


class DecayFit(NamedTuple):
    """A decay as x'' + p1 x' + p2 |x'| x' + w^2 x = 0."""

    period: float
    """Damped period, T [s]."""
    linear: float
    """Linear damping over inertia, p1 [1/s]."""
    quadratic: float
    """Quadratic damping over inertia, p2 [1/m, or 1/rad]."""
    amplitudes: NDArray[np.float64]
    """Mean amplitude of each period (n,), from a peak to the next but one."""
    decrements: NDArray[np.float64]
    """Logarithmic decrement of each (n,)."""

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
    cycle, as Froude 1874). That is right where d is small. So the equation that it gives is solved,
    its decay is fitted in the same way, and what differs is put right, `ROUNDS` times.

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
    amplitudes, decrements = _find_decrements(peaks)
    first = _fit_small_damping(peaks)
    equation = first.copy()
    for _ in range(ROUNDS):
        solved = _solve(equation, float(peaks.values[0]), len(peaks.times))
        if len(solved.times) < LEAST_PEAKS:
            break
        equation += first - _fit_small_damping(solved)
    omega, linear, quadratic = equation.tolist()
    damped = math.sqrt(max(omega**2 - 0.25 * linear**2, 1e-12 * omega**2))
    return DecayFit(2.0 * math.pi / damped, linear, quadratic, amplitudes, decrements)


def _find_decrements(peaks: Peaks) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean amplitude of each period, and its decrement.

    Amplitudes are half the way from a peak to the next, so that where the motion comes to rest does
    not matter; Simpson's rule gives the mean.
    """
    halves = 0.5 * np.abs(np.diff(peaks.values))
    means = (halves[:-2] + 4.0 * halves[1:-1] + halves[2:]) / 6.0
    return means, np.log(halves[:-2] / halves[2:])


def _fit_small_damping(peaks: Peaks) -> NDArray[np.float64]:
    """w, p1 and p2 (3,) by the formula for small decrements."""
    period = 2.0 * float(np.diff(peaks.times).mean())
    amplitudes, decrements = _find_decrements(peaks)
    design = np.column_stack([np.ones(len(amplitudes)), 16.0 / 3.0 * amplitudes / period])
    if len(amplitudes) == 1:
        # one decrement tells one coefficient
        design = design[:, :1]
    found, *_ = np.linalg.lstsq(design, 2.0 * decrements / period, rcond=None)
    linear = float(found[0])
    quadratic = float(found[1]) if len(found) > 1 else 0.0
    return np.array([math.hypot(2.0 * math.pi / period, 0.5 * linear), linear, quadratic])


def _solve(equation: NDArray[np.float64], start: float, count: int) -> Peaks:
    """The first turning points of a decay that obeys w, p1 and p2 (3,)."""
    omega, linear, quadratic = equation.tolist()

    def accelerate(_: float, state: NDArray[np.float64]) -> tuple[float, float]:
        x, v = state.tolist()
        return v, -linear * v - quadratic * abs(v) * v - omega**2 * x

    end = math.pi / omega * (count + 1)
    times = np.linspace(0.0, end, 60 * (count + 1))
    solved = scipy.integrate.solve_ivp(
        accelerate, (0.0, end), (start, 0.0), t_eval=times, rtol=1e-6, atol=1e-9 * abs(start)
    )
    found = find_peaks(solved.t, solved.y[0])
    return Peaks(found.times[:count], found.values[:count])

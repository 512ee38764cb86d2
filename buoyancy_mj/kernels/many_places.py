"""The sea at many places, each at its own time or all at one, for Python.

Times are (n,), one for each place, or (1,), one for all.
"""

import math

import numpy as np

from buoyancy_mj.kernels import series
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.waves import (
    AMPLITUDE,
    KX,
    KY,
    OMEGA,
    PHASE,
    add_motion,
    add_velocity,
    head,
    tangent,
)


@njit(cache=True, error_model="numpy")
def elevations(waves, x, y, time, out):
    """Write `waves.elevation` at points x, y (n,) at one time to `out` (n,).

    Several are found at once, by cos a = 1 - 2 sin^2 a/2.
    """
    out[:] = 0.0
    for w in range(waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        phase = waves[PHASE, w] - waves[OMEGA, w] * time
        for i in range(x.shape[0]):
            out[i] += amplitude * _cosine(kx * x[i] + ky * y[i] + phase)


@njit(cache=True, error_model="numpy")
def elevations_at(waves, x, y, times, out):
    """Write `waves.elevation` at points x, y (n,), each at its own time (n,), to `out` (n,)."""
    out[:] = 0.0
    for w in range(waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        omega, phase = waves[OMEGA, w], waves[PHASE, w]
        for i in range(x.shape[0]):
            out[i] += amplitude * _cosine(kx * x[i] + ky * y[i] + (phase - omega * times[i]))


@njit(cache=True, error_model="numpy", inline="always")
def _cosine(angle):
    """Cosine of any angle, by a series that the compiler takes for several at once."""
    turns = angle * (0.5 / math.pi)
    half = series.sine((turns - math.floor(turns + 0.5)) * math.pi)
    return 1.0 - 2.0 * half * half


@njit(cache=True, error_model="numpy")
def slopes(waves, x, y, times, out):
    """Write the gradient of the elevation at points x, y (n,) to `out` (n, 2)."""
    stride = 1 if times.shape[0] > 1 else 0
    for i in range(x.shape[0]):
        _, out[i, 0], out[i, 1] = tangent(waves, x[i], y[i], times[i * stride])


@njit(cache=True, error_model="numpy")
def heads(waves, points, level, times, out):
    """Write `waves.head` of waves at points (n, 3) to `out` (n,)."""
    stride = 1 if times.shape[0] > 1 else 0
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        out[i] = head(waves, x, y, z - level, times[i * stride], True)


@njit(cache=True, error_model="numpy")
def velocities(waves, current, points, level, times, out):
    """Write the velocity of current and waves [m/s] at points (n, 3) to `out` (n, 3)."""
    stride = 1 if times.shape[0] > 1 else 0
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        time = times[i * stride]
        set_current(current, level - z, time, out[i])
        add_velocity(waves, x, y, z - level, time, out[i])


@njit(cache=True, error_model="numpy")
def accelerations(waves, current, points, level, times, out):
    """Write the acceleration of current and waves [m/s^2] at points (n, 3) to `out` (n, 3).

    It is that of the waves' water, and the rate of the current at places that stay.
    """
    stride = 1 if times.shape[0] > 1 else 0
    unused = np.empty(3)
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        time = times[i * stride]
        set_rate(current, time, out[i])
        unused[:] = 0.0
        add_motion(waves, x, y, z - level, time, unused, out[i])

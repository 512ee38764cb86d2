"""Airy waves as rows of (amplitude, kx, ky, omega, phase, depth): elevation and orbital velocity.

A row with kx = ky = 0 is the whole level going up and down, the limit of an infinitely long wave.
"""

import math

from numba import njit


@njit(cache=True)
def elevation(waves, x, y, time):
    """Sum of the rows' elevations [m] above the still level at one horizontal point."""
    total = 0.0
    for i in range(waves.shape[0]):
        total += waves[i, 0] * math.cos(waves[i, 1] * x + waves[i, 2] * y - waves[i, 3] * time + waves[i, 4])
    return total


SHORT = 1.6
"""Angle [rad] up to which `short_sincos` holds."""


@njit(cache=True, inline="always")
def short_sincos(angle):
    """Sine and cosine of a short angle to 1e-13, by their series: several at once in one instruction."""
    x = angle * angle
    sine = -x / 272.0 * (1.0 - x / 342.0)
    sine = -x / 156.0 * (1.0 - x / 210.0 * (1.0 + sine))
    sine = 1.0 - x / 6.0 * (1.0 - x / 20.0 * (1.0 - x / 42.0 * (1.0 - x / 72.0 * (1.0 - x / 110.0 * (1.0 + sine)))))
    cosine = -x / 240.0 * (1.0 - x / 306.0)
    cosine = -x / 132.0 * (1.0 - x / 182.0 * (1.0 + cosine))
    cosine = 1.0 - x / 2.0 * (1.0 - x / 12.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0 * (1.0 + cosine)))))
    return angle * sine, cosine


@njit(cache=True)
def elevations(waves, x, y, time, out):
    """`elevation` at many points, written to `out`."""
    for i in range(x.shape[0]):
        out[i] = elevation(waves, x[i], y[i], time)


@njit(cache=True)
def add_velocity(waves, x, y, z, time, out):
    """Add the rows' orbital velocity [m/s] at height z above the still level to `out` (3,).

    Linear theory (Newman 1977, 6.2): cosh and sinh of k (z + h) over sinh of k h. Above the still
    level, where the theory has no water, its value at the level is taken.
    """
    z = min(z, 0.0)
    for i in range(waves.shape[0]):
        amplitude, kx, ky, omega = waves[i, 0], waves[i, 1], waves[i, 2], waves[i, 3]
        angle = kx * x + ky * y - omega * time + waves[i, 4]
        k = math.hypot(kx, ky)
        if k == 0.0:
            out[2] += amplitude * omega * math.sin(angle)
            continue
        depth = waves[i, 5]
        height = max(z, -depth)
        # e^{kz} (1 +- e^{-2k(z+h)}) / (1 - e^{-2kh}) is cosh and sinh over sinh without overflow
        decay = math.exp(k * height) / (-math.expm1(-2.0 * k * depth))
        echo = math.exp(-2.0 * k * (height + depth))
        horizontal = amplitude * omega * decay * (1.0 + echo) * math.cos(angle)
        out[0] += horizontal * kx / k
        out[1] += horizontal * ky / k
        out[2] += amplitude * omega * decay * (1.0 - echo) * math.sin(angle)


@njit(cache=True)
def velocities(waves, points, level, time, out):
    """`add_velocity` at many points (n, 3), added to `out` (n, 3)."""
    for i in range(points.shape[0]):
        add_velocity(waves, points[i, 0], points[i, 1], points[i, 2] - level, time, out[i])

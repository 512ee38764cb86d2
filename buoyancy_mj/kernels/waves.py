"""Airy waves as rows of numbers: elevation, pressure, orbital velocity and acceleration at a place.

A row with kx = ky = 0 is the whole level going up and down, the limit of an infinitely long wave.
"""

import math

from numba import njit

from buoyancy_mj.kernels import series
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.vectors import triple

AMPLITUDE, KX, KY, OMEGA, PHASE, DEPTH, SIGMA = range(7)
"""Columns of a row: amplitude [m], wave vector (2) [rad/m], angular frequency at a fixed place
[rad/s], phase at the origin at time 0 [rad], the depth of the water [m], and the angular frequency
as the water sees it, which drifts with the current [rad/s]."""


@njit(cache=True, error_model="numpy", inline="always")
def phase_at(waves, w, x, y, time):
    """Phase of a wave at a place."""
    return waves[w, KX] * x + waves[w, KY] * y - waves[w, OMEGA] * time + waves[w, PHASE]


@njit(cache=True, error_model="numpy")
def elevation(waves, x, y, time):
    """Sum of the rows' elevations [m] above the still level at one horizontal point."""
    total = 0.0
    for i in range(waves.shape[0]):
        total += waves[i, AMPLITUDE] * math.cos(phase_at(waves, i, x, y, time))
    return total


@njit(cache=True, error_model="numpy")
def tangent(waves, x, y, time):
    """Elevation over the still level at a place, and its gradient."""
    eta = along = across = 0.0
    for i in range(waves.shape[0]):
        angle = phase_at(waves, i, x, y, time)
        slope = waves[i, AMPLITUDE] * math.sin(angle)
        eta += waves[i, AMPLITUDE] * math.cos(angle)
        along -= waves[i, KX] * slope
        across -= waves[i, KY] * slope
    return eta, along, across


@njit(cache=True, error_model="numpy")
def swing(waves, x, y, time, radius):
    """Elevation at a place, and bounds within a radius: how much it differs, and is curved."""
    eta = along = across = height = steepness = curvature = twist = hxx = hxy = hyy = 0.0
    for i in range(waves.shape[0]):
        a, kx, ky = triple(waves, i, AMPLITUDE)
        angle = phase_at(waves, i, x, y, time)
        crest, slope = a * math.cos(angle), a * math.sin(angle)
        eta += crest
        along -= kx * slope
        across -= ky * slope
        hxx -= crest * kx * kx
        hxy -= crest * kx * ky
        hyy -= crest * ky * ky

        # bounds that hold everywhere
        k = math.sqrt(kx * kx + ky * ky)
        a = abs(a)
        height += a
        steepness += a * k
        curvature += a * k * k
        twist += a * k * k * k

    # the values at the place, and by how much they can differ elsewhere
    curvature = min(curvature, math.sqrt(hxx * hxx + 2.0 * hxy * hxy + hyy * hyy) + twist * radius)
    steepness = min(steepness, math.hypot(along, across) + curvature * radius)
    return eta, min(2.0 * height, steepness * radius), curvature


@njit(cache=True, error_model="numpy")
def head(waves, x, y, z, time, dynamic):
    """Pressure over rho g [m] at height z over the still level.

    It is the depth under the surface, or with `dynamic` the pressure of linear waves.

    Newman 1977, 6.2: the elevation times cosh k (z + h) over cosh k h, less z. Wheeler's stretching
    (1970, J. Petroleum Technology 22, 359) brings the surface to the theory's still level, so that
    the pressure is zero on it, under crests and in troughs.
    """
    eta = elevation(waves, x, y, time)
    if not dynamic:
        return eta - z
    total = -z
    for i in range(waves.shape[0]):
        a = waves[i, AMPLITUDE] * math.cos(phase_at(waves, i, x, y, time))
        k, depth = math.hypot(waves[i, KX], waves[i, KY]), waves[i, DEPTH]
        total += a * fade(k, depth, stretch(z, eta, depth))[0]
    return total


@njit(cache=True, error_model="numpy", inline="always")
def stretch(z, eta, depth):
    """Where Wheeler's stretching brings a height over the still level; never under the bottom."""
    below = z - eta
    if math.isfinite(depth):
        below = max(depth * below / (depth + eta), -depth) if depth + eta > 0.0 else -depth
    return below


@njit(cache=True, error_model="numpy", inline="always")
def fade(k, depth, z):
    """Cosh and sinh of k (z + h) over cosh k h: how a wave's pressure and its slope fade."""
    if k == 0.0:
        return 1.0, 1.0
    even = odd = math.exp(k * z)
    if math.isfinite(depth):
        echo, bottom = math.exp(-2.0 * k * (z + depth)), 1.0 + math.exp(-2.0 * k * depth)
        even, odd = even * (1.0 + echo) / bottom, odd * (1.0 - echo) / bottom
    return even, odd


@njit(cache=True, error_model="numpy")
def add_velocity(waves, x, y, z, time, out):
    """Add the rows' orbital velocity [m/s] at height z above the still level to `out` (3,).

    Linear theory (Newman 1977, 6.2): cosh and sinh of k (z + h) over sinh of k h. Above the still
    level, where the theory has no water, its value at the level is taken.
    """
    z = min(z, 0.0)
    for i in range(waves.shape[0]):
        amplitude, kx, ky = triple(waves, i, AMPLITUDE)
        sigma, angle = waves[i, SIGMA], phase_at(waves, i, x, y, time)
        k = math.hypot(kx, ky)
        if k == 0.0:
            out[2] += amplitude * sigma * math.sin(angle)
            continue
        depth = waves[i, DEPTH]
        height = max(z, -depth)
        # e^{kz} (1 +- e^{-2k(z+h)}) / (1 - e^{-2kh}) is cosh and sinh over sinh without overflow
        decay = math.exp(k * height) / (-math.expm1(-2.0 * k * depth))
        echo = math.exp(-2.0 * k * (height + depth))
        horizontal = amplitude * sigma * decay * (1.0 + echo) * math.cos(angle)
        out[0] += horizontal * kx / k
        out[1] += horizontal * ky / k
        out[2] += amplitude * sigma * decay * (1.0 - echo) * math.sin(angle)


@njit(cache=True, error_model="numpy")
def add_acceleration(waves, x, y, z, time, out):
    """Add the rows' orbital acceleration [m/s^2], at one place, to `out` (3,).

    It is the rate of `add_velocity` in time for who drifts with the current, as the water does.
    """
    z = min(z, 0.0)
    for i in range(waves.shape[0]):
        amplitude, kx, ky = triple(waves, i, AMPLITUDE)
        sigma, angle = waves[i, SIGMA], phase_at(waves, i, x, y, time)
        k = math.hypot(kx, ky)
        if k == 0.0:
            out[2] -= amplitude * sigma * sigma * math.cos(angle)
            continue
        depth = waves[i, DEPTH]
        height = max(z, -depth)
        decay = math.exp(k * height) / (-math.expm1(-2.0 * k * depth))
        echo = math.exp(-2.0 * k * (height + depth))
        horizontal = amplitude * sigma * sigma * decay * (1.0 + echo) * math.sin(angle)
        out[0] += horizontal * kx / k
        out[1] += horizontal * ky / k
        out[2] -= amplitude * sigma * sigma * decay * (1.0 - echo) * math.cos(angle)


# at many points, for Python


@njit(cache=True, error_model="numpy")
def elevations(waves, x, y, time, out):
    """Write `elevation` at points x, y (n,) to `out` (n,).

    Several are found at once, by cos a = 1 - 2 sin^2 a/2.
    """
    for i in range(x.shape[0]):
        out[i] = 0.0
    for w in range(waves.shape[0]):
        amplitude, kx, ky = triple(waves, w, AMPLITUDE)
        phase = waves[w, PHASE] - waves[w, OMEGA] * time
        for i in range(x.shape[0]):
            turns = (kx * x[i] + ky * y[i] + phase) * (0.5 / math.pi)
            a = (turns - math.floor(turns + 0.5)) * math.pi
            half = series.sine(a)
            out[i] += amplitude * (1.0 - 2.0 * half * half)


@njit(cache=True, error_model="numpy")
def slopes(waves, x, y, time, out):
    """Write the gradient of the elevation at points x, y (n,) to `out` (n, 2)."""
    for i in range(x.shape[0]):
        _, out[i, 0], out[i, 1] = tangent(waves, x[i], y[i], time)


@njit(cache=True, error_model="numpy")
def heads(waves, points, level, time, out):
    """Write `head` of linear waves at points (n, 3) to `out` (n,)."""
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        out[i] = head(waves, x, y, z - level, time, True)


@njit(cache=True, error_model="numpy")
def velocities(waves, current, points, level, time, out):
    """Write the velocity of current and waves [m/s] at points (n, 3) to `out` (n, 3)."""
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        set_current(current, level - z, time, out[i])
        add_velocity(waves, x, y, z - level, time, out[i])


@njit(cache=True, error_model="numpy")
def accelerations(waves, current, points, level, time, out):
    """Write the acceleration of current and waves [m/s^2] at points (n, 3) to `out` (n, 3).

    It is that of the water, which drifts with the current.
    """
    for i in range(points.shape[0]):
        x, y, z = triple(points, i, 0)
        set_rate(current, time, out[i])
        add_acceleration(waves, x, y, z - level, time, out[i])

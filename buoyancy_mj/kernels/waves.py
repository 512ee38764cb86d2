"""Airy waves as rows of (amplitude, kx, ky, omega, phase, depth): elevation and orbital velocity.

A row with kx = ky = 0 is the whole level going up and down, the limit of an infinitely long wave.
"""

import math

from numba import njit

from buoyancy_mj.kernels.currents import set_current, set_rate


@njit(cache=True, error_model="numpy")
def elevation(waves, x, y, time):
    """Sum of the rows' elevations [m] above the still level at one horizontal point."""
    total = 0.0
    for i in range(waves.shape[0]):
        total += waves[i, 0] * math.cos(
            waves[i, 1] * x + waves[i, 2] * y - waves[i, 3] * time + waves[i, 4]
        )
    return total


@njit(cache=True, error_model="numpy")
def tangent(waves, x, y, time):
    """Elevation over the still level at a place, and its gradient."""
    eta = along = across = 0.0
    for i in range(waves.shape[0]):
        angle = waves[i, 1] * x + waves[i, 2] * y - waves[i, 3] * time + waves[i, 4]
        slope = waves[i, 0] * math.sin(angle)
        eta, along, across = (
            eta + waves[i, 0] * math.cos(angle),
            along - waves[i, 1] * slope,
            across - waves[i, 2] * slope,
        )
    return eta, along, across


@njit(cache=True, error_model="numpy")
def swing(waves, x, y, time, radius):
    """Elevation at a place over the still level, and within a radius how much it can differ and be curved."""
    eta = along = across = height = steepness = curvature = twist = hxx = hxy = hyy = 0.0
    for i in range(waves.shape[0]):
        a, kx, ky = waves[i, 0], waves[i, 1], waves[i, 2]
        angle = kx * x + ky * y - waves[i, 3] * time + waves[i, 4]
        crest, slope = a * math.cos(angle), a * math.sin(angle)
        eta, along, across = eta + crest, along - kx * slope, across - ky * slope
        hxx, hxy, hyy = hxx - crest * kx * kx, hxy - crest * kx * ky, hyy - crest * ky * ky
        k = math.sqrt(kx * kx + ky * ky)
        a = abs(a)
        height, steepness, curvature, twist = (
            height + a,
            steepness + a * k,
            curvature + a * k * k,
            twist + a * k * k * k,
        )
    # that at the place, and by how much it can differ elsewhere
    curvature = min(curvature, math.sqrt(hxx * hxx + 2.0 * hxy * hxy + hyy * hyy) + twist * radius)
    steepness = min(steepness, math.hypot(along, across) + curvature * radius)
    return eta, min(2.0 * height, steepness * radius), curvature


@njit(cache=True, error_model="numpy")
def head(waves, x, y, z, time, dynamic):
    """Pressure over rho g [m] at height z over the still level: the depth, or with `dynamic` that of linear waves.

    Newman 1977, 6.2: the elevation times cosh k (z + h) over cosh k h, less z. Wheeler's stretching
    (1970, J. Petroleum Technology 22, 359) brings the surface to the theory's still level, so that
    the pressure is zero on it, under crests and in troughs.
    """
    eta = elevation(waves, x, y, time)
    if not dynamic:
        return eta - z
    total = -z
    for i in range(waves.shape[0]):
        a = waves[i, 0] * math.cos(
            waves[i, 1] * x + waves[i, 2] * y - waves[i, 3] * time + waves[i, 4]
        )
        total += (
            a
            * fade(
                math.hypot(waves[i, 1], waves[i, 2]), waves[i, 5], stretched(z, eta, waves[i, 5])
            )[0]
        )
    return total


@njit(cache=True, error_model="numpy", inline="always")
def stretched(z, eta, depth):
    """Where Wheeler's stretching brings a height over the still level; never under the bottom."""
    below = z - eta
    if math.isfinite(depth):
        below = max(depth * below / (depth + eta), -depth) if depth + eta > 0.0 else -depth
    return below


@njit(cache=True, error_model="numpy", inline="always")
def fade(k, depth, z):
    """Cosh and sinh of k (z + h) over cosh k h: how a wave's pressure, and its slope, fade with depth."""
    if k == 0.0:
        return 1.0, 1.0
    even = odd = math.exp(k * z)
    if math.isfinite(depth):
        echo, bottom = math.exp(-2.0 * k * (z + depth)), 1.0 + math.exp(-2.0 * k * depth)
        even, odd = even * (1.0 + echo) / bottom, odd * (1.0 - echo) / bottom
    return even, odd


SHORT = 1.6
"""Angle [rad] for which the series of `bend` hold; twice that, and four times that, by doubling."""
# one over factorials, of the odd and of the even terms
_S3, _S5, _S7, _S9, _S11, _S13, _S15, _S17, _S19, _S21 = (
    (-1) ** n / math.factorial(2 * n + 1) for n in range(1, 11)
)
_C2, _C4, _C6, _C8, _C10, _C12, _C14, _C16, _C18 = (
    (-1) ** n / math.factorial(2 * n) for n in range(1, 10)
)


@njit(cache=True, error_model="numpy")
def doublings(angle):
    """How often angles up to this one must be halved for `bend`; 3 for by no means often enough."""
    return 0 if angle <= SHORT else 1 if angle <= 2.0 * SHORT else 2 if angle <= 4.0 * SHORT else 3


@njit(cache=True, error_model="numpy", inline="always")
def bend(angle, doubled):
    """Sine less angle, and cosine less 1, to 1e-13, by series that several angles take at once in one instruction."""
    if doubled == 3:
        return math.sin(angle) - angle, math.cos(angle) - 1.0
    angle *= 1.0 if doubled == 0 else 0.5 if doubled == 1 else 0.25
    x = angle * angle
    sine = _S9 + x * (_S11 + x * (_S13 + x * (_S15 + x * _S17)))
    sine = angle * x * (_S3 + x * (_S5 + x * (_S7 + x * sine)))
    cosine = _C10 + x * (_C12 + x * (_C14 + x * (_C16 + x * _C18)))
    cosine = x * (_C2 + x * (_C4 + x * (_C6 + x * (_C8 + x * cosine))))
    if doubled >= 1:
        sine, cosine = (
            2.0 * (sine + angle * cosine + sine * cosine),
            -2.0 * (sine + angle) * (sine + angle),
        )
    if doubled == 2:
        angle *= 2.0
        sine, cosine = (
            2.0 * (sine + angle * cosine + sine * cosine),
            -2.0 * (sine + angle) * (sine + angle),
        )
    return sine, cosine


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def add_acceleration(waves, x, y, z, time, out):
    """Add the rows' orbital acceleration [m/s^2], at one place, to `out` (3,): the rate of `add_velocity` in time."""
    z = min(z, 0.0)
    for i in range(waves.shape[0]):
        amplitude, kx, ky, omega = waves[i, 0], waves[i, 1], waves[i, 2], waves[i, 3]
        angle = kx * x + ky * y - omega * time + waves[i, 4]
        k = math.hypot(kx, ky)
        if k == 0.0:
            out[2] -= amplitude * omega * omega * math.cos(angle)
            continue
        depth = waves[i, 5]
        height = max(z, -depth)
        decay = math.exp(k * height) / (-math.expm1(-2.0 * k * depth))
        echo = math.exp(-2.0 * k * (height + depth))
        horizontal = amplitude * omega * omega * decay * (1.0 + echo) * math.sin(angle)
        out[0] += horizontal * kx / k
        out[1] += horizontal * ky / k
        out[2] -= amplitude * omega * omega * decay * (1.0 - echo) * math.cos(angle)


# at many points, for Python


@njit(cache=True, error_model="numpy")
def elevations(waves, x, y, time, out):
    """`elevation`, written to `out` (n,): several points at once, by cos a = 1 - 2 sin^2 a/2 and the series of the sine."""
    for i in range(x.shape[0]):
        out[i] = 0.0
    for w in range(waves.shape[0]):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        phase = waves[w, 4] - waves[w, 3] * time
        for i in range(x.shape[0]):
            turns = (kx * x[i] + ky * y[i] + phase) * (0.5 / math.pi)
            a = (turns - math.floor(turns + 0.5)) * math.pi
            q = a * a
            end = _S13 + q * (_S15 + q * (_S17 + q * (_S19 + q * _S21)))
            sine = a * (1.0 + q * (_S3 + q * (_S5 + q * (_S7 + q * (_S9 + q * (_S11 + q * end))))))
            out[i] += amplitude * (1.0 - 2.0 * sine * sine)


@njit(cache=True, error_model="numpy")
def slopes(waves, x, y, time, out):
    """Gradient of the elevation, written to `out` (n, 2)."""
    for i in range(x.shape[0]):
        _, out[i, 0], out[i, 1] = tangent(waves, x[i], y[i], time)


@njit(cache=True, error_model="numpy")
def heads(waves, points, level, time, out):
    """`head` of linear waves at points (n, 3), written to `out` (n,)."""
    for i in range(points.shape[0]):
        out[i] = head(waves, points[i, 0], points[i, 1], points[i, 2] - level, time, True)


@njit(cache=True, error_model="numpy")
def velocities(waves, current, points, level, time, out):
    """Velocity of current and waves at points (n, 3), written to `out` (n, 3)."""
    for i in range(points.shape[0]):
        set_current(current, level - points[i, 2], time, out[i])
        add_velocity(waves, points[i, 0], points[i, 1], points[i, 2] - level, time, out[i])


@njit(cache=True, error_model="numpy")
def accelerations(waves, current, points, level, time, out):
    """Its rate at one place, written to `out` (n, 3)."""
    for i in range(points.shape[0]):
        set_rate(current, time, out[i])
        add_acceleration(waves, points[i, 0], points[i, 1], points[i, 2] - level, time, out[i])

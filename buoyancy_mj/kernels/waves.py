"""Airy waves as a table of numbers: elevation, pressure, velocity and acceleration at a place.

Each wave is a column of the table, so that the numbers of a row lie side by side. Sums over the
waves are written without branches and may be taken in any order, so that the processor takes
several waves at once.

A wave with kx = ky = 0 is the whole level going up and down, the limit of an infinitely long wave.
"""

import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.series import turn
from buoyancy_mj.kernels.still_water import (
    LEAST_STRETCH,
    calm,
    decay,
    fade,
    newton,
    seabed,
    settle,
    still_height,
)

ANY_ORDER = {"reassoc", "contract"}
"""What the compiler may do with sums over the waves."""

AMPLITUDE, KX, KY, OMEGA, PHASE, DEPTH, SIGMA, K, BOTTOM, ROWS = range(10)
"""Rows of the table, and how many: amplitude [m], wave vector (2) [rad/m], angular frequency at a
fixed place [rad/s], phase at the origin at time 0 [rad], the depth of the water [m], the angular
frequency as the water sees it, which drifts with the current [rad/s], wave number [rad/m], and what
`still_water.seabed` says. The first seven are columns of `Water.rows`."""


def tabulate(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """The table (ROWS, w) of waves whose first seven numbers are given as rows (w, 7)."""
    k = np.hypot(rows[:, KX], rows[:, KY])
    bottoms = [seabed.py_func(*pair) for pair in zip(k, rows[:, DEPTH], strict=True)]
    return np.ascontiguousarray(np.vstack([rows.T, k, bottoms]))


@njit(cache=True, error_model="numpy", inline="always")
def phase_at(waves, w, x, y, time):
    """Phase of a wave at a place."""
    return waves[KX, w] * x + waves[KY, w] * y - waves[OMEGA, w] * time + waves[PHASE, w]


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def elevation(waves, x, y, time):
    """Sum of the elevations [m] above the still level at one horizontal point."""
    total = 0.0
    for i in range(waves.shape[1]):
        cosine, _ = turn(phase_at(waves, i, x, y, time))
        total += waves[AMPLITUDE, i] * cosine
    return total


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def tangent(waves, x, y, time):
    """Elevation over the still level at a place, and its gradient."""
    eta = along = across = 0.0
    for i in range(waves.shape[1]):
        cosine, sine = turn(phase_at(waves, i, x, y, time))
        slope = waves[AMPLITUDE, i] * sine
        eta += waves[AMPLITUDE, i] * cosine
        along -= waves[KX, i] * slope
        across -= waves[KY, i] * slope
    return eta, along, across


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def head(waves, x, y, z, time, dynamic):
    """Pressure over rho g [m] at height z over the still level.

    It is the depth under the surface, or with `dynamic` the pressure of waves.

    The water at height z stood at z' in still water: z = z' + sum eta S(z'), its rise in linear
    theory, and the head is -z' + sum eta (C - S), with C = cosh k (z' + h) / cosh k h and S = sinh
    k (z' + h) / sinh k h (Newman 1977, 6.2). It is zero on the surface, where z' = 0. To first
    order it is that of linear theory, and its mean is less than still water's by <w^2> / g, w the
    vertical velocity (Longuet-Higgins and Stewart 1964, *Deep-Sea Research* 11, 529). Far below
    the surface it is linear theory with that mean alone, see `settle`.
    """
    eta, fall, depth = survey(waves, x, y, time)
    if not dynamic:
        return eta - z
    still = still_height(z, eta, fall, depth)
    rise = strain = rest = rest_strain = mean = whole = tide = 0.0
    for i in range(waves.shape[1]):
        cosine, _ = turn(phase_at(waves, i, x, y, time))
        a = waves[AMPLITUDE, i] * cosine
        k = waves[K, i]
        wide, narrow, tanh = fade(k, waves[BOTTOM, i], still)
        rise += a * narrow
        strain += a * k * wide
        rest += a * (wide * tanh - narrow)
        rest_strain += a * k * (narrow * tanh - wide)
        square = 0.5 * waves[AMPLITUDE, i] * waves[AMPLITUDE, i] * k * tanh
        mean += square * narrow * narrow
        whole += square
        tide += a if k == 0.0 else 0.0
    return settle(z, still, rise, strain, rest, rest_strain, tide, mean, whole)


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def survey(waves, x, y, time):
    """Elevation at a place, how fast the waves fade with depth [1/m], and the water's depth [m]."""
    eta = weighted = energy = 0.0
    depth = math.inf
    for i in range(waves.shape[1]):
        amplitude = waves[AMPLITUDE, i]
        cosine, _ = turn(phase_at(waves, i, x, y, time))
        eta += amplitude * cosine
        energy += amplitude * amplitude
        weighted += amplitude * amplitude * waves[K, i]
    for i in range(waves.shape[1]):
        depth = min(depth, waves[DEPTH, i])
    return eta, decay(weighted / energy if energy > 0.0 else 0.0, depth), depth


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def add_velocity(waves, x, y, z, time, out):
    """Add the waves' velocity [m/s] at height z above the still level to `out` (3,).

    See `add_motion`.
    """
    u, v, w, _, _, _ = _motion(waves, x, y, z, time)
    out[0] += u
    out[1] += v
    out[2] += w


@njit(cache=True, error_model="numpy", _nrt=False, fastmath=ANY_ORDER)
def add_motion(waves, x, y, z, time, velocity, acceleration):
    """Add the waves' velocity [m/s] and acceleration [m/s^2] to `velocity` and `acceleration` (3,).

    That is linear theory (Newman 1977, 6.2), cosh and sinh of k (z + h) over sinh of k h: near the
    surface at the height where the water stood in still water, far below at its height itself, as
    `head` has it. Above the surface, where there is no water, all is as on the surface.

    The acceleration is that of the water as it moves, with the convective part, as the pressure
    gives it.
    """
    u, v, w, du, dv, dw = _motion(waves, x, y, z, time)
    velocity[0] += u
    velocity[1] += v
    velocity[2] += w
    acceleration[0] += du
    acceleration[1] += dv
    acceleration[2] += dw


@njit(cache=True, error_model="numpy", inline="always")
def _motion(waves, x, y, z, time):
    """The waves' velocity (3) and acceleration (3) at a place.

    It is compiled into its callers, where what nobody reads is left out.
    """
    eta, fall, depth = survey(waves, x, y, time)
    still = still_height(z, eta, fall, depth)

    # at the guess: velocity and acceleration, how they change with height, the water's rise and
    # its slopes, and what follows from the square of the waves
    u = v = w = du = dv = dw = 0.0
    u_z = v_z = w_z = du_z = dv_z = dw_z = 0.0
    rise = strain = along = across = tide = 0.0
    mean = whole = mean_z = drift_x = drift_y = 0.0
    for i in range(waves.shape[1]):
        amplitude, kx, ky = waves[AMPLITUDE, i], waves[KX, i], waves[KY, i]
        sigma, k = waves[SIGMA, i], waves[K, i]
        cosine, sine = turn(phase_at(waves, i, x, y, time))
        crest, slope = amplitude * cosine, amplitude * sine
        wide, narrow, _ = fade(k, waves[BOTTOM, i], still)
        # of all the water that rises, nothing goes aside
        per_k = 1.0 / k if k > 0.0 else 0.0
        bx, by = kx * per_k, ky * per_k

        # along the wave, and upright
        ahead, ahead_z = sigma * crest * wide, sigma * crest * k * narrow
        up, up_z = sigma * slope * narrow, sigma * slope * k * wide
        push, push_z = sigma * sigma * slope * wide, sigma * sigma * slope * k * narrow
        u, v, w = u + bx * ahead, v + by * ahead, w + up
        u_z, v_z, w_z = u_z + bx * ahead_z, v_z + by * ahead_z, w_z + up_z
        du, dv, dw = du + bx * push, dv + by * push, dw - sigma * sigma * crest * narrow
        du_z, dv_z = du_z + bx * push_z, dv_z + by * push_z
        dw_z -= sigma * sigma * crest * k * wide
        rise += crest * narrow
        strain += crest * k * wide
        along -= kx * slope * narrow
        across -= ky * slope * narrow

        # the square of the upright velocity at all times; of all the water that rises there is none
        tide += crest if k == 0.0 else 0.0
        speed = amplitude * sigma if k > 0.0 else 0.0
        whole += speed * speed
        mean += speed * speed * narrow * narrow
        mean_z += speed * speed * k * wide * narrow
        drift_x += 0.5 * speed * amplitude * kx * narrow * narrow
        drift_y += 0.5 * speed * amplitude * ky * narrow * narrow

    # from the guess to the still height, and to the height itself where it is calm
    far = calm(mean, whole)
    near = 1.0 - far
    step = near * min(newton(z, still, rise, strain), -still) + far * (z - tide - still)
    step = max(step, -depth - still)
    u, v, w = u + u_z * step, v + v_z * step, w + w_z * step
    du, dv, dw = du + du_z * step, dv + dv_z * step, dw + dw_z * step

    # at heights that move with the water the mean at a place lacks half of Stokes' drift
    u, v = u + near * drift_x, v + near * drift_y

    # the convective part
    dw /= max(1.0 + near * strain, LEAST_STRETCH)
    du, dv = du - near * along * dw, dv - near * across * dw
    return u, v, w, du, dv, dw + far * mean_z

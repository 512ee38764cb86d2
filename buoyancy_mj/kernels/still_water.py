"""The height at which the water under waves stood in still water, and the pressure there.

Each is one formula of numbers that a sum over the waves gives, see `waves.head`.
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.series import exponential

LEAST_STRETCH = 0.5
"""Least part of its height to which a layer of water is squeezed: waves that break reach 0.55."""
DEEP = 40.0
"""Twice k h from which the bottom is not felt: e^-40 is lost beside 1."""
FLATTEST = 1.0 - 1e-12
"""Most of `seabed`: water so shallow beside a wave that e^(-2 k h) is 1."""


@njit(cache=True, error_model="numpy", inline="always")
def seabed(k, depth):
    """What a wave feels of the bottom, e^(-2 k h); 0 where that is lost beside 1."""
    # not infinite, which times no wave number is none
    twice = 2.0 * k * min(depth, 1e100)
    felt = min(exponential(-twice), FLATTEST)
    return 0.0 if k == 0.0 or twice > DEEP else felt


@njit(cache=True, error_model="numpy", inline="always")
def fade(k, bottom, z):
    """How a wave fades: cosh and sinh of k (z + h) over sinh k h, and tanh k h.

    The pressure fades as the first times the last. The bottom is that of `seabed`.
    """
    down = exponential(k * z)
    echo, most = bottom / down, 1.0 - bottom
    return (down + echo) / most, (down - echo) / most, most / (1.0 + bottom)


@njit(cache=True, error_model="numpy", inline="always")
def decay(k, depth):
    """The a of e^(a z) (1 + z / h), which is sinh k (z + h) / sinh k h to 0.04."""
    shallow = 3.0 / (k * depth) if k > 0.0 else math.inf
    return k / math.sqrt(1.0 + shallow * shallow)


@njit(cache=True, error_model="numpy", inline="always")
def still_height(z, eta, fall, depth):
    """A guess at which height the water at height z stood in still water.

    It is right on the surface, where it is 0, on the bottom, and far from both.
    """
    # the height after Wheeler's stretching (1970, J. Petroleum Technology 22, 359)
    below, left = z - eta, 1.0
    if math.isfinite(depth):
        below = max(depth * below / (depth + eta), -depth) if depth + eta > 0.0 else -depth
        left = 1.0 + below / depth
    if below >= 0.0:
        return 0.0

    # a fraction in place of e^-x
    x = -fall * below
    left /= 1.0 + x * (1.0 + x * (0.5 + x * (1.0 / 6.0)))
    return min(max(z - eta * left, -depth), 0.0)


@njit(cache=True, error_model="numpy", inline="always")
def newton(z, still, rise, strain):
    """How much higher than the guess `still` the water at height z stood in still water.

    It is a step of Newton's on z' + D(z') = z, of which `rise` is D and `strain` its slope.
    """
    return (z - still - rise) / max(1.0 + strain, LEAST_STRETCH)


@njit(cache=True, error_model="numpy", inline="always")
def settle(z, still, rise, strain, rest, rest_strain, tide, mean, whole):
    """The head at height z, from what the waves sum up to at a guess of the still height.

    The square of the waves has a mean, and oscillates with twice their frequency. The oscillation
    belongs to the surface as it is drawn, without the second harmonic of Stokes: `calm` takes it
    off below.

    Args:
        z: height over the still level.
        still: guess of the height in still water, see `still_height`.
        rise: sum of eta S there.
        strain: its slope along z.
        rest: sum of eta (C - S) there.
        rest_strain: its slope.
        tide: what all the water rises.
        mean: <w^2> / g there.
        whole: <w^2> / g at the still level.
    """
    step = newton(z, still, rise, strain)
    twice = (rise - tide) * (strain + rest_strain) - mean
    return rest + rest_strain * step - still - step + calm(mean, whole) * twice


@njit(cache=True, error_model="numpy", inline="always")
def calm(mean, whole):
    """How far from the surface a depth is: 0 on it, 1 far below."""
    return 1.0 - mean / whole if whole > 0.0 else 0.0

"""Which waves become a polynomial around a hull, see `local`, and of which degree.

A series of degree n leaves less than A (k r)^(n + 1) / (n + 1)! out of a wave within a radius r:
the degree is as high as the shortest waves need, and waves that are too short for `MOST` stay as
they are.
"""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import LARGEST
from buoyancy_mj.kernels.waves import AMPLITUDE, DEPTH, KX, KY

LEAST, MOST = 2, LARGEST
"""Degrees of the polynomials."""
FEW = 4
"""Waves up to which they are summed one by one."""
ACCURACY = 1e-5
"""The part of the radius that the polynomials may leave out of the elevation in all."""
_FACTORIAL = float(math.factorial(MOST + 1))


@njit(cache=True, error_model="numpy")
def plan(waves, radius):
    """The degree of the polynomials around a hull of a radius, and the limit of what they hold.

    They hold a wave whose `remainder` is below the limit. A third number is the degree of what the
    bottom adds, which fades towards the surface and needs less.

    All that they leave out is within `ACCURACY` of the radius. The plan is the same at all times.
    """
    many, allowed = waves.shape[0], ACCURACY * radius
    if many <= FEW:
        return LEAST, -1.0, LEAST

    # the waves that are held
    limit = allowed
    while _sum_remainders(waves, radius, limit) > allowed:
        limit *= 0.5

    # what each degree leaves of these, and of what the bottom adds: at most 1 / sinh k h
    left, rest = np.zeros(MOST + 1), np.zeros(MOST + 1)
    for w in range(many):
        if remainder(waves, w, radius) <= limit:
            angle = _angle(waves, w, radius)
            power = abs(waves[w, AMPLITUDE]) * angle * _width(waves, w)
            k = math.hypot(waves[w, KX], waves[w, KY])
            kh = min(max(k * waves[w, DEPTH], 1.0), 99.0) if k > 0.0 else 99.0
            added = 1.0 / math.sinh(kh)
            for degree in range(1, MOST + 1):
                power *= angle * (1.0 / (degree + 1))
                left[degree] += power
                rest[degree] += power * added
    return _lowest(left, allowed), limit, _lowest(rest, 0.1 * allowed)


@njit(cache=True, error_model="numpy")
def _lowest(left, allowed):
    """The lowest degree that leaves no more than is allowed."""
    degree = LEAST
    while degree < MOST and left[degree] > allowed:
        degree += 1
    return degree


@njit(cache=True, error_model="numpy")
def _sum_remainders(waves, radius, limit):
    """The sum of all remainders up to a limit."""
    total = 0.0
    for w in range(waves.shape[0]):
        left = remainder(waves, w, radius)
        if left <= limit:
            total += left
    return total


@njit(cache=True, error_model="numpy")
def remainder(waves, w, radius):
    """What a polynomial of degree `MOST` leaves out of a wave around a hull of a radius."""
    power = _angle(waves, w, radius) ** (MOST + 1)
    return abs(waves[w, AMPLITUDE]) * _width(waves, w) * power / _FACTORIAL


@njit(cache=True, error_model="numpy", inline="always")
def _width(waves, w):
    """How much wider than high the orbits of a wave are in shallow water."""
    kh = waves[w, DEPTH] * math.sqrt(waves[w, KX] ** 2 + waves[w, KY] ** 2)
    return 1.0 / kh if 0.0 < kh < 1.0 else 1.0


@njit(cache=True, error_model="numpy", inline="always")
def _angle(waves, w, radius):
    """How much the phase changes over a path in a hull.

    A fifth is added for the part of the path that is downward.
    """
    kx, ky = waves[w, KX], waves[w, KY]
    return 1.2 * math.sqrt(kx * kx + ky * ky) * radius

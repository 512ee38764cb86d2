"""The waves around a hull as polynomials, by which many of them cost little more than a few.

About the middle of a hull the elevation of a wave, A cos(k.x + phase), is a series in k.x, and the
series of all waves are one polynomial. A series of degree n leaves less than A (k r)^(n + 1) / (n +
1)! out of a wave within a radius r: the degree is as high as the shortest waves need, and waves
that are too short for `MOST` stay as they are. Pressure is one in x, y and the height under the
surface: with its Laplacian zero, all of it follows from two layers, its value on a level and its
slope there.

All that is gathered for a hull stands in one row of numbers, which costs less to hand on than
several.
"""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels.polynomials import (
    LARGEST,
    add_at_many,
    add_in_space_at_many,
    add_series,
    deepen,
    size,
    size_in_space,
    with_gradient,
)
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.waves import (
    AMPLITUDE,
    DEPTH,
    KX,
    KY,
    OMEGA,
    PHASE,
    fade,
    phase_at,
    stretch,
)

LEAST, MOST = 2, LARGEST
"""Degrees of the polynomials."""
FEW = 4
"""Waves up to which they are summed one by one."""
ACCURACY = 1e-5
"""The part of the radius that the polynomials may leave out of the elevation in all."""
FLAT = size.py_func(MOST)
"""Coefficients of a polynomial in x, y, at most."""
SOLID = size_in_space.py_func(MOST)
"""Coefficients of one in x, y, z, at most."""
_FACTORIAL = float(math.factorial(MOST + 1))

COUNT, MANY, DEGREE, X, Y, MIDDLE, BOTTOM, SURFACE = range(8)
"""Columns of a row: how many waves are near, and are in all; the degree; the middle, its height
under the surface as Wheeler stretches it, and the depth of the water; from SURFACE on the
polynomial of the elevation."""
PRESSURE = SURFACE + FLAT
"""First column of the polynomial of the pressure."""
NEAR = PRESSURE + SOLID
"""First column of the near waves, which have `WAVE` numbers each, as in `kernels.waves`."""
WAVE = 7
HEAD, ETA, BELOW, ROOM = 3, 4, 5, 9
"""Rows of a room for many places, after x and y from the middle and z from the still level: the
head or the elevation there; scratch; and how many rows there are."""


@njit(cache=True, error_model="numpy")
def plan(waves, radius):
    """The degree of the polynomials around a hull of a radius, and the limit of what they hold.

    They hold a wave whose `remainder` is below the limit.

    All that they leave out is within `ACCURACY` of the radius. The plan is the same at all times.
    """
    many, allowed = waves.shape[0], ACCURACY * radius
    if many <= FEW:
        return LEAST, -1.0

    # the waves that are held
    limit = allowed
    while _sum_remainders(waves, radius, limit) > allowed:
        limit *= 0.5

    # the degree that these need
    left = np.zeros(MOST + 1)
    for w in range(many):
        if remainder(waves, w, radius) <= limit:
            angle = _angle(waves, w, radius)
            power = abs(waves[w, AMPLITUDE]) * angle
            for degree in range(1, MOST + 1):
                power *= angle * (1.0 / (degree + 1))
                left[degree] += power
    degree = LEAST
    while degree < MOST and left[degree] > allowed:
        degree += 1
    return degree, limit


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
    return abs(waves[w, AMPLITUDE]) * _angle(waves, w, radius) ** (MOST + 1) / _FACTORIAL


@njit(cache=True, error_model="numpy", inline="always")
def _angle(waves, w, radius):
    """How much the phase changes over a path in a hull.

    A fifth is added for the part of the path that is downward.
    """
    kx, ky = waves[w, KX], waves[w, KY]
    return 1.2 * math.sqrt(kx * kx + ky * ky) * radius


@njit(cache=True, error_model="numpy")
def gather(waves, x, y, z, eta, time, radius, degree, limit, dynamic, near):
    """Bring the waves around a place, given from the still level, into a row `near`.

    The degree and the limit are the `plan` of a hull there.

    Waves that the polynomials do not hold are copied as they are; all others go into that of the
    surface, and with `dynamic` into that of the pressure. The row has NEAR numbers, and `WAVE` for
    each wave; `eta` is the elevation over the place.
    """
    many = waves.shape[0]
    near[:NEAR] = 0.0
    count, bottom = 0, waves[0, DEPTH] if many else math.inf
    below, layer = stretch(z, eta, bottom), size(degree)
    for w in range(many):
        amplitude, kx, ky = triple(waves, w, AMPLITUDE)
        phase = phase_at(waves, w, x, y, time)
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        k = math.sqrt(kx * kx + ky * ky)

        # too short a wave, or one in water of another depth
        if remainder(waves, w, radius) > limit or (waves[w, DEPTH] != bottom and k > 0.0):
            for c in range(WAVE):
                near[NEAR + WAVE * count + c] = waves[w, c]
            count += 1
            continue

        # the others
        add_series(near, SURFACE, degree, crest, slope, kx, ky)
        if dynamic:
            even, odd = fade(k, waves[w, DEPTH], below)
            add_series(near, PRESSURE, degree, even * crest, even * slope, kx, ky)
            add_series(near, PRESSURE + layer, degree - 1, k * odd * crest, k * odd * slope, kx, ky)
    if dynamic:
        deepen(near, PRESSURE, degree)

    near[COUNT], near[MANY], near[DEGREE] = count, many, degree
    near[X], near[Y], near[MIDDLE], near[BOTTOM] = x, y, below, bottom


@njit(cache=True, error_model="numpy")
def surface(near, x, y, time):
    """Elevation at a place, of what was gathered, and its gradient."""
    eta = along = across = 0.0
    if near[COUNT] < near[MANY]:
        dx, dy = x - near[X], y - near[Y]
        eta, along, across = with_gradient(near, SURFACE, int(near[DEGREE]), dx, dy)
    for w in range(int(near[COUNT])):
        i = NEAR + WAVE * w
        phase = _phase(near, i, x, y, time)
        slope = near[i + AMPLITUDE] * math.sin(phase)
        eta += near[i + AMPLITUDE] * math.cos(phase)
        along -= near[i + KX] * slope
        across -= near[i + KY] * slope
    return eta, along, across


@njit(cache=True, error_model="numpy", inline="always")
def _phase(near, i, x, y, time):
    """Phase at a place of the near wave whose numbers begin at column i."""
    return near[i + KX] * x + near[i + KY] * y - near[i + OMEGA] * time + near[i + PHASE]


@njit(cache=True, error_model="numpy")
def elevations(near, room, count, time):
    """Write the elevations at `count` places, rows 0 and 1 of a room, to row HEAD."""
    eta = room[HEAD]
    for v in range(count):
        eta[v] = 0.0
    if near[COUNT] < near[MANY]:
        degree = int(near[DEGREE])
        add_at_many(near, SURFACE, degree, room[0], room[1], count, room[6], room[7], eta)
    for w in range(int(near[COUNT])):
        i = NEAR + WAVE * w
        kx, ky, phase = near[i + KX], near[i + KY], _phase(near, i, near[X], near[Y], time)
        for v in range(count):
            eta[v] += near[i + AMPLITUDE] * math.cos(kx * room[0, v] + ky * room[1, v] + phase)


@njit(cache=True, error_model="numpy")
def heads(near, room, count, time, dynamic):
    """Write `waves.head` at `count` places, rows 0 to 2 of a room, to row HEAD."""
    z, head = room[2], room[HEAD]
    elevations(near, room, count, time)
    if dynamic:
        _set_dynamic_heads(near, room, count, time)
    else:
        for v in range(count):
            head[v] -= z[v]


@njit(cache=True, error_model="numpy")
def _set_dynamic_heads(near, room, count, time):
    """Write the heads of linear waves to row HEAD, which holds the elevations."""
    z, head, eta, below = room[2], room[HEAD], room[ETA], room[BELOW]
    for v in range(count):
        eta[v] = head[v]
        head[v] = -z[v]

    # waves that the polynomial holds
    if near[COUNT] < near[MANY]:
        for v in range(count):
            below[v] = stretch(z[v], eta[v], near[BOTTOM]) - near[MIDDLE]
        add_in_space_at_many(
            near, PRESSURE, int(near[DEGREE]), room[0], room[1], below, count,
            room[6], room[7], room[8], head,
        )  # fmt: skip

    # those that are near; a single wave's elevation is known
    for w in range(int(near[COUNT])):
        i = NEAR + WAVE * w
        kx, ky, bottom = near[i + KX], near[i + KY], near[i + DEPTH]
        k, phase = math.sqrt(kx * kx + ky * ky), _phase(near, i, near[X], near[Y], time)
        for v in range(count):
            a = eta[v]
            if near[MANY] > 1.0:
                a = near[i + AMPLITUDE] * math.cos(kx * room[0, v] + ky * room[1, v] + phase)
            head[v] += a * fade(k, bottom, stretch(z[v], eta[v], bottom))[0]

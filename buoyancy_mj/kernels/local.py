"""The waves around a hull as polynomials, by which many of them cost little more than a few.

About the middle of a hull the elevation of a wave, A cos(k.x + phase), is a series in k.x, and the
series of all waves are one polynomial. What its end leaves out of a wave is less than A (k r)^(n + 1)
/ (n + 1)! within a radius r, for a degree n: it is as high as the shortest waves need, and waves that
are too short for `MOST` stay what they are. Pressure is likewise one in x, y and the height under the
surface: with its Laplacian zero, all of it follows from two layers, its value on a level and its
slope there.

The coefficients of x^m y^n stand in order of m, then n; those of z^p x^m y^n of p, then m, then n. All that
is gathered for a hull stands in one row of numbers, which costs less to hand on than several.
"""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels.waves import fade, stretched

LEAST, MOST = 2, 8
"""Degrees of the polynomials."""
FEW = 4
"""Waves up to which they are summed one by one."""
ACCURACY = 1e-5
"""What the polynomials may leave out of the elevation in all, over the radius."""
FLAT = (MOST + 1) * (MOST + 2) // 2
"""Coefficients of a polynomial in x, y, at most."""
SOLID = FLAT * (MOST + 3) // 3
"""Coefficients of one in x, y, z, at most."""
_FACTORIAL = float(math.factorial(MOST + 1))
_INVERSE = tuple(1.0 / n for n in range(1, MOST + 2))
COUNT, MANY, DEGREE, X, Y, MIDDLE, DEPTH, SURFACE = range(8)
"""In such a row: how many waves are near, and are in all; the degree; the middle, its height under the surface as
Wheeler stretches it, and the depth of the water; the polynomials of elevation and of pressure, and the near waves."""
PRESSURE = SURFACE + FLAT
NEAR = PRESSURE + SOLID
HEAD, ETA, BELOW, ROOM = 3, 4, 5, 9
"""Rows of a room for many places: x and y from the middle, z from the still level, what comes out, what is worked in."""


@njit(cache=True, error_model="numpy")
def plan(waves, radius):
    """The degree of the polynomials around a hull of a radius, and up to which `remainder` they hold a wave.

    All that they leave out is within `ACCURACY` of the radius. It is the same at all times.
    """
    many, allowed = waves.shape[0], ACCURACY * radius
    if many <= FEW:
        return LEAST, -1.0
    # the waves that are held
    limit = allowed
    while True:
        total = 0.0
        for w in range(many):
            left = remainder(waves, w, radius)
            if left <= limit:
                total += left
        if total <= allowed:
            break
        limit *= 0.5
    # the degree that these need
    left = np.zeros(MOST + 1)
    for w in range(many):
        if remainder(waves, w, radius) <= limit:
            angle = _angle(waves, w, radius)
            power = abs(waves[w, 0]) * angle
            for degree in range(1, MOST + 1):
                power *= angle * _INVERSE[degree]
                left[degree] += power
    degree = LEAST
    while degree < MOST and left[degree] > allowed:
        degree += 1
    return degree, limit


@njit(cache=True, error_model="numpy")
def remainder(waves, w, radius):
    """What a polynomial of degree `MOST` leaves out of a wave around a hull of a radius."""
    return abs(waves[w, 0]) * _angle(waves, w, radius) ** (MOST + 1) / _FACTORIAL


@njit(cache=True, error_model="numpy", inline="always")
def _angle(waves, w, radius):
    """By how much the phase changes over a path in a hull, and a fifth more for the part of it that is downward."""
    return 1.2 * math.sqrt(waves[w, 1] * waves[w, 1] + waves[w, 2] * waves[w, 2]) * radius


@njit(cache=True, error_model="numpy")
def add_series(flat, start, degree, crest, slope, kx, ky):
    """Add a wave with A cos and A sin of its phase at the middle to coefficients, in x and y to a degree."""
    i = start
    x = 1.0
    for m in range(degree + 1):
        # derivatives by the phase go round: cos, -sin, -cos, sin
        turn = m % 4
        one, two = (crest, -slope) if turn % 2 == 0 else (-slope, -crest)
        if turn >= 2:
            one, two = -one, -two
        y = x
        for n in range(degree - m + 1):
            flat[i] += one * y
            one, two = two, -one
            y *= ky * _INVERSE[n]
            i += 1
        x *= kx * _INVERSE[m]


@njit(cache=True, error_model="numpy")
def with_gradient(flat, start, degree, x, y):
    """A polynomial, and its gradient."""
    i = start + (degree + 1) * (degree + 2) // 2
    total = along = across = 0.0
    for m in range(degree, -1, -1):
        row = change = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            change = change * y + row
            row = row * y + flat[i]
        along = along * x + total
        total = total * x + row
        across = across * x + change
    return total, along, across


@njit(cache=True, error_model="numpy")
def add_at_many(flat, start, degree, x, y, count, row, total, out):
    """Add a polynomial at `count` places to `out`; `row` and `total` are worked in."""
    _set_at_many(flat, start + (degree + 1) * (degree + 2) // 2, degree, x, y, count, row, total)
    for v in range(count):
        out[v] += total[v]


@njit(cache=True, error_model="numpy", inline="always")
def _set_at_many(flat, end, degree, x, y, count, row, total):
    """A polynomial whose coefficients end somewhere, at many places; gives where they begin."""
    i = end
    for v in range(count):
        total[v] = 0.0
    for m in range(degree, -1, -1):
        for v in range(count):
            row[v] = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            c = flat[i]
            for v in range(count):
                row[v] = row[v] * y[v] + c
        for v in range(count):
            total[v] = total[v] * x[v] + row[v]
    return i


@njit(cache=True, error_model="numpy")
def along_ray(flat, degree, x, y, ray):
    """Coefficients of u^j, written to `ray`, of a polynomial at u x, u y."""
    for j in range(degree + 1):
        ray[j] = 0.0
    i = 0
    xs = 1.0
    for m in range(degree + 1):
        both = xs
        for n in range(degree - m + 1):
            ray[m + n] += flat[i] * both
            both *= y
            i += 1
        xs *= x


@njit(cache=True, error_model="numpy")
def on_ray(ray, degree, u):
    """A polynomial in u."""
    total = 0.0
    for j in range(degree, -1, -1):
        total = total * u + ray[j]
    return total


# pressure


@njit(cache=True, error_model="numpy")
def deepen(solid, start, degree):
    """The layers z^2 and up of a polynomial without a Laplacian, from its layers z^0 and z^1."""
    below, size = start, (degree + 1) * (degree + 2) // 2
    for p in range(2, degree + 1):
        # layers of two degrees more, one more, and of this
        left = degree - p
        above = below + size
        here = above + (left + 2) * (left + 3) // 2
        i = here
        for m in range(left + 1):
            for n in range(left - m + 1):
                one = solid[below + _place(left + 2, m + 2, n)] * (m + 2) * (m + 1)
                other = solid[below + _place(left + 2, m, n + 2)] * (n + 2) * (n + 1)
                solid[i] = -(one + other) / (p * (p - 1))
                i += 1
        below, size = above, here - above


@njit(cache=True, error_model="numpy", inline="always")
def _place(degree, m, n):
    """Where the coefficient of x^m y^n stands among those of a degree."""
    return m * (2 * degree + 3 - m) // 2 + n


@njit(cache=True, error_model="numpy")
def add_solid_at_many(solid, start, degree, x, y, z, count, row, total, whole, out):
    """Add a polynomial in x, y, z likewise."""
    for v in range(count):
        whole[v] = 0.0
    i = start + (degree + 1) * (degree + 2) * (degree + 3) // 6
    for p in range(degree, -1, -1):
        i = _set_at_many(solid, i, degree - p, x, y, count, row, total)
        for v in range(count):
            whole[v] = whole[v] * z[v] + total[v]
    for v in range(count):
        out[v] += whole[v]


@njit(cache=True, error_model="numpy")
def gather(waves, x, y, z, eta, time, radius, degree, limit, dynamic, sea):
    """Bring the waves to a hull within a radius of a place, given from the still level, into a row `sea`, by its `plan`.

    Waves that the polynomials do not hold are copied as they are; all others go into that of the
    surface, and with `dynamic` into that of the pressure. The row has NEAR + 6 numbers for each wave;
    `eta` is the elevation over the place.
    """
    many = waves.shape[0]
    sea[:NEAR] = 0.0
    count, depth = 0, waves[0, 5] if many else math.inf
    below, layer = stretched(z, eta, depth), (degree + 1) * (degree + 2) // 2
    for w in range(many):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        phase = kx * x + ky * y - waves[w, 3] * time + waves[w, 4]
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        k = math.sqrt(kx * kx + ky * ky)
        if remainder(waves, w, radius) > limit or (waves[w, 5] != depth and k > 0.0):
            for c in range(6):
                sea[NEAR + 6 * count + c] = waves[w, c]
            count += 1
            continue
        add_series(sea, SURFACE, degree, crest, slope, kx, ky)
        if dynamic:
            even, odd = fade(k, waves[w, 5], below)
            add_series(sea, PRESSURE, degree, even * crest, even * slope, kx, ky)
            add_series(sea, PRESSURE + layer, degree - 1, k * odd * crest, k * odd * slope, kx, ky)
    if dynamic:
        deepen(sea, PRESSURE, degree)
    sea[COUNT], sea[MANY], sea[DEGREE], sea[X], sea[Y], sea[MIDDLE], sea[DEPTH] = (
        count,
        many,
        degree,
        x,
        y,
        below,
        depth,
    )


@njit(cache=True, error_model="numpy")
def surface(sea, x, y, time):
    """Elevation at a place, of what was gathered, and its gradient."""
    eta = along = across = 0.0
    if sea[COUNT] < sea[MANY]:
        eta, along, across = with_gradient(sea, SURFACE, int(sea[DEGREE]), x - sea[X], y - sea[Y])
    for w in range(int(sea[COUNT])):
        i = NEAR + 6 * w
        phase = sea[i + 1] * x + sea[i + 2] * y - sea[i + 3] * time + sea[i + 4]
        slope = sea[i] * math.sin(phase)
        eta, along, across = (
            eta + sea[i] * math.cos(phase),
            along - sea[i + 1] * slope,
            across - sea[i + 2] * slope,
        )
    return eta, along, across


@njit(cache=True, error_model="numpy")
def elevations(sea, room, count, time):
    """Elevations at `count` places, rows 0 and 1 of a room, to row HEAD."""
    eta = room[HEAD]
    for v in range(count):
        eta[v] = 0.0
    if sea[COUNT] < sea[MANY]:
        add_at_many(sea, SURFACE, int(sea[DEGREE]), room[0], room[1], count, room[6], room[7], eta)
    for w in range(int(sea[COUNT])):
        i = NEAR + 6 * w
        phase = sea[i + 1] * sea[X] + sea[i + 2] * sea[Y] - sea[i + 3] * time + sea[i + 4]
        for v in range(count):
            eta[v] += sea[i] * math.cos(sea[i + 1] * room[0, v] + sea[i + 2] * room[1, v] + phase)


@njit(cache=True, error_model="numpy")
def heads(sea, room, count, time, dynamic):
    """`waves.head` at `count` places, rows 0 to 2 of a room, of what was gathered, to row HEAD."""
    z, head, eta, below = room[2], room[HEAD], room[ETA], room[BELOW]
    elevations(sea, room, count, time)
    if not dynamic:
        for v in range(count):
            head[v] -= z[v]
        return
    for v in range(count):
        eta[v], head[v] = head[v], -z[v]
    if sea[COUNT] < sea[MANY]:
        for v in range(count):
            below[v] = stretched(z[v], eta[v], sea[DEPTH]) - sea[MIDDLE]
        add_solid_at_many(
            sea,
            PRESSURE,
            int(sea[DEGREE]),
            room[0],
            room[1],
            below,
            count,
            room[6],
            room[7],
            room[8],
            head,
        )
    for w in range(int(sea[COUNT])):
        i = NEAR + 6 * w
        k = math.sqrt(sea[i + 1] * sea[i + 1] + sea[i + 2] * sea[i + 2])
        phase = sea[i + 1] * sea[X] + sea[i + 2] * sea[Y] - sea[i + 3] * time + sea[i + 4]
        for v in range(count):
            a = eta[v]
            if sea[MANY] > 1.0:
                a = sea[i] * math.cos(sea[i + 1] * room[0, v] + sea[i + 2] * room[1, v] + phase)
            head[v] += a * fade(k, sea[i + 5], stretched(z[v], eta[v], sea[i + 5]))[0]

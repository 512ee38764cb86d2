"""The waves around a hull as polynomials, by which many of them cost little more than a few.

About the middle of a hull the elevation of a wave, A cos(k.x + phase), is a series in k.x, and the
series of all waves are one polynomial of `DEGREE`. What its end leaves out of a wave is less than
A (k r)^(DEGREE + 1) / (DEGREE + 1)! within a radius r; waves that are too short for that stay what
they are. Pressure is likewise one in x, y and the height under the surface: with its Laplacian
zero, all of it follows from two layers, its value on a level and its slope there.

The coefficients of x^m y^n stand in order of m, then n; those of z^p x^m y^n of p, then m, then n. All that
is gathered for a hull stands in one row of numbers, which costs less to hand on than several.
"""

import math

from numba import njit

from buoyancy_mj.kernels.waves import fade, stretched

DEGREE = 8
"""Of the polynomials."""
FEW = 4
"""Waves up to which they are summed one by one."""
ACCURACY = 1e-5
"""What the polynomials may leave out of the elevation in all, over the radius."""
FLAT = (DEGREE + 1) * (DEGREE + 2) // 2
"""Coefficients of a polynomial in x, y."""
SOLID = FLAT * (DEGREE + 3) // 3
"""Coefficients of one in x, y, z."""
_FACTORIAL = math.factorial(DEGREE + 1)
_INVERSE = tuple(1.0 / n for n in range(1, DEGREE + 2))
COUNT, MANY, X, Y, MIDDLE, DEPTH, SURFACE = range(7)
"""In such a row: how many waves are near, and are in all; the middle, its height under the surface as Wheeler
stretches it, and the depth of the water; and the polynomials of elevation and of pressure, and the near waves."""
PRESSURE = SURFACE + FLAT
NEAR = PRESSURE + SOLID


@njit(cache=True, error_model="numpy")
def fits(amplitude, angle, radius, many):
    """Whether the polynomials hold a wave of `many`, whose phase changes by no more than `angle` over the radius."""
    return many > FEW and abs(amplitude) * angle ** (DEGREE + 1) <= ACCURACY / many * radius * _FACTORIAL


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
def at(flat, start, x, y):
    """A polynomial whose coefficients begin somewhere."""
    i = start + FLAT
    total = 0.0
    for m in range(DEGREE, -1, -1):
        row = 0.0
        for _ in range(DEGREE - m + 1):
            i -= 1
            row = row * y + flat[i]
        total = total * x + row
    return total


@njit(cache=True, error_model="numpy")
def with_gradient(flat, x, y):
    """A polynomial, and its gradient."""
    i = FLAT
    total = along = across = 0.0
    for m in range(DEGREE, -1, -1):
        row = change = 0.0
        for _ in range(DEGREE - m + 1):
            i -= 1
            change = change * y + row
            row = row * y + flat[i]
        along = along * x + total
        total = total * x + row
        across = across * x + change
    return total, along, across


@njit(cache=True, error_model="numpy")
def add_at_many(flat, room, count, out):
    """Add a polynomial at places, rows 0 and 1 of `room`, to `out`; rows 2 and 3 are worked in."""
    x, y, row, total = room[0], room[1], room[2], room[3]
    for v in range(count):
        total[v] = 0.0
    i = FLAT
    for m in range(DEGREE, -1, -1):
        for v in range(count):
            row[v] = 0.0
        for _ in range(DEGREE - m + 1):
            i -= 1
            c = flat[i]
            for v in range(count):
                row[v] = row[v] * y[v] + c
        for v in range(count):
            total[v] = total[v] * x[v] + row[v]
    for v in range(count):
        out[v] += total[v]


@njit(cache=True, error_model="numpy")
def along_ray(flat, x, y, ray):
    """Coefficients of u^j, written to `ray`, of a polynomial at u x, u y."""
    for j in range(DEGREE + 1):
        ray[j] = 0.0
    i = 0
    xs = 1.0
    for m in range(DEGREE + 1):
        both = xs
        for n in range(DEGREE - m + 1):
            ray[m + n] += flat[i] * both
            both *= y
            i += 1
        xs *= x


@njit(cache=True, error_model="numpy")
def on_ray(ray, u):
    """A polynomial in u."""
    total = 0.0
    for j in range(DEGREE, -1, -1):
        total = total * u + ray[j]
    return total


# pressure


@njit(cache=True, error_model="numpy")
def deepen(solid, start):
    """The layers z^2 and up of a polynomial without a Laplacian, from its layers z^0 and z^1."""
    below, size = start, FLAT
    for p in range(2, DEGREE + 1):
        # layers of degree DEGREE - p + 2, DEGREE - p + 1 and DEGREE - p
        above = below + size
        degree = DEGREE - p
        here = above + (degree + 2) * (degree + 3) // 2
        i = here
        for m in range(degree + 1):
            for n in range(degree - m + 1):
                one = solid[below + _place(degree + 2, m + 2, n)] * (m + 2) * (m + 1)
                other = solid[below + _place(degree + 2, m, n + 2)] * (n + 2) * (n + 1)
                solid[i] = -(one + other) / (p * (p - 1))
                i += 1
        below, size = above, here - above


@njit(cache=True, error_model="numpy", inline="always")
def _place(degree, m, n):
    """Where the coefficient of x^m y^n stands among those of a degree."""
    return m * (2 * degree + 3 - m) // 2 + n


@njit(cache=True, error_model="numpy")
def solid_at(solid, start, x, y, z):
    """A polynomial in x, y, z."""
    i = start + SOLID
    whole = 0.0
    for p in range(DEGREE, -1, -1):
        total = 0.0
        for m in range(DEGREE - p, -1, -1):
            row = 0.0
            for _ in range(DEGREE - p - m + 1):
                i -= 1
                row = row * y + solid[i]
            total = total * x + row
        whole = whole * z + total
    return whole


@njit(cache=True, error_model="numpy")
def gather(waves, x, y, z, time, radius, dynamic, sea):
    """Bring the waves to a hull within a radius of a place, given from the still level, into a row `sea`.

    Waves that the polynomials do not hold are copied as they are; all others go into that of the
    surface, and with `dynamic` into that of the pressure. The row has NEAR + 6 numbers for each wave.
    """
    many = waves.shape[0]
    sea[:NEAR] = 0.0
    count, depth, eta = 0, waves[0, 5] if many else math.inf, 0.0
    for w in range(many):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        phase = kx * x + ky * y - waves[w, 3] * time + waves[w, 4]
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        eta += crest
        k = math.sqrt(kx * kx + ky * ky)
        if fits(amplitude, 1.2 * k * radius, radius, many) and (waves[w, 5] == depth or k == 0.0):
            add_series(sea, SURFACE, DEGREE, crest, slope, kx, ky)
        else:
            for c in range(6):
                sea[NEAR + 6 * count + c] = waves[w, c]
            count += 1
    sea[COUNT], sea[MANY], sea[X], sea[Y], sea[DEPTH] = count, many, x, y, depth
    if count == many or not dynamic:
        return
    below = stretched(z, eta, depth)
    sea[MIDDLE] = below
    for w in range(many):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        k = math.sqrt(kx * kx + ky * ky)
        if not (fits(amplitude, 1.2 * k * radius, radius, many) and (waves[w, 5] == depth or k == 0.0)):
            continue
        phase = kx * x + ky * y - waves[w, 3] * time + waves[w, 4]
        even, odd = fade(k, waves[w, 5], below)
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        add_series(sea, PRESSURE, DEGREE, even * crest, even * slope, kx, ky)
        add_series(sea, PRESSURE + FLAT, DEGREE - 1, k * odd * crest, k * odd * slope, kx, ky)
    deepen(sea, PRESSURE)


@njit(cache=True, error_model="numpy")
def surface(sea, x, y, time):
    """Elevation at a place, of what was gathered."""
    count = int(sea[COUNT])
    eta = at(sea, SURFACE, x - sea[X], y - sea[Y]) if sea[COUNT] < sea[MANY] else 0.0
    for w in range(count):
        i = NEAR + 6 * w
        eta += sea[i] * math.cos(sea[i + 1] * x + sea[i + 2] * y - sea[i + 3] * time + sea[i + 4])
    return eta


@njit(cache=True, error_model="numpy")
def head(sea, x, y, z, time, dynamic):
    """`waves.head` of what was gathered."""
    eta = surface(sea, x, y, time)
    if not dynamic:
        return eta - z
    total = -z
    if sea[COUNT] < sea[MANY]:
        total += solid_at(sea, PRESSURE, x - sea[X], y - sea[Y], stretched(z, eta, sea[DEPTH]) - sea[MIDDLE])
    for w in range(int(sea[COUNT])):
        i = NEAR + 6 * w
        a = eta
        if sea[MANY] > 1.0:
            a = sea[i] * math.cos(sea[i + 1] * x + sea[i + 2] * y - sea[i + 3] * time + sea[i + 4])
        k = math.sqrt(sea[i + 1] * sea[i + 1] + sea[i + 2] * sea[i + 2])
        total += a * fade(k, sea[i + 5], stretched(z, eta, sea[i + 5]))[0]
    return total

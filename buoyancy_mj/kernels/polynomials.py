"""Polynomials in x, y and in x, y, z, whose coefficients stand one after the other in an array.

The coefficients of x^m y^n stand in order of m, then n; those of z^p x^m y^n of p, then m, then n.
"""

from buoyancy_mj.kernels.compiling import njit

LARGEST = 8
"""Largest degree."""
_INVERSE = tuple(1.0 / n for n in range(1, LARGEST + 2))


@njit(cache=True, error_model="numpy", inline="always")
def size(degree):
    """How many coefficients a polynomial in x, y has."""
    return (degree + 1) * (degree + 2) // 2


@njit(cache=True, error_model="numpy", inline="always")
def size_in_space(degree):
    """How many coefficients a polynomial in x, y, z has."""
    return (degree + 1) * (degree + 2) * (degree + 3) // 6


@njit(cache=True, error_model="numpy")
def add_series(flat, start, degree, crest, slope, kx, ky):
    """Add the series of a wave to coefficients in x, y.

    The wave has A cos and A sin of its phase at the middle.
    """
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
def add_powers(line, start, even, odd, k):
    """Add the series of even cosh k z + odd sinh k z, of the degree `LARGEST`, to coefficients."""
    one, two, power = even, odd, 1.0
    for n in range(LARGEST + 1):
        line[start + n] += one * power
        one, two = two, one
        power *= k * _INVERSE[n]


@njit(cache=True, error_model="numpy", inline="always")
def on_powers(line, start, z):
    """A polynomial in z of the degree `LARGEST`."""
    total = 0.0
    for n in range(LARGEST, -1, -1):
        total = total * z + line[start + n]
    return total


@njit(cache=True, error_model="numpy")
def with_gradient(flat, start, degree, x, y):
    """A polynomial in x, y at a place, and its gradient, by Horner's rule."""
    i = start + size(degree)
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
    """Add a polynomial in x, y at `count` places to `out`; `row` and `total` are scratch."""
    _set_at_many(flat, start + size(degree), degree, x, y, count, row, total)
    for v in range(count):
        out[v] += total[v]


@njit(cache=True, error_model="numpy")
def set_in_space_at_many(solid, start, degree, x, y, z, count, row, level, out, slope):
    """Write a polynomial in x, y, z at `count` places to `out`, and its slope along z to `slope`.

    `row` and `level` are scratch.
    """
    for v in range(count):
        out[v] = slope[v] = 0.0
    i = start + size_in_space(degree)
    for p in range(degree, -1, -1):
        i = _set_at_many(solid, i, degree - p, x, y, count, row, level)
        for v in range(count):
            slope[v] = slope[v] * z[v] + out[v]
            out[v] = out[v] * z[v] + level[v]


@njit(cache=True, error_model="numpy", inline="always")
def _set_at_many(flat, end, degree, x, y, count, row, total):
    """Write a polynomial in x, y at many places to `total`.

    Its coefficients end before `end`. Returns where they begin.
    """
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
def set_along_ray(flat, degree, x, y, ray):
    """Write to `ray` the coefficients of u^j that a polynomial in x, y has at (u x, u y)."""
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


@njit(cache=True, error_model="numpy")
def deepen(solid, start, degree):
    """Write the layers z^2 and up of a polynomial without a Laplacian, from the layers below."""
    below, extent = start, size(degree)
    for p in range(2, degree + 1):
        # layers of two degrees more, one more, and of this
        left = degree - p
        above = below + extent
        here = above + size(left + 1)
        i = here
        for m in range(left + 1):
            for n in range(left - m + 1):
                one = solid[below + _place(left + 2, m + 2, n)] * (m + 2) * (m + 1)
                other = solid[below + _place(left + 2, m, n + 2)] * (n + 2) * (n + 1)
                solid[i] = -(one + other) / (p * (p - 1))
                i += 1
        below, extent = above, here - above


@njit(cache=True, error_model="numpy", inline="always")
def _place(degree, m, n):
    """Where the coefficient of x^m y^n stands among those of a degree."""
    return m * (2 * degree + 3 - m) // 2 + n

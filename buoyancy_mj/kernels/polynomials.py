"""Polynomials in x, y and in x, y, z, whose coefficients stand one after the other in an array.

The coefficients of x^m y^n stand in order of m, then n; those of z^p x^m y^n of p, then m, then n.
"""

from buoyancy_mj.kernels.compiling import njit


@njit(cache=True, error_model="numpy", inline="always")
def size(degree):
    """How many coefficients a polynomial in x, y has."""
    return (degree + 1) * (degree + 2) // 2


@njit(cache=True, error_model="numpy", inline="always")
def size_in_space(degree):
    """How many coefficients a polynomial in x, y, z has."""
    return (degree + 1) * (degree + 2) * (degree + 3) // 6


@njit(cache=True, error_model="numpy", inline="always")
def on_powers(line, degree, z):
    """A polynomial in z."""
    total = 0.0
    for n in range(degree, -1, -1):
        total = total * z + line[n]
    return total


@njit(cache=True, error_model="numpy", _nrt=False)
def set_in_space_at_many(solid, start, degree, x, y, z, count, row, level, out, slope):
    """Write a polynomial in x, y, z at `count` places to `out`, and its slope along z to `slope`.

    `row` and `level` are scratch.
    """
    for v in range(count):
        out[v] = slope[v] = 0.0
    i = start + size_in_space(degree)
    for p in range(degree, -1, -1):
        i = set_at_many(solid, i, degree - p, x, y, count, row, level)
        for v in range(count):
            slope[v] = slope[v] * z[v] + out[v]
            out[v] = out[v] * z[v] + level[v]


@njit(cache=True, error_model="numpy", inline="always")
def set_at_many(flat, end, degree, x, y, count, row, total):
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


@njit(cache=True, error_model="numpy", _nrt=False)
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

"""Polynomials in x, y and in x, y, z, whose coefficients stand one after the other in an array.

The coefficients of x^m y^n stand in order of m, then n; those of z^p x^m y^n of p, then m, then n.

Where the degree is a constant the compiler unrolls Horner's rule, and a loop over places takes
several of them at once.
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


@njit(cache=True, error_model="numpy", inline="always")
def in_plane(flat, start, degree, x, y):
    """A polynomial in x, y, by Horner's rule, whose coefficients stand from `start` on."""
    i, total = start + size(degree), 0.0
    for m in range(degree, -1, -1):
        row = 0.0
        for _ in range(degree - m + 1):
            i -= 1
            row = row * y + flat[i]
        total = total * x + row
    return total


@njit(cache=True, error_model="numpy", inline="always")
def in_space(solid, start, degree, x, y, z):
    """A polynomial in x, y, z, by Horner's rule, whose coefficients stand from `start` on."""
    i, total = start + size_in_space(degree), 0.0
    for p in range(degree, -1, -1):
        level = 0.0
        for m in range(degree - p, -1, -1):
            row = 0.0
            for _ in range(degree - p - m + 1):
                i -= 1
                row = row * y + solid[i]
            level = level * x + row
        total = total * z + level
    return total


@njit(cache=True, error_model="numpy", _nrt=False)
def differentiate(solid, start, degree, out):
    """Write the derivative along z of a polynomial, from `start` on, to the begin of `out`."""
    i, n = start + size(degree), 0
    for p in range(1, degree + 1):
        for _ in range(size(degree - p)):
            out[n] = p * solid[i]
            i += 1
            n += 1


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

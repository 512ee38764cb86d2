"""Vectors of three numbers, as tuples, and rotations: row-major (9,), world_from_frame for a frame.

An array of places and a rotation make a frame: its origin in the world, and how it is turned there.
"""

import math

from buoyancy_mj.kernels.compiling import njit


@njit(cache=True, error_model="numpy", inline="always")
def triple(rows, n, first):
    """Three numbers of a row, from column `first`."""
    return rows[n, first], rows[n, first + 1], rows[n, first + 2]


@njit(cache=True, error_model="numpy", inline="always")
def rotate(r, x, y, z):
    """A vector of a frame, in the world's axes."""
    return (
        r[0] * x + r[1] * y + r[2] * z,
        r[3] * x + r[4] * y + r[5] * z,
        r[6] * x + r[7] * y + r[8] * z,
    )


@njit(cache=True, error_model="numpy", inline="always")
def rotate_back(r, x, y, z):
    """A vector of the world, in the axes of a frame."""
    return (
        r[0] * x + r[3] * y + r[6] * z,
        r[1] * x + r[4] * y + r[7] * z,
        r[2] * x + r[5] * y + r[8] * z,
    )


@njit(cache=True, error_model="numpy", inline="always")
def place(origin, r, x, y, z):
    """A point of a frame, in the world."""
    tx, ty, tz = rotate(r, x, y, z)
    return origin[0] + tx, origin[1] + ty, origin[2] + tz


@njit(cache=True, error_model="numpy", inline="always")
def difference(p, q):
    """The way from q to p."""
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


@njit(cache=True, error_model="numpy", inline="always")
def between(p, q, share):
    """The point a share of the way from p to q."""
    return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2])


@njit(cache=True, error_model="numpy", inline="always")
def scale(factor, p):
    """A vector times a number."""
    return factor * p[0], factor * p[1], factor * p[2]


@njit(cache=True, error_model="numpy", inline="always")
def distance(p, q):
    """Distance of two points."""
    return math.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2)


@njit(cache=True, error_model="numpy")
def is_rotation(r):
    """Whether a matrix (3, 3) only turns, to one part in a million: no stretch, no mirror."""
    for i in range(3):
        for j in range(i, 3):
            product = r[i, 0] * r[j, 0] + r[i, 1] * r[j, 1] + r[i, 2] * r[j, 2]
            if not abs(product - (1.0 if i == j else 0.0)) <= 1e-6:
                return False

    # the determinant, by the third row
    x = r[1, 1] * r[2, 2] - r[1, 2] * r[2, 1]
    y = r[1, 2] * r[2, 0] - r[1, 0] * r[2, 2]
    z = r[1, 0] * r[2, 1] - r[1, 1] * r[2, 0]
    return r[0, 0] * x + r[0, 1] * y + r[0, 2] * z > 0.0

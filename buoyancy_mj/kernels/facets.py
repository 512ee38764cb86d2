"""What flow does to flat faces: many at once, in rows that a processor takes several numbers of.

Faces are rows of numbers (8, f), in the frame of their hull: columns would scatter in memory what
is wanted together.
"""

import math

from buoyancy_mj.kernels.compiling import njit

MIDDLES, NORMALS, AREAS, FACE_ROWS = 0, 3, 6, 8
"""Rows of `DampingArrays.faces`, and how many: the middle (3) of each face [m], its unit normal
(3), and what of its area [m^2] is no other hull's of its body (`panels.ALONE`), and no other's of
all that welds hold to it (`panels.TOGETHER`)."""
BLOCK = 64
"""Faces that are summed at once, at most."""
PUSHES = 6
"""Rows of sums: force (3) and torque (3)."""


@njit(cache=True, error_model="numpy")
def add_push(
    faces,  # (8, f)
    start,  # the first of the faces
    stop,  # the one behind the last, at most BLOCK later
    areas,  # (stop - start,) what of each is wet [m^2]
    flow,  # velocity (3) of the origin through the water [m/s], and rotation (3) [rad/s]
    coefficients,  # of pressure on faces that lead, and that trail, and of friction
    sums,  # (6, BLOCK), added to: total
):
    """Add pressure and friction on faces over half the density [m^4/s^2], and their torques.

    They are those of `panels.add_panels`, at the middle of each face; the torques are about the
    origin. Each face of a block has its own column of sums, so that none waits for the one before.
    """
    (u0, u1, u2), (w0, w1, w2) = flow
    leading, trailing, friction = coefficients
    xs, ys, zs = faces[0, start:stop], faces[1, start:stop], faces[2, start:stop]
    n0s, n1s, n2s = faces[3, start:stop], faces[4, start:stop], faces[5, start:stop]
    flat = sums.reshape(PUSHES * BLOCK)
    for k in range(areas.shape[0]):
        x, y, z, n0, n1, n2 = xs[k], ys[k], zs[k], n0s[k], n1s[k], n2s[k]

        # the flow past the middle, along the normal and along the face
        ux = u0 + w1 * z - w2 * y
        uy = u1 + w2 * x - w0 * z
        uz = u2 + w0 * y - w1 * x
        into = ux * n0 + uy * n1 + uz * n2
        tx, ty, tz = ux - into * n0, uy - into * n1, uz - into * n2

        # friction, and pressure
        along = -areas[k] * friction * math.sqrt(tx * tx + ty * ty + tz * tz)
        square = -areas[k] * (leading if into > 0.0 else trailing) * abs(into) * into
        fx, fy, fz = along * tx + square * n0, along * ty + square * n1, along * tz + square * n2
        flat[k] += fx
        flat[BLOCK + k] += fy
        flat[2 * BLOCK + k] += fz
        flat[3 * BLOCK + k] += y * fz - z * fy
        flat[4 * BLOCK + k] += z * fx - x * fz
        flat[5 * BLOCK + k] += x * fy - y * fx


@njit(cache=True, error_model="numpy", inline="always")
def total(sums):
    """Force (3) and torque (3) of all columns of sums."""
    fx = fy = fz = tx = ty = tz = 0.0
    for k in range(BLOCK):
        fx, fy, fz = fx + sums[0, k], fy + sums[1, k], fz + sums[2, k]
        tx, ty, tz = tx + sums[3, k], ty + sums[4, k], tz + sums[5, k]
    return fx, fy, fz, tx, ty, tz

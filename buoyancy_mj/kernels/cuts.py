"""Triangles that the surface cuts, many side by side, so that the processor sums several at once.

Two edges of a cut triangle meet the surface. Their common corner is alone on its side, and the part
of the triangle there is again a triangle: it is what is wet, or what is wet if all were is less by
it. Here it counts so, with its sign.

A corner has its place x, y seen from above, its depth d under the plane that a hull is cut by, and
its depth w under the surface. All is from the middle of the hull, along the world's axes.
"""

from typing import NamedTuple

from buoyancy_mj.kernels.compiling import inlined, njit

MOST = 64
"""How many cut triangles wait at most until they are summed."""
_X, _Y, _D, _W, _CORNER = 0, MOST, 2 * MOST, 3 * MOST, 4 * MOST
_SIZE = 3 * _CORNER
ROOM = _SIZE + MOST
"""Numbers of the room in which they wait: `MOST` for each of the four columns of each corner, the
lone one first, and for the areas of the faces."""
P_X, P_Y, Q_X, Q_Y = 0, MOST, 2 * MOST, 3 * MOST
"""Where the ends p and q of the cuts stand after `sum_cuts`, seen from above; the waterplane lies
to the left of the way from p to q."""
_SUMS = 4 * MOST


class Sums(NamedTuple):
    """Integrals over what is wet of triangles; n_z dA is their area seen from above."""

    volume: float
    """Of d n_z dA [m^3]."""
    x: float
    """Of x d n_z dA [m^4]."""
    y: float
    """Of y d n_z dA [m^4]."""
    square: float
    """Of d^2 n_z dA [m^4]."""
    above: float
    """Of n_z dA [m^2]."""
    area: float
    """Of dA [m^2]."""
    outline_x: float
    """First moment of the waterplane over the cuts, along x [m^3]."""
    outline_y: float
    """The same along y [m^3]."""


@inlined
def nothing():
    """Sums of no triangles."""
    return Sums(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def add(sums, more):
    """Sums, and those of more triangles."""
    return Sums(
        sums[0] + more[0],
        sums[1] + more[1],
        sums[2] + more[2],
        sums[3] + more[3],
        sums[4] + more[4],
        sums[5] + more[5],
        sums[6] + more[6],
        sums[7] + more[7],
    )


@inlined
def subtract(sums, less):
    """Sums without those of triangles among them."""
    return Sums(
        sums[0] - less[0],
        sums[1] - less[1],
        sums[2] - less[2],
        sums[3] - less[3],
        sums[4] - less[4],
        sums[5] - less[5],
        sums[6] - less[6],
        sums[7] - less[7],
    )


@inlined
def set_corner(cuts, corner, n, x, y, d, w):
    """Write a corner of the n-th triangle that waits, 0 for the lone one."""
    at = corner * _CORNER + n
    cuts[at + _X], cuts[at + _Y], cuts[at + _D], cuts[at + _W] = x, y, d, w


@inlined
def set_size(cuts, n, size):
    """Write the area of the n-th triangle that waits."""
    cuts[_SIZE + n] = size


@njit(cache=True, error_model="numpy", _nrt=False)
def sum_cuts(cuts, count):
    """Sum the triangles that wait; then their ends stand in the room instead of them."""
    for n in range(count):
        # the lone corner, and the ways from it to where its two edges meet the surface
        x, y, d, w = cuts[_X + n], cuts[_Y + n], cuts[_D + n], cuts[_W + n]
        s = w / (w - cuts[_CORNER + _W + n])
        t = w / (w - cuts[2 * _CORNER + _W + n])
        px, qx = s * (cuts[_CORNER + _X + n] - x), t * (cuts[2 * _CORNER + _X + n] - x)
        py, qy = s * (cuts[_CORNER + _Y + n] - y), t * (cuts[2 * _CORNER + _Y + n] - y)
        pd, qd = s * (cuts[_CORNER + _D + n] - d), t * (cuts[2 * _CORNER + _D + n] - d)

        # the integrals, as in `triangles.moments`; those of x and y about the lone corner
        sign = 1.0 if w > 0.0 else -1.0
        area = sign * cuts[_SIZE + n] * (s * t)
        above = 0.5 * sign * (px * qy - qx * py)
        total, twelfth = 3.0 * d + (pd + qd), above * (1.0 / 12.0)
        volume = above * (1.0 / 3.0) * total
        p, q = d + pd, d + qd
        cuts[_SUMS + n] = volume
        cuts[_SUMS + MOST + n] = x * volume + twelfth * (total * (px + qx) + p * px + q * qx)
        cuts[_SUMS + 2 * MOST + n] = y * volume + twelfth * (total * (py + qy) + p * py + q * qy)
        cuts[_SUMS + 3 * MOST + n] = twelfth * (total * total + d * d + p * p + q * q)
        cuts[_SUMS + 4 * MOST + n] = above
        cuts[_SUMS + 5 * MOST + n] = area

        # the ends
        px, py, qx, qy = px + x, py + y, qx + x, qy + y
        wet = w > 0.0
        cuts[P_X + n], cuts[Q_X + n] = qx if wet else px, px if wet else qx
        cuts[P_Y + n], cuts[Q_Y + n] = qy if wet else py, py if wet else qy
        sixth = sign * (qx * py - qy * px) * (1.0 / 6.0)
        cuts[_SUMS + 6 * MOST + n] = sixth * (px + qx)
        cuts[_SUMS + 7 * MOST + n] = sixth * (py + qy)

    v = x = y = square = above = area = ax = ay = 0.0
    for n in range(count):
        v += cuts[_SUMS + n]
        x += cuts[_SUMS + MOST + n]
        y += cuts[_SUMS + 2 * MOST + n]
        square += cuts[_SUMS + 3 * MOST + n]
        above += cuts[_SUMS + 4 * MOST + n]
        area += cuts[_SUMS + 5 * MOST + n]
        ax += cuts[_SUMS + 6 * MOST + n]
        ay += cuts[_SUMS + 7 * MOST + n]
    return Sums(v, x, y, square, above, area, ax, ay)

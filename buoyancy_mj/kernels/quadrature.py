"""Pressure over triangles, summed by rules at points.

The points are gathered, so that the processor works on several at once.

A triangle is a tuple of three corners, from the still level, and its vector area. One that is small
beside the waves needs one point or three; larger ones are divided into pieces with the rule of
degree 5 of Radon (1948).
"""

import math
from typing import NamedTuple

from buoyancy_mj.kernels import local
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.local import HEAD, ROOM, heads
from buoyancy_mj.kernels.triangles import lone_corner, turn
from buoyancy_mj.kernels.vectors import between, distance, scale

POINT = 0.1
"""Longest edge of a triangle, times the wave number, for one point: to POINT^2 / 36."""
TINY = 0.3
"""Longest edge of a triangle, times the wave number, for three points: to TINY^3 / 200."""
PIECE = 1.5
"""Longest edge of a piece of a triangle, times the wave number."""
PIECES = 32
"""Most of them along an edge."""
PLACES = 208
"""Places at which the pressure is found at once: 69 triangles, or 16 nodes."""
_ROOT = math.sqrt(15.0)
_A, _B = (6.0 - _ROOT) / 21.0, (6.0 + _ROOT) / 21.0
_RULE = (
    (1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0),
    (_A, _A, (155.0 - _ROOT) / 1200.0),
    (1.0 - 2.0 * _A, _A, (155.0 - _ROOT) / 1200.0),
    (_A, 1.0 - 2.0 * _A, (155.0 - _ROOT) / 1200.0),
    (_B, _B, (155.0 + _ROOT) / 1200.0),
    (1.0 - 2.0 * _B, _B, (155.0 + _ROOT) / 1200.0),
    (_B, 1.0 - 2.0 * _B, (155.0 + _ROOT) / 1200.0),
)
"""Barycentric coordinates of the first and the second corner, and weights."""


class Setting(NamedTuple):
    """How pressure is summed over one hull."""

    origin: tuple[float, float, float]
    """Of the hull's frame, from the still level [m]."""
    time: float
    """[s]."""
    dynamic: bool
    """Whether the pressure is that of linear waves, or hydrostatic under their surface."""


@njit(cache=True, error_model="numpy")
def add_wet_part(points, count, near, setting, sums, p, q, o, dp, dq, do, area, most):
    """Add the wet part of a triangle with depths at its corners.

    Args:
        points: a room of `local` for `PLACES`, and the vector area of each point in three more
            rows.
        count: how many points wait there.
        near: the waves around the hull, see `local.gather`.
        setting: a `Setting`.
        sums: force over rho g [m^3], and torque about the origin over rho g [m^4] (6,); written.
        p: a corner.
        q: the next one.
        o: the last one.
        dp: depth of p.
        dq: depth of q.
        do: depth of o.
        area: the vector area.
        most: the largest wave number.

    Returns:
        How many points wait then.
    """
    wp, wq, wo = dp > 0.0, dq > 0.0, do > 0.0
    if wp and wq and wo:
        return _add_triangle(points, count, near, setting, sums, p, q, o, area, most)

    # turn the triangle so that p is alone on its side
    first = lone_corner(wp, wq, wo)
    p, q, o = turn(first, p, q, o)
    dp, dq, do = turn(first, dp, dq, do)

    # a triangle is wet, or a quadrangle: two triangles
    s, t = dp / (dp - dq), dp / (dp - do)
    a, b = between(p, q, s), between(p, o, t)
    if dp > 0.0:
        return _add_triangle(points, count, near, setting, sums, p, a, b, scale(s * t, area), most)
    count = _add_triangle(points, count, near, setting, sums, a, q, o, scale(1.0 - s, area), most)
    return _add_triangle(
        points, count, near, setting, sums, a, o, b, scale(s * (1.0 - t), area), most
    )


@njit(cache=True, error_model="numpy")
def _add_triangle(points, count, near, setting, sums, p, q, o, area, most):
    """Add the points of a rule over a wet triangle, with their shares of its area.

    Returns how many points wait then.

    Where there are more than the room holds, those that wait are summed.
    """
    longest = max(distance(p, q), distance(q, o), distance(o, p))
    if most * longest <= POINT:
        return _add_point(points, count, near, setting, sums, p, q, o, area)
    if most * longest <= TINY:
        return _add_edges(points, count, near, setting, sums, p, q, o, area)
    n = min(max(1, math.ceil(most * longest / PIECE)), PIECES)
    return _add_pieces(points, count, near, setting, sums, p, q, o, area, n)


@njit(cache=True, error_model="numpy", inline="always")
def _add_point(points, count, near, setting, sums, p, q, o, area):
    """Add the middle of a triangle."""
    if count == PLACES:
        count = sum_points(points, count, near, setting, sums)
    x, y, z = (p[0] + q[0] + o[0]) / 3.0, (p[1] + q[1] + o[1]) / 3.0, (p[2] + q[2] + o[2]) / 3.0
    _put(points, count, near, x, y, z, 1.0, area)

    # the depth in it changes, which turns it
    dp, dq, do = (z - p[2]) / 12.0, (z - q[2]) / 12.0, (z - o[2]) / 12.0
    mx = dp * (p[0] - x) + dq * (q[0] - x) + do * (o[0] - x)
    my = dp * (p[1] - y) + dq * (q[1] - y) + do * (o[1] - y)
    mz = dp * (p[2] - z) + dq * (q[2] - z) + do * (o[2] - z)
    sums[3] += my * area[2] - mz * area[1]
    sums[4] += mz * area[0] - mx * area[2]
    sums[5] += mx * area[1] - my * area[0]
    return count + 1


@njit(cache=True, error_model="numpy", inline="always")
def _add_edges(points, count, near, setting, sums, p, q, o, area):
    """Add the middles of the edges of a triangle: exact for quadratics."""
    if count > PLACES - 3:
        count = sum_points(points, count, near, setting, sums)
    _put_middle(points, count, near, p, q, area)
    _put_middle(points, count + 1, near, q, o, area)
    _put_middle(points, count + 2, near, o, p, area)
    return count + 3


@njit(cache=True, error_model="numpy", inline="always")
def _put_middle(points, n, near, p, q, area):
    """Add the middle of an edge, with a third of the area."""
    x, y, z = 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])
    _put(points, n, near, x, y, z, 1.0 / 3.0, area)


@njit(cache=True, error_model="numpy", inline="always")
def _add_pieces(points, count, near, setting, sums, p, q, o, area, n):
    """Add the points of Radon's rule over n^2 pieces of a triangle."""
    for i in range(n):
        for j in range(n - i):
            # the upright piece, and beside it the one upside down
            for flipped in range(2 if j < n - i - 1 else 1):
                if count > PLACES - len(_RULE):
                    count = sum_points(points, count, near, setting, sums)
                for first, second, weight in _RULE:
                    s, t = (i + first) / n, (j + second) / n
                    if flipped:
                        s, t = (i + 1 - first) / n, (j + 1 - second) / n
                    u = 1.0 - s - t
                    x = s * p[0] + t * q[0] + u * o[0]
                    y = s * p[1] + t * q[1] + u * o[1]
                    z = s * p[2] + t * q[2] + u * o[2]
                    _put(points, count, near, x, y, z, weight / (n * n), area)
                    count += 1
    return count


@njit(cache=True, error_model="numpy", inline="always")
def _put(points, n, near, x, y, z, share, area):
    """Let a point wait, with a share of an area."""
    points[0, n], points[1, n], points[2, n] = x - near[local.X], y - near[local.Y], z
    for c in range(3):
        points[ROOM + c, n] = share * area[c]


@njit(cache=True, error_model="numpy")
def sum_points(points, count, near, setting, sums):
    """Add force and torque about the origin of all points that wait; returns 0, for none wait."""
    heads(near, points, count, setting.time, setting.dynamic)
    ox, oy = setting.origin[0] - near[local.X], setting.origin[1] - near[local.Y]
    oz = setting.origin[2]
    for n in range(count):
        head = points[HEAD, n]
        fx, fy, fz = head * points[ROOM, n], head * points[ROOM + 1, n], head * points[ROOM + 2, n]
        x, y, z = points[0, n] - ox, points[1, n] - oy, points[2, n] - oz
        sums[0] += fx
        sums[1] += fy
        sums[2] += fz
        sums[3] += y * fz - z * fy
        sums[4] += z * fx - x * fz
        sums[5] += x * fy - y * fx
    return 0

"""Pressure over areas, summed by rules at points, which are gathered and summed together.

Nodes of the tree have rules of their own, see `rules`.

A triangle is a tuple of three corners, from the still level, and its vector area. One that is small
beside the waves needs one point or three; larger ones are divided into pieces with the rule of
degree 5 of Radon (1948).
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.heads import HEAD, set_heads
from buoyancy_mj.kernels.triangles import lone_corner, turn
from buoyancy_mj.kernels.vectors import between, distance, scale

POINT = 0.1
"""Longest edge of a triangle, times the wave number, for one point: to POINT^2 / 36."""
TINY = 0.2
"""Longest edge of a triangle, times the wave number, for three points: to TINY^3 / 200."""
PIECE = 1.5
"""Longest edge of a piece of a triangle, times the wave number."""
PIECES = 32
"""Most of them along an edge."""
TRIANGLE = 2 * 7 * PIECES * PIECES
"""Points of the wet part of a triangle, at most."""
PLACES = 2 * TRIANGLE
"""Points that may wait."""
AREA = HEAD + 1
"""First row of their vector areas, behind those of `heads.set_heads`."""
_ROOT = math.sqrt(15.0)
_A, _B = (6.0 - _ROOT) / 21.0, (6.0 + _ROOT) / 21.0
RULE = (
    (1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0),
    (_A, _A, (155.0 - _ROOT) / 1200.0),
    (1.0 - 2.0 * _A, _A, (155.0 - _ROOT) / 1200.0),
    (_A, 1.0 - 2.0 * _A, (155.0 - _ROOT) / 1200.0),
    (_B, _B, (155.0 + _ROOT) / 1200.0),
    (1.0 - 2.0 * _B, _B, (155.0 + _ROOT) / 1200.0),
    (_B, 1.0 - 2.0 * _B, (155.0 + _ROOT) / 1200.0),
)
"""Barycentric coordinates of the first and the second corner, and weights: exact to degree 5."""


@njit(cache=True, error_model="numpy", _nrt=False)
def add_wet_part(points, count, p, q, o, dp, dq, do, area, most, sums):
    """Add the points of the wet part of a triangle with depths at its corners.

    Args:
        points: places, as rows of `heads.set_heads` (4, PLACES), and vector areas (3, PLACES) of
            points that wait to be summed; written.
        count: how many wait; there is room for `TRIANGLE` more.
        p: a corner.
        q: the next one.
        o: the last one.
        dp: depth of p.
        dq: depth of q.
        do: depth of o.
        area: the vector area.
        most: the largest wave number.
        sums: force over rho g [m^3], and torque about the origin over rho g [m^4] (6,); what the
            points leave out is added.

    Returns:
        How many points wait then.
    """
    wp, wq, wo = dp > 0.0, dq > 0.0, do > 0.0
    if wp and wq and wo:
        return _add_triangle(points, count, p, q, o, area, most, sums)

    # turn the triangle so that p is alone on its side
    first = lone_corner(wp, wq, wo)
    p, q, o = turn(first, p, q, o)
    dp, dq, do = turn(first, dp, dq, do)

    # a triangle is wet, or a quadrangle: two triangles
    s, t = dp / (dp - dq), dp / (dp - do)
    a, b = between(p, q, s), between(p, o, t)
    if dp > 0.0:
        return _add_triangle(points, count, p, a, b, scale(s * t, area), most, sums)
    count = _add_triangle(points, count, a, q, o, scale(1.0 - s, area), most, sums)
    return _add_triangle(points, count, a, o, b, scale(s * (1.0 - t), area), most, sums)


@njit(cache=True, error_model="numpy", _nrt=False)
def _add_triangle(points, count, p, q, o, area, most, sums):
    """Add the points of a rule over a wet triangle, with their shares of its area."""
    longest = most * max(distance(p, q), distance(q, o), distance(o, p))
    if longest <= POINT:
        x, y, z = _blend(p, q, o, 1.0 / 3.0, 1.0 / 3.0)
        _put(points, count, (x, y, z), 1.0, area)

        # the depth in it changes, which turns it
        dp, dq, do = (z - p[2]) / 12.0, (z - q[2]) / 12.0, (z - o[2]) / 12.0
        mx = dp * (p[0] - x) + dq * (q[0] - x) + do * (o[0] - x)
        my = dp * (p[1] - y) + dq * (q[1] - y) + do * (o[1] - y)
        mz = dp * (p[2] - z) + dq * (q[2] - z) + do * (o[2] - z)
        sums[3] += my * area[2] - mz * area[1]
        sums[4] += mz * area[0] - mx * area[2]
        sums[5] += mx * area[1] - my * area[0]
        return count + 1
    if longest <= TINY:
        # the middles of the edges: exact for quadratics
        _put(points, count, between(p, q, 0.5), 1.0 / 3.0, area)
        _put(points, count + 1, between(q, o, 0.5), 1.0 / 3.0, area)
        _put(points, count + 2, between(o, p, 0.5), 1.0 / 3.0, area)
        return count + 3
    n = min(max(1, math.ceil(longest / PIECE)), PIECES)
    for i in range(n):
        for j in range(n - i):
            # the upright piece, and beside it the one upside down
            for flipped in range(2 if j < n - i - 1 else 1):
                for first, second, weight in RULE:
                    s, t = (i + first) / n, (j + second) / n
                    if flipped:
                        s, t = (i + 1 - first) / n, (j + 1 - second) / n
                    _put(points, count, _blend(p, q, o, s, t), weight / (n * n), area)
                    count += 1
    return count


@njit(cache=True, error_model="numpy", inline="always")
def _blend(p, q, o, s, t):
    """The point of a triangle with two barycentric coordinates."""
    u = 1.0 - s - t
    return (
        s * p[0] + t * q[0] + u * o[0],
        s * p[1] + t * q[1] + u * o[1],
        s * p[2] + t * q[2] + u * o[2],
    )


@njit(cache=True, error_model="numpy", inline="always")
def _put(points, n, place, share, area):
    """Let a point wait, with a share of an area."""
    for c in range(3):
        points[c, n] = place[c]
        points[AREA + c, n] = share * area[c]


@njit(cache=True, error_model="numpy", _nrt=False, fastmath={"reassoc", "contract"})
def sum_points(sea, points, count, origin, sums):
    """Add force and torque about the origin of the pressure at all points that wait.

    Args:
        sea: a `heads.Sea`.
        points: see `add_wet_part`.
        count: how many wait.
        origin: of the hull's frame, from the still level.
        sums: see `add_wet_part`; written.

    Returns:
        0, for none waits any more.
    """
    set_heads(sea, points, count)
    ox, oy, oz = origin
    force_x = force_y = force_z = torque_x = torque_y = torque_z = 0.0
    for n in range(count):
        head = points[HEAD, n]
        fx, fy, fz = head * points[AREA, n], head * points[AREA + 1, n], head * points[AREA + 2, n]
        x, y, z = points[0, n] - ox, points[1, n] - oy, points[2, n] - oz
        force_x += fx
        force_y += fy
        force_z += fz
        torque_x += y * fz - z * fy
        torque_y += z * fx - x * fz
        torque_z += x * fy - y * fx
    for i, more in enumerate((force_x, force_y, force_z, torque_x, torque_y, torque_z)):
        sums[i] += more
    return 0

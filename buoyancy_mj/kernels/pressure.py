"""The water's pressure in waves, integrated over the wet side of hulls: forces and torques.

By a tree of moments: a wet node that is small beside the waves is answered by its moments, with the
pressure as a quadratic about its middle; elsewhere triangles are cut at the surface and summed by a
rule of degree 5 (Radon 1948), in pieces no longer than `PIECE` over the largest wave number. The
places at which the pressure is needed are gathered, so that the processor works on several at once.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from buoyancy_mj.kernels import local
from buoyancy_mj.kernels.clip import placed
from buoyancy_mj.kernels.local import HEAD, ROOM, elevations, gather, heads, surface
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.kernels.waves import swing

SMALL = 0.3
"""Half the diagonal of a node, times the typical wave number, for which moments do: to SMALL^3 / 6 of the pressure."""
POINT = 0.1
"""Longest edge of a triangle, times the wave number, for which one point is enough, to POINT^2 / 36."""
TINY = 0.3
"""Longest edge of a triangle, times the wave number, for which three points are enough, to TINY^3 / 200."""
PIECE = 1.5
"""Longest edge of a piece of a triangle, times the wave number."""
PIECES = 32
"""Most of them along an edge."""
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
_STENCIL = (
    (0.0, 0.0, 0.0),
    (1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0),
    (1.0, 1.0, 0.0), (-1.0, -1.0, 0.0), (1.0, 0.0, 1.0), (-1.0, 0.0, -1.0), (0.0, 1.0, 1.0), (0.0, -1.0, -1.0),
)  # fmt: skip
"""Places in a node at which a quadratic is known by its values."""
PLACES = 208
"""At which the pressure is found at once: 16 nodes, or 69 triangles."""
DEPTHS = 16
"""For which the typical wave number is known."""


@njit(cache=True, error_model="numpy")
def _strew(p, q, o, area, points, count, sea, origin, time, dynamic, most, sums):
    """Add the points of a rule over a triangle, from the still level, with their shares of its area; count them.

    When there are more than the room holds, those that wait are summed.
    """
    longest = max(_length(p, q), _length(q, o), _length(o, p))
    if most * longest <= POINT:
        if count == PLACES:
            count = _sum_up(points, count, sea, origin, time, dynamic, sums)
        x, y, z = (p[0] + q[0] + o[0]) / 3.0, (p[1] + q[1] + o[1]) / 3.0, (p[2] + q[2] + o[2]) / 3.0
        _put(points, count, sea, x, y, z, 1.0, area)
        # the depth in it changes, which turns it
        dp, dq, do = (z - p[2]) / 12.0, (z - q[2]) / 12.0, (z - o[2]) / 12.0
        mx = dp * (p[0] - x) + dq * (q[0] - x) + do * (o[0] - x)
        my = dp * (p[1] - y) + dq * (q[1] - y) + do * (o[1] - y)
        mz = dp * (p[2] - z) + dq * (q[2] - z) + do * (o[2] - z)
        sums[3] += my * area[2] - mz * area[1]
        sums[4] += mz * area[0] - mx * area[2]
        sums[5] += mx * area[1] - my * area[0]
        return count + 1
    if most * longest <= TINY:
        # the middles of the edges, exact for quadratics
        if count > PLACES - 3:
            count = _sum_up(points, count, sea, origin, time, dynamic, sums)
        _put(
            points,
            count,
            sea,
            0.5 * (p[0] + q[0]),
            0.5 * (p[1] + q[1]),
            0.5 * (p[2] + q[2]),
            1.0 / 3.0,
            area,
        )
        _put(
            points,
            count + 1,
            sea,
            0.5 * (q[0] + o[0]),
            0.5 * (q[1] + o[1]),
            0.5 * (q[2] + o[2]),
            1.0 / 3.0,
            area,
        )
        _put(
            points,
            count + 2,
            sea,
            0.5 * (o[0] + p[0]),
            0.5 * (o[1] + p[1]),
            0.5 * (o[2] + p[2]),
            1.0 / 3.0,
            area,
        )
        return count + 3
    n = min(max(1, math.ceil(most * longest / PIECE)), PIECES)
    for i in range(n):
        for j in range(n - i):
            # the upright piece, and beside it the one upside down
            for flipped in range(2 if j < n - i - 1 else 1):
                if count > PLACES - len(_RULE):
                    count = _sum_up(points, count, sea, origin, time, dynamic, sums)
                for first, second, weight in _RULE:
                    s, t = (i + first) / n, (j + second) / n
                    if flipped:
                        s, t = (i + 1 - first) / n, (j + 1 - second) / n
                    u = 1.0 - s - t
                    x, y, z = (
                        s * p[0] + t * q[0] + u * o[0],
                        s * p[1] + t * q[1] + u * o[1],
                        s * p[2] + t * q[2] + u * o[2],
                    )
                    _put(points, count, sea, x, y, z, weight / (n * n), area)
                    count += 1
    return count


@njit(cache=True, error_model="numpy", inline="always")
def _put(points, n, sea, x, y, z, share, area):
    points[0, n], points[1, n], points[2, n] = x - sea[local.X], y - sea[local.Y], z
    for c in range(3):
        points[ROOM + c, n] = share * area[c]


@njit(cache=True, error_model="numpy")
def _sum_up(points, count, sea, origin, time, dynamic, sums):
    """Add force and torque about the origin of all points that wait; none are left."""
    heads(sea, points, count, time, dynamic)
    ox, oy, oz = origin[0] - sea[local.X], origin[1] - sea[local.Y], origin[2]
    for n in range(count):
        fx, fy, fz = _part(
            points[HEAD, n], (points[ROOM, n], points[ROOM + 1, n], points[ROOM + 2, n])
        )
        x, y, z = points[0, n] - ox, points[1, n] - oy, points[2, n] - oz
        sums[0], sums[1], sums[2] = sums[0] + fx, sums[1] + fy, sums[2] + fz
        sums[3] += y * fz - z * fy
        sums[4] += z * fx - x * fz
        sums[5] += x * fy - y * fx
    return 0


@njit(cache=True, error_model="numpy", inline="always")
def _length(p, q):
    return math.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2)


@njit(cache=True, error_model="numpy", inline="always")
def _between(p, q, share):
    return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2])


@njit(cache=True, error_model="numpy")
def _strew_wet(p, q, o, dp, dq, do, area, points, count, sea, origin, time, dynamic, most, sums):
    """`_strew` over the wet part of a triangle with depths at its corners."""
    wp, wq, wo = dp > 0.0, dq > 0.0, do > 0.0
    if wp and wq and wo:
        return _strew(p, q, o, area, points, count, sea, origin, time, dynamic, most, sums)
    # turn it so that the first corner is alone on its side
    alone = int(wp) + int(wq) + int(wo) == 1
    if wq == alone and wp != alone and wo != alone:
        p, q, o, dp, dq, do = q, o, p, dq, do, dp
    elif wo == alone and wp != alone and wq != alone:
        p, q, o, dp, dq, do = o, p, q, do, dp, dq
    s, t = dp / (dp - dq), dp / (dp - do)
    a, b = _between(p, q, s), _between(p, o, t)
    if alone:
        return _strew(
            p, a, b, _part(s * t, area), points, count, sea, origin, time, dynamic, most, sums
        )
    count = _strew(
        a, q, o, _part(1.0 - s, area), points, count, sea, origin, time, dynamic, most, sums
    )
    return _strew(
        a, o, b, _part(s * (1.0 - t), area), points, count, sea, origin, time, dynamic, most, sums
    )


@njit(cache=True, error_model="numpy", inline="always")
def _part(share, area):
    return share * area[0], share * area[1], share * area[2]


@njit(cache=True, error_model="numpy")
def _ask(b, size, origin, r, level, sea, asked, first):
    """Put the places at which the head of a node is needed into a room."""
    s = size / math.sqrt(3.0)
    for n in range(len(_STENCIL)):
        i, j, k = _STENCIL[n]
        x, y, z = placed(origin, r, b[0] + s * i, b[1] + s * j, b[2] + s * k)
        asked[0, first + n], asked[1, first + n], asked[2, first + n] = (
            x - sea[local.X],
            y - sea[local.Y],
            z - level,
        )


@njit(cache=True, error_model="numpy")
def _node(m, b, head, first, sums):
    """Add force and torque of the head over a node with moments m about b, in its frame and about its origin.

    The heads at its places stand in a row from `first`.
    """
    s = math.sqrt((b[3] * b[3] + b[4] * b[4] + b[5] * b[5]) / 3.0)
    p, px, nx, py, ny = (
        head[first],
        head[first + 1],
        head[first + 2],
        head[first + 3],
        head[first + 4],
    )
    pz, nz = head[first + 5], head[first + 6]
    xy, xz = head[first + 7] + head[first + 8], head[first + 9] + head[first + 10]
    yz = head[first + 11] + head[first + 12]
    # its gradient, and half its second derivatives, those across once for both
    step, square = 0.5 / s, 0.5 / (s * s)
    g0, g1, g2 = step * (px - nx), step * (py - ny), step * (pz - nz)
    h00, h11, h22 = (
        square * (px + nx - 2.0 * p),
        square * (py + ny - 2.0 * p),
        square * (pz + nz - 2.0 * p),
    )
    h01 = square * (xy - px - nx - py - ny + 2.0 * p)
    h02 = square * (xz - px - nx - pz - nz + 2.0 * p)
    h12 = square * (yz - py - ny - pz - nz + 2.0 * p)
    f0 = _force(m, 0, p, g0, g1, g2, h00, h11, h22, h01, h02, h12)
    f1 = _force(m, 1, p, g0, g1, g2, h00, h11, h22, h01, h02, h12)
    f2 = _force(m, 2, p, g0, g1, g2, h00, h11, h22, h01, h02, h12)
    # the torque about b, to first order
    t0 = _lever(m, 1, 2, p, g0, g1, g2) - _lever(m, 2, 1, p, g0, g1, g2)
    t1 = _lever(m, 2, 0, p, g0, g1, g2) - _lever(m, 0, 2, p, g0, g1, g2)
    t2 = _lever(m, 0, 1, p, g0, g1, g2) - _lever(m, 1, 0, p, g0, g1, g2)
    sums[0], sums[1], sums[2] = sums[0] + f0, sums[1] + f1, sums[2] + f2
    sums[3] += t0 + b[1] * f2 - b[2] * f1
    sums[4] += t1 + b[2] * f0 - b[0] * f2
    sums[5] += t2 + b[0] * f1 - b[1] * f0


@njit(cache=True, error_model="numpy")
def _sum_up_nodes(moments, boxes, nodes, many, asked, sea, time, dynamic, sums):
    """Add what all nodes that wait have; none are left."""
    heads(sea, asked, many * len(_STENCIL), time, dynamic)
    for n in range(many):
        _node(moments[nodes[n]], boxes[nodes[n]], asked[HEAD], n * len(_STENCIL), sums)
    return 0


@njit(cache=True, error_model="numpy", inline="always")
def _force(m, c, p, g0, g1, g2, h00, h11, h22, h01, h02, h12):
    """Component c of the integral of a quadratic head over the area."""
    return (
        p * m[c] + g0 * m[3 + c] + g1 * m[6 + c] + g2 * m[9 + c]
        + h00 * m[12 + c] + h11 * m[15 + c] + h22 * m[18 + c] + h01 * m[21 + c] + h02 * m[24 + c] + h12 * m[27 + c]
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _lever(m, i, c, p, g0, g1, g2):
    """Integral of a linear head times coordinate i over component c of the area."""
    # rows of second moments: xx yy zz xy xz yz
    x = 12 if i == 0 else 21 if i == 1 else 24
    y = 21 if i == 0 else 15 if i == 1 else 27
    z = 24 if i == 0 else 27 if i == 1 else 18
    return p * m[3 + 3 * i + c] + g0 * m[x + c] + g1 * m[y + c] + g2 * m[z + c]


def typical(waves: NDArray[np.float64]) -> NDArray[np.float64]:
    """Wave numbers (DEPTHS,) [rad/m] of a single wave as high as all at the surface, whose third derivatives are as large.

    At depths of 0, 1, 2, ... over the first of them: the pressure of short waves fades soonest.
    """
    square, k = waves[:, 0] ** 2, np.hypot(waves[:, 1], waves[:, 2])
    if not square.sum() > 0.0 or not k.any():
        return np.zeros(DEPTHS)
    bent = square / square.sum() * k**6
    fades = np.exp(-2.0 * np.outer(np.arange(DEPTHS), k) / bent.sum() ** (1.0 / 6.0))
    numbers: NDArray[np.float64] = (fades @ bent) ** (1.0 / 6.0)
    return numbers


@njit(cache=True, error_model="numpy")
def press_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    depths,  # scratch
    out,  # (h, 6) force over rho g [m^3] and torque over rho g about the frame's origin [m^4], world frame
):
    """The pressure of the water on the wet side of each hull."""
    level, waves, dynamic = sea.level, sea.waves, sea.pressure == PressureModel.froude_krylov
    vertices, faces, areas, spans = hulls.vertices, hulls.faces, hulls.areas, hulls.spans
    boxes, moments, whole, frames = hulls.boxes, hulls.moments, hulls.whole, hulls.frames
    near = np.empty(local.NEAR + 6 * waves.shape[0])
    # rooms for the points of triangles, for what nodes ask, and for the corners in a leaf
    points, asked = np.empty((ROOM + 3, PLACES)), np.empty((ROOM, PLACES))
    corners = np.empty((ROOM, depths.shape[0]))
    waiting = np.empty(PLACES // len(_STENCIL), np.int64)
    sums, turned = np.empty(6), np.empty(6)
    for h in range(frames.shape[0]):
        origin, r = geoms.geom_xpos[frames[h]], geoms.geom_xmat[frames[h]]
        out[h, :] = 0.0
        # what is dry needs no waves
        x, y, z = placed(origin, r, whole[h, 5], whole[h, 6], whole[h, 7])
        radius = math.sqrt(whole[h, 8] ** 2 + whole[h, 9] ** 2 + whole[h, 10] ** 2)
        eta, spread, curvature = swing(waves, x, y, time, radius)
        if level + eta - z <= -radius - spread:
            continue
        gather(
            waves,
            x,
            y,
            z - level,
            eta,
            time,
            radius,
            int(whole[h, 12]),
            whole[h, 13],
            dynamic,
            near,
        )
        # triangles in the world, nodes in the frame; both about its origin
        sums[:], turned[:] = 0.0, 0.0
        base = (origin[0], origin[1], origin[2] - level)
        count = many = 0
        i, end = hulls.nodes[h], hulls.nodes[h + 1]
        while i < end:
            e0, e1, e2 = boxes[i, 3], boxes[i, 4], boxes[i, 5]
            x, y, z = placed(origin, r, boxes[i, 0], boxes[i, 1], boxes[i, 2])
            size = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
            eta, along, across = surface(near, x, y, time)
            # the depth of the middle of the box, and how much less or more any point of it has
            depth = level + eta - z
            h0 = along * r[0] + across * r[3] - r[6]
            h1 = along * r[1] + across * r[4] - r[7]
            h2 = along * r[2] + across * r[5] - r[8]
            reach = abs(h0) * e0 + abs(h1) * e1 + abs(h2) * e2 + 0.5 * curvature * size * size
            after = spans[i, 4]
            if depth <= -reach:
                i = after
                continue
            wet = depth >= reach
            most = hulls.typical[
                int(min((depth - reach) * hulls.typical[0], DEPTHS - 1.0)) if wet and dynamic else 0
            ]
            if wet and most * size <= SMALL and size > 0.0:
                if many == waiting.shape[0]:
                    many = _sum_up_nodes(
                        moments, boxes, waiting, many, asked, near, time, dynamic, turned
                    )
                _ask(boxes[i], size, origin, r, level, near, asked, many * len(_STENCIL))
                waiting[many] = i
                many += 1
                i = after
                continue
            if after > i + 1:
                i += 1
                continue
            first, last = spans[i, 2], spans[i, 3]
            for n in range(0 if wet else last - first):
                x, y, z = placed(
                    base, r, vertices[first + n, 0], vertices[first + n, 1], vertices[first + n, 2]
                )
                corners[0, n], corners[1, n], corners[2, n] = (
                    x - near[local.X],
                    y - near[local.Y],
                    z,
                )
            if not wet:
                elevations(near, corners, last - first, time)
            for n in range(last - first):
                depths[n] = 1.0 if wet else corners[HEAD, n] - corners[2, n]
            for f in range(spans[i, 0], spans[i, 1]):
                j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
                dj, dk, do = depths[j - first], depths[k - first], depths[o - first]
                if dj <= 0.0 and dk <= 0.0 and do <= 0.0:
                    continue
                p = placed(base, r, vertices[j, 0], vertices[j, 1], vertices[j, 2])
                q = placed(base, r, vertices[k, 0], vertices[k, 1], vertices[k, 2])
                s = placed(base, r, vertices[o, 0], vertices[o, 1], vertices[o, 2])
                area = _area(r, areas[f])
                count = _strew_wet(
                    p, q, s, dj, dk, do, area, points, count, near, base, time, dynamic, most, sums
                )
            i = after
        _sum_up(points, count, near, base, time, dynamic, sums)
        _sum_up_nodes(moments, boxes, waiting, many, asked, near, time, dynamic, turned)
        force, torque = (
            _area(r, (turned[0], turned[1], turned[2])),
            _area(r, (turned[3], turned[4], turned[5])),
        )
        for c in range(3):
            out[h, c], out[h, 3 + c] = -(sums[c] + force[c]), -(sums[3 + c] + torque[c])


@njit(cache=True, error_model="numpy", inline="always")
def _area(r, a):
    """A vector of a frame, in the world."""
    return (
        r[0] * a[0] + r[1] * a[1] + r[2] * a[2],
        r[3] * a[0] + r[4] * a[1] + r[5] * a[2],
        r[6] * a[0] + r[7] * a[1] + r[8] * a[2],
    )

"""The water's pressure in waves, integrated over the wet side of hulls: forces and torques.

By a tree of moments: a wet node that is small beside the waves is answered by its moments, with the
pressure as a quadratic about its middle; elsewhere triangles are cut at the surface and summed by a
rule of degree 5 (Radon 1948), in pieces no longer than `PIECE` over the largest wave number.
"""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels import local
from buoyancy_mj.kernels.clip import placed
from buoyancy_mj.kernels.local import gather, head, surface
from buoyancy_mj.kernels.waves import swing

SMALL = 0.3
"""Half the diagonal of a node, times the wave number, for which its moments are enough: to SMALL^3 / 6 of the pressure."""
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


@njit(cache=True, error_model="numpy")
def _mean(p, q, o, sea, time, dynamic, most):
    """Means over a triangle of the pressure head, and of it times place, from the still level."""
    longest = max(_length(p, q), _length(q, o), _length(o, p))
    if most * longest <= TINY:
        # the middles of the edges, exact for quadratics
        ax, ay, az = 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])
        bx, by, bz = 0.5 * (q[0] + o[0]), 0.5 * (q[1] + o[1]), 0.5 * (q[2] + o[2])
        cx, cy, cz = 0.5 * (o[0] + p[0]), 0.5 * (o[1] + p[1]), 0.5 * (o[2] + p[2])
        a = head(sea, ax, ay, az, time, dynamic) / 3.0
        b = head(sea, bx, by, bz, time, dynamic) / 3.0
        c = head(sea, cx, cy, cz, time, dynamic) / 3.0
        return a + b + c, a * ax + b * bx + c * cx, a * ay + b * by + c * cy, a * az + b * bz + c * cz
    n = min(max(1, math.ceil(most * longest / PIECE)), PIECES)
    m = mx = my = mz = 0.0
    for i in range(n):
        for j in range(n - i):
            # the upright piece, and beside it the one upside down
            for flipped in range(2 if j < n - i - 1 else 1):
                for first, second, weight in _RULE:
                    s, t = (i + first) / n, (j + second) / n
                    if flipped:
                        s, t = (i + 1 - first) / n, (j + 1 - second) / n
                    u = 1.0 - s - t
                    x, y, z = s * p[0] + t * q[0] + u * o[0], s * p[1] + t * q[1] + u * o[1], s * p[2] + t * q[2] + u * o[2]
                    share = weight * head(sea, x, y, z, time, dynamic)
                    m, mx, my, mz = m + share, mx + share * x, my + share * y, mz + share * z
    return m / (n * n), mx / (n * n), my / (n * n), mz / (n * n)


@njit(cache=True, error_model="numpy", inline="always")
def _length(p, q):
    return math.sqrt((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2)


@njit(cache=True, error_model="numpy", inline="always")
def _between(p, q, share):
    return p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), p[2] + share * (q[2] - p[2])


@njit(cache=True, error_model="numpy")
def _triangle(p, q, o, dp, dq, do, sea, time, dynamic, most):
    """`_mean` of the wet part of a triangle with depths at its corners, times the part that is wet."""
    wp, wq, wo = dp > 0.0, dq > 0.0, do > 0.0
    if wp and wq and wo:
        return _mean(p, q, o, sea, time, dynamic, most)
    # turn it so that the first corner is alone on its side
    alone = int(wp) + int(wq) + int(wo) == 1
    if wq == alone and wp != alone and wo != alone:
        p, q, o, dp, dq, do = q, o, p, dq, do, dp
    elif wo == alone and wp != alone and wq != alone:
        p, q, o, dp, dq, do = o, p, q, do, dp, dq
    s, t = dp / (dp - dq), dp / (dp - do)
    a, b = _between(p, q, s), _between(p, o, t)
    if alone:
        m = _mean(p, a, b, sea, time, dynamic, most)
        return s * t * m[0], s * t * m[1], s * t * m[2], s * t * m[3]
    one, two = _mean(a, q, o, sea, time, dynamic, most), _mean(a, o, b, sea, time, dynamic, most)
    f, g = 1.0 - s, s * (1.0 - t)
    return f * one[0] + g * two[0], f * one[1] + g * two[1], f * one[2] + g * two[2], f * one[3] + g * two[3]


@njit(cache=True, error_model="numpy")
def _head_at(b, s, x, y, z, origin, r, level, sea, time, dynamic):
    """Head at a place of a frame: steps x, y, z of size s from b."""
    wx, wy, wz = placed(origin, r, b[0] + s * x, b[1] + s * y, b[2] + s * z)
    return head(sea, wx, wy, wz - level, time, dynamic)


@njit(cache=True, error_model="numpy")
def _node(m, b, size, origin, r, level, sea, time, dynamic):
    """Force and torque of the head over a node with moments m about b, in its frame and about its origin."""
    s = size / math.sqrt(3.0)
    p = _head_at(b, s, 0.0, 0.0, 0.0, origin, r, level, sea, time, dynamic)
    px = _head_at(b, s, 1.0, 0.0, 0.0, origin, r, level, sea, time, dynamic)
    py = _head_at(b, s, 0.0, 1.0, 0.0, origin, r, level, sea, time, dynamic)
    pz = _head_at(b, s, 0.0, 0.0, 1.0, origin, r, level, sea, time, dynamic)
    nx = _head_at(b, s, -1.0, 0.0, 0.0, origin, r, level, sea, time, dynamic)
    ny = _head_at(b, s, 0.0, -1.0, 0.0, origin, r, level, sea, time, dynamic)
    nz = _head_at(b, s, 0.0, 0.0, -1.0, origin, r, level, sea, time, dynamic)
    xy = _head_at(b, s, 1.0, 1.0, 0.0, origin, r, level, sea, time, dynamic)
    xy += _head_at(b, s, -1.0, -1.0, 0.0, origin, r, level, sea, time, dynamic)
    xz = _head_at(b, s, 1.0, 0.0, 1.0, origin, r, level, sea, time, dynamic)
    xz += _head_at(b, s, -1.0, 0.0, -1.0, origin, r, level, sea, time, dynamic)
    yz = _head_at(b, s, 0.0, 1.0, 1.0, origin, r, level, sea, time, dynamic)
    yz += _head_at(b, s, 0.0, -1.0, -1.0, origin, r, level, sea, time, dynamic)
    # its gradient, and half its second derivatives, those across once for both
    step, square = 0.5 / s, 0.5 / (s * s)
    g0, g1, g2 = step * (px - nx), step * (py - ny), step * (pz - nz)
    h00, h11, h22 = square * (px + nx - 2.0 * p), square * (py + ny - 2.0 * p), square * (pz + nz - 2.0 * p)
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
    return f0, f1, f2, t0 + b[1] * f2 - b[2] * f1, t1 + b[2] * f0 - b[0] * f2, t2 + b[0] * f1 - b[1] * f0


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


@njit(cache=True, error_model="numpy")
def _typical(waves):
    """The wave number [rad/m] of a single wave of the same energy whose third derivatives are as large."""
    energy = bent = 0.0
    for i in range(waves.shape[0]):
        square = waves[i, 0] * waves[i, 0]
        energy, bent = energy + square, bent + square * math.hypot(waves[i, 1], waves[i, 2]) ** 6
    return (bent / energy) ** (1.0 / 6.0) if energy > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def press_hulls(
    vertices,  # as for `clip.submerge_hulls`
    faces,
    areas,
    nodes,
    spans,
    boxes,
    moments,
    whole,
    frames,
    positions,
    rotations,
    level,
    waves,
    time,
    dynamic,  # whether the pressure is that of linear waves, or hydrostatic under their surface
    depths,  # scratch
    out,  # (h, 6) force over rho g [m^3] and torque over rho g about the frame's origin [m^4], world frame
):
    """The pressure of the water on the wet side of each hull."""
    most = _typical(waves)
    sea = np.empty(local.NEAR + 6 * waves.shape[0])
    for h in range(frames.shape[0]):
        origin, r = positions[frames[h]], rotations[frames[h]]
        out[h, :] = 0.0
        # what is dry needs no waves
        x, y, z = placed(origin, r, whole[h, 5], whole[h, 6], whole[h, 7])
        radius = math.sqrt(whole[h, 8] ** 2 + whole[h, 9] ** 2 + whole[h, 10] ** 2)
        eta, spread = swing(waves, x, y, time, radius)
        if level + eta - z <= -radius - spread:
            continue
        steepest = spread / radius
        gather(waves, x, y, z - level, time, radius, dynamic, sea)
        fx = fy = fz = tx = ty = tz = 0.0
        f0 = f1 = f2 = t0 = t1 = t2 = 0.0
        i, end = nodes[h], nodes[h + 1]
        while i < end:
            e0, e1, e2 = boxes[i, 3], boxes[i, 4], boxes[i, 5]
            x, y, z = placed(origin, r, boxes[i, 0], boxes[i, 1], boxes[i, 2])
            size = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
            depth = level + surface(sea, x, y, time) - z
            reach = abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2 + steepest * size
            after = spans[i, 4]
            if depth <= -reach:
                i = after
                continue
            if depth >= reach and most * size <= SMALL and size > 0.0:
                some = _node(moments[i], boxes[i], size, origin, r, level, sea, time, dynamic)
                f0, f1, f2 = f0 + some[0], f1 + some[1], f2 + some[2]
                t0, t1, t2 = t0 + some[3], t1 + some[4], t2 + some[5]
                i = after
                continue
            if after > i + 1:
                i += 1
                continue
            base = spans[i, 2]
            for n in range(base, spans[i, 3]):
                x, y, z = placed(origin, r, vertices[n, 0], vertices[n, 1], vertices[n, 2])
                depths[n - base] = level + surface(sea, x, y, time) - z
            for f in range(spans[i, 0], spans[i, 1]):
                j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
                dj, dk, do = depths[j - base], depths[k - base], depths[o - base]
                if dj <= 0.0 and dk <= 0.0 and do <= 0.0:
                    continue
                p = placed((origin[0], origin[1], origin[2] - level), r, vertices[j, 0], vertices[j, 1], vertices[j, 2])
                q = placed((origin[0], origin[1], origin[2] - level), r, vertices[k, 0], vertices[k, 1], vertices[k, 2])
                s = placed((origin[0], origin[1], origin[2] - level), r, vertices[o, 0], vertices[o, 1], vertices[o, 2])
                m, mx, my, mz = _triangle(p, q, s, dj, dk, do, sea, time, dynamic, most)
                # from the frame's origin
                mx, my, mz = mx - origin[0] * m, my - origin[1] * m, mz - (origin[2] - level) * m
                ax, ay, az = _area(r, areas[f])
                fx, fy, fz = fx + m * ax, fy + m * ay, fz + m * az
                tx, ty, tz = tx + my * az - mz * ay, ty + mz * ax - mx * az, tz + mx * ay - my * ax
            i = after
        nx, ny, nz = _area(r, (f0, f1, f2))
        ux, uy, uz = _area(r, (t0, t1, t2))
        out[h, 0], out[h, 1], out[h, 2] = -(fx + nx), -(fy + ny), -(fz + nz)
        out[h, 3], out[h, 4], out[h, 5] = -(tx + ux), -(ty + uy), -(tz + uz)


@njit(cache=True, error_model="numpy", inline="always")
def _area(r, a):
    """A vector of a frame, in the world."""
    return (
        r[0] * a[0] + r[1] * a[1] + r[2] * a[2],
        r[3] * a[0] + r[4] * a[1] + r[5] * a[2],
        r[6] * a[0] + r[7] * a[1] + r[8] * a[2],
    )

"""The waves around one hull, in its own frame: a plane that touches the surface, and a rest.

The plane touches the surface over the middle of the hull.

The rest e(x, y) of the elevation is what the waves have beside that plane: the tiles of `tiles`, and
the near waves, which are taken one by one.
"""

import math
from typing import NamedTuple

from numba import njit

from buoyancy_mj.kernels import tiles
from buoyancy_mj.kernels.hulls import WHOLE_HALF, WHOLE_MIDDLE
from buoyancy_mj.kernels.series import bend, doublings
from buoyancy_mj.kernels.tiles import (
    AMPLITUDE,
    KX,
    KY,
    find_tile,
    four_elevations,
    tangent_in,
)
from buoyancy_mj.kernels.vectors import place, rotate, triple

CREST, SLOPE, K, K_WORLD, COLUMNS = 0, 1, 2, 5, 7
"""Columns of a near wave, and how many: A cos and A sin of its phase over the middle, its wave
vector in the hull's frame (3) and in the world's (2)."""

# Gauss-Legendre points and weights between 0 and 1
_ONE = ((0.5, 1.0),)
_TWO = ((0.5 - math.sqrt(1.0 / 12.0), 0.5), (0.5 + math.sqrt(1.0 / 12.0), 0.5))
_FOUR = (
    (0.06943184420297371, 0.17392742256872692),
    (0.33000947820757187, 0.32607257743127308),
    (0.66999052179242813, 0.32607257743127308),
    (0.93056815579702629, 0.17392742256872692),
)
PANEL = 2.0
"""Longest angle [rad] over which four points outward are enough, to 1e-6 of the amplitude."""
PANELS = 256
"""Most of them: no ripple is resolved that is shorter than a hundredth of the hull."""
SLIM = 1e-3
"""Square of the ends' distance, over that of their distances from the middle, for which one point
along a cut is enough."""


class Plane(NamedTuple):
    """The plane that touches the surface over the middle of a hull."""

    middle: tuple[float, float, float]
    """Of the hull's box, in its frame [m]."""
    depth: float
    """Of the middle under the plane [m]."""
    origin_depth: float
    """Of the origin of the hull's frame [m]."""
    gradient: tuple[float, float, float]
    """Of the depth, in the hull's frame."""
    height: float
    """Over the origin of the hull's frame, above the middle [m]."""
    slope: tuple[float, float]
    """Of that height along x and y of the world."""


class Rest(NamedTuple):
    """The rest of the elevation around a hull, but for its arrays.

    Those are the near waves, and the tiles.
    """

    near: int
    """How many waves are near."""
    smooth: bool
    """Whether tiles hold any wave."""
    doubled: int
    """How often angles between near waves and hull are halved, see `series.bend`."""
    turning: float
    """Wave number that says how finely a way is divided into panels [rad/m]."""
    place: tuple[float, float]
    """Of the middle of the hull along x and y of the world [m]."""
    touch: tuple[float, float, float]
    """Elevation of the tiles over the middle, and its gradient along x and y."""
    time: float
    """[s]."""


@njit(cache=True, error_model="numpy", inline="always")
def approach(level, layout, waves, found, phases, origin, r, whole, h, time, near):
    """Bring the waves to a hull, a row of `Hulls.whole`: a `Plane` and a `Rest`.

    Layout and waves are of `tiles.Tiles`, what was found of a `tiles.TileStore`; the near waves go
    to `near`.
    """
    c0, c1, c2 = triple(whole, h, WHOLE_MIDDLE)
    x, y, _ = place(origin, r, c0, c1, c2)
    touch, (eta, s0, s1, s2), count, change = _gather(layout, waves, found, phases, x, y, r, whole, h, time, near)

    # the plane, as the depth under it: d + g (x - c)
    g0, g1, g2 = s0 - r[6], s1 - r[7], s2 - r[8]
    height = level + eta - origin[2]
    d = height - (r[6] * c0 + r[7] * c1 + r[8] * c2)
    still = d - (g0 * c0 + g1 * c1 + g2 * c2)
    gx, gy, _ = rotate(r, s0, s1, s2)
    plane = Plane((c0, c1, c2), d, still, (g0, g1, g2), height, (gx, gy))

    # the rest
    smooth, turning = int(layout[tiles.HELD]) > 0, layout[tiles.TURNING]
    return plane, Rest(count, smooth, doublings(change), turning, (x, y), touch, time)


@njit(cache=True, error_model="numpy")
def _gather(layout, waves, found, phases, x, y, r, whole, h, time, near):
    """Bring the near waves to a hull, and find the plane over its middle.

    Returns the elevation of the tiles there, with its gradient in the world; that of all waves, with
    its gradient in the hull's frame; how many waves are near; and by how much the phase of any of
    them changes over the hull.
    """
    eta = gx = gy = g0 = g1 = g2 = steepest = 0.0
    held, count = int(layout[tiles.HELD]), waves.shape[1]
    if held > 0:
        t = find_tile(layout, waves, found, phases, x, y, time)
        eta, gx, gy = tangent_in(layout, found, t, x, y)
    touch = (eta, gx, gy)
    for w in range(held, count):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        phase = kx * x + ky * y - waves[tiles.OMEGA, w] * time + waves[tiles.PHASE, w]
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        steepest = max(steepest, math.sqrt(kx * kx + ky * ky))
        k0, k1, k2 = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
        n = w - held
        near[n, CREST], near[n, SLOPE] = crest, slope
        near[n, K], near[n, K + 1], near[n, K + 2] = k0, k1, k2
        near[n, K_WORLD], near[n, K_WORLD + 1] = kx, ky
        eta += crest
        g0 -= slope * k0
        g1 -= slope * k1
        g2 -= slope * k2
    g0, g1, g2 = g0 + gx * r[0] + gy * r[3], g1 + gx * r[1] + gy * r[4], g2 + gx * r[2] + gy * r[5]
    e0, e1, e2 = triple(whole, h, WHOLE_HALF)
    radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
    return touch, (eta, g0, g1, g2), count - held, steepest * radius


@njit(cache=True, error_model="numpy", inline="always")
def over_node(rest, r, layout, waves, found, phases, near, away):
    """The rest of the elevation over a place `away` from the middle of the hull, in its frame.

    Also its gradient there, in the frame of the hull.
    """
    e = s0 = s1 = s2 = 0.0
    if rest.smooth:
        x, y, _ = rotate(r, away[0], away[1], away[2])
        t = find_tile(layout, waves, found, phases, rest.place[0] + x, rest.place[1] + y, rest.time)
        e, sx, sy = tangent_in(layout, found, t, rest.place[0] + x, rest.place[1] + y)
        eta, gx, gy = rest.touch
        e -= eta + gx * x + gy * y
        sx, sy = sx - gx, sy - gy
        s0, s1, s2 = sx * r[0] + sy * r[3], sx * r[1] + sy * r[4], sx * r[2] + sy * r[5]
    for w in range(rest.near):
        crest, steep = near[w, CREST], near[w, SLOPE]
        k0, k1, k2 = triple(near, w, K)
        angle = k0 * away[0] + k1 * away[1] + k2 * away[2]
        sine, cosine = bend(angle, rest.doubled)
        e += crest * cosine - steep * sine
        change = -steep * cosine - crest * (sine + angle)
        s0, s1, s2 = s0 + change * k0, s1 + change * k1, s2 + change * k2
    return e, (s0, s1, s2)


@njit(cache=True, error_model="numpy", inline="always")
def depth_under(plane, point):
    """Depth under the plane of a point in the hull's frame."""
    g0, g1, g2 = plane.gradient
    return plane.origin_depth + g0 * point[0] + g1 * point[1] + g2 * point[2]


@njit(cache=True, error_model="numpy", inline="always")
def depth_away(plane, away):
    """Depth under the plane of a point that is `away` from the middle of the hull, in its frame."""
    g0, g1, g2 = plane.gradient
    return plane.depth + g0 * away[0] + g1 * away[1] + g2 * away[2]


@njit(cache=True, error_model="numpy", inline="always")
def set_depths(vertices, first, last, plane, depths):
    """Write the depths under the plane of vertices from `first` up to `last`."""
    for n in range(first, last):
        depths[n - first] = depth_under(plane, triple(vertices, n, 0))


@njit(cache=True, error_model="numpy")
def add_rest(vertices, first, last, middle, r, rest, layout, waves, found, phases, near, depths):
    """Add the rest to depths under the plane, of vertices from `first` up to `last`."""
    c0, c1, c2 = middle
    if rest.smooth:
        n = first
        while n < last:
            # four at once, the last ones more than once
            i, j, k = min(n + 1, last - 1), min(n + 2, last - 1), min(n + 3, last - 1)
            a = _seen(vertices, n, c0, c1, c2, r)
            b = _seen(vertices, i, c0, c1, c2, r)
            c = _seen(vertices, j, c0, c1, c2, r)
            d = _seen(vertices, k, c0, c1, c2, r)
            e = _four_rests(rest, layout, waves, found, phases, a, b, c, d)
            depths[n - first] += e[0]
            if n + 1 < last:
                depths[i - first] += e[1]
            if n + 2 < last:
                depths[j - first] += e[2]
            if n + 3 < last:
                depths[k - first] += e[3]
            n += 4
    for w in range(rest.near):
        crest, slope = near[w, CREST], near[w, SLOPE]
        k0, k1, k2 = triple(near, w, K)
        shift = k0 * c0 + k1 * c1 + k2 * c2
        for n in range(first, last):
            angle = k0 * vertices[n, 0] + k1 * vertices[n, 1] + k2 * vertices[n, 2] - shift
            sine, cosine = bend(angle, rest.doubled)
            depths[n - first] += crest * cosine - slope * sine


@njit(cache=True, error_model="numpy", inline="always")
def _seen(vertices, n, c0, c1, c2, r):
    """A vertex seen from above, from the middle of the hull."""
    x, y, _ = rotate(r, vertices[n, 0] - c0, vertices[n, 1] - c1, vertices[n, 2] - c2)
    return x, y


@njit(cache=True, error_model="numpy", inline="always")
def _four_rests(rest, layout, waves, found, phases, a, b, c, d):
    """What tiles have beside the plane at four places, from the middle of the hull."""
    (x, y), (eta, gx, gy) = rest.place, rest.touch
    e0, e1, e2, e3 = four_elevations(
        layout, waves, found, phases,
        (x + a[0], x + b[0], x + c[0], x + d[0]), (y + a[1], y + b[1], y + c[1], y + d[1]),
        rest.time,
    )  # fmt: skip
    return (
        e0 - (eta + gx * a[0] + gy * a[1]),
        e1 - (eta + gx * b[0] + gy * b[1]),
        e2 - (eta + gx * c[0] + gy * c[1]),
        e3 - (eta + gx * d[0] + gy * d[1]),
    )


@njit(cache=True, error_model="numpy", inline="always")
def seen_from_above(plane, r, p, q):
    """Two points of the hull's frame, seen from above, from the middle of the hull.

    Their coordinates are along x and y of the world.
    """
    c0, c1, c2 = plane.middle
    px, py, _ = rotate(r, p[0] - c0, p[1] - c1, p[2] - c2)
    qx, qy, _ = rotate(r, q[0] - c0, q[1] - c1, q[2] - c2)
    return px, py, qx, qy


@njit(cache=True, error_model="numpy")
def waterplane_moments(ends, height, slope, rest, layout, waves, found, phases, near):
    """Integrals of e, x e, y e and (plane + e / 2) e over a triangle of the waterplane.

    Its corners are the middle of the hull and the `ends` of a cut. The plane has the `height` over
    the middle, and the `slope`. All is seen from above. By Gauss outward, in panels of at most
    `PANEL` / k, and along the cut.
    """
    px, py, qx, qy = ends
    gx, gy = slope
    i0 = ix = iy = iz = 0.0
    p, q = px * px + py * py, qx * qx + qy * qy
    slim = (qx - px) * (qx - px) + (qy - py) * (qy - py) <= SLIM * (p + q)
    panels = min(max(1, math.ceil(rest.turning * math.sqrt(max(p, q)) / PANEL)), PANELS)
    for n in range(1 if slim else 2):
        along, share = _ONE[0] if slim else _TWO[n]
        ex, ey = px + along * (qx - px), py + along * (qy - py)
        for panel in range(panels):
            u = _outward(panel, panels)
            e = _along_ray(ex, ey, u, rest, layout, waves, found, phases, near)
            for i in range(4):
                x, y = u[i] * ex, u[i] * ey
                e_dA = u[i] * _FOUR[i][1] * share / panels * e[i]
                i0 += e_dA
                ix += x * e_dA
                iy += y * e_dA
                iz += (height + gx * x + gy * y + 0.5 * e[i]) * e_dA
    whole = px * qy - py * qx
    return whole * i0, whole * ix, whole * iy, whole * iz


@njit(cache=True, error_model="numpy", inline="always")
def _outward(panel, panels):
    """The four points of a panel, as parts of the way from the middle."""
    return (
        (panel + _FOUR[0][0]) / panels,
        (panel + _FOUR[1][0]) / panels,
        (panel + _FOUR[2][0]) / panels,
        (panel + _FOUR[3][0]) / panels,
    )


@njit(cache=True, error_model="numpy", inline="always")
def _along_ray(x, y, u, rest, layout, waves, found, phases, near):
    """The rest at four parts u of the way from the middle of the hull to a place."""
    e0 = e1 = e2 = e3 = 0.0
    if rest.smooth:
        a, b, c, d = (
            (u[0] * x, u[0] * y), (u[1] * x, u[1] * y), (u[2] * x, u[2] * y), (u[3] * x, u[3] * y),
        )  # fmt: skip
        e0, e1, e2, e3 = _four_rests(rest, layout, waves, found, phases, a, b, c, d)
    for w in range(rest.near):
        angle = near[w, K_WORLD] * x + near[w, K_WORLD + 1] * y
        crest, slope = near[w, CREST], near[w, SLOPE]
        s0, c0 = bend(u[0] * angle, rest.doubled)
        s1, c1 = bend(u[1] * angle, rest.doubled)
        s2, c2 = bend(u[2] * angle, rest.doubled)
        s3, c3 = bend(u[3] * angle, rest.doubled)
        e0, e1 = e0 + crest * c0 - slope * s0, e1 + crest * c1 - slope * s1
        e2, e3 = e2 + crest * c2 - slope * s2, e3 + crest * c3 - slope * s3
    return e0, e1, e2, e3

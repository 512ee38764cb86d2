"""The waves around one hull, in its own frame: a plane that touches the surface, and a rest.

The plane touches the surface over the middle of the hull.

The rest e(x, y) of the elevation is what the waves have beside that plane: the tiles of `tiles`,
and the near waves, which are taken one by one.
"""

import math
from typing import NamedTuple

import numpy as np

from buoyancy_mj.kernels.compiling import inlined, njit
from buoyancy_mj.kernels.hulls import WHOLE_HALF, WHOLE_MIDDLE
from buoyancy_mj.kernels.series import bend, doublings
from buoyancy_mj.kernels.tiles import (
    AMPLITUDE,
    HELD,
    KX,
    KY,
    OMEGA,
    PHASE,
    TURNING,
    add_elevations,
    find_tile,
    tangent_in,
)
from buoyancy_mj.kernels.vectors import place, rotate, triple

CREST, SLOPE, K, K_X, K_Y, COLUMNS = 0, 1, 2, 5, 6, 7
"""Columns of a near wave, and how many: A cos and A sin of its phase over the middle, its wave
vector in the hull's frame (3) and in the world's (2)."""

# unsigned, as Numba indexes fastest
_X, _Y, _Z = np.uint64(0), np.uint64(1), np.uint64(2)
PANEL = 2.0
"""Longest angle [rad] over which four points across are enough, to 2e-5 of the amplitude."""
PANELS = 256
"""Most of them: no ripple is resolved that is shorter than a hundredth of the hull."""
SHORT = 0.5
"""Longest angle [rad] over which three points across are enough, to 1e-6 of the amplitude."""


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
    ahead: tuple[float, float]
    """The direction in which the hull is longest, along x and y of the world."""
    panels: int
    """Into how many panels the way across it is divided, from the axis of the hull to a cut."""
    points: int
    """How many points each of them has."""
    place: tuple[float, float]
    """Of the middle of the hull along x and y of the world [m]."""
    touch: tuple[float, float, float]
    """Elevation of the tiles over the middle, and its gradient along x and y."""
    touch_all: tuple[float, float, float]
    """The same of all waves."""
    time: float
    """[s]."""


@inlined
def approach(level, tiles, store, origin, r, whole, h, time, near):
    """Bring the waves to a hull, a row of `Hulls.whole`: a `Plane` and a `Rest`.

    The tiles are `tiles.Tiles`, and those that are known a `tiles.TileStore`; the near waves go to
    `near`.
    """
    c0, c1, c2 = triple(whole, h, WHOLE_MIDDLE)
    x, y, _ = place(origin, r, c0, c1, c2)
    e0, e1, e2 = triple(whole, h, WHOLE_HALF)
    radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
    touch, (eta, s0, s1, s2), count, steepest = _gather(tiles, store, x, y, r, time, near)
    change = steepest * radius

    # the plane, as the depth under it: d + g (x - c)
    g0, g1, g2 = s0 - r[6], s1 - r[7], s2 - r[8]
    height = level + eta - origin[2]
    d = height - (r[6] * c0 + r[7] * c1 + r[8] * c2)
    still = d - (g0 * c0 + g1 * c1 + g2 * c2)
    gx, gy, _ = rotate(r, s0, s1, s2)
    plane = Plane((c0, c1, c2), d, still, (g0, g1, g2), height, (gx, gy))

    # the rest, with the way across the hull that is divided into panels
    ahead, width = _look_along(r, (e0, e1, e2))
    turn = tiles.layout[TURNING] * width
    panels, points = min(max(1, math.ceil(turn / PANEL)), PANELS), 3 if turn <= SHORT else 4
    return plane, Rest(
        count, int(tiles.layout[HELD]) > 0, doublings(change), ahead, panels, points, (x, y),
        touch, (eta, gx, gy), time,
    )  # fmt: skip


@njit(cache=True, error_model="numpy", _nrt=False)
def _look_along(r, half):
    """The direction in which a box with half sides (3) is longest, seen from above.

    It is along x and y of the world. Also how far the box extends across it [m].
    """
    ax, ay, longest = 1.0, 0.0, 0.0
    for k in range(3):
        length = half[k] * math.hypot(r[k], r[3 + k])
        if length > longest:
            longest = length
            ax, ay = half[k] * r[k] / length, half[k] * r[3 + k] / length
    width = 0.0
    for k in range(3):
        width += half[k] * abs(ax * r[3 + k] - ay * r[k])
    return (ax, ay), width


@njit(cache=True, error_model="numpy", _nrt=False)
def _gather(tiles, store, x, y, r, time, near):
    """Bring the near waves to a hull, and find the plane over its middle.

    Returns the elevation of the tiles there, with its gradient in the world; that of all waves,
    with its gradient in the hull's frame; how many waves are near; and their largest wave number.
    """
    eta = gx = gy = g0 = g1 = g2 = steepest = 0.0
    held, waves = int(tiles.layout[HELD]), tiles.waves
    count = waves.shape[1]
    if held > 0:
        t = find_tile(tiles, store, x, y, time)
        eta, gx, gy = tangent_in(tiles, store, t, x, y)
    touch = (eta, gx, gy)
    for w in range(held, count):
        amplitude, kx, ky = waves[AMPLITUDE, w], waves[KX, w], waves[KY, w]
        phase = kx * x + ky * y - waves[OMEGA, w] * time + waves[PHASE, w]
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        steepest = max(steepest, math.sqrt(kx * kx + ky * ky))
        k0, k1, k2 = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
        n = w - held
        near[n, CREST], near[n, SLOPE] = crest, slope
        near[n, K], near[n, K + 1], near[n, K + 2] = k0, k1, k2
        near[n, K_X], near[n, K_Y] = kx, ky
        eta += crest
        g0 -= slope * k0
        g1 -= slope * k1
        g2 -= slope * k2
    g0, g1, g2 = g0 + gx * r[0] + gy * r[3], g1 + gx * r[1] + gy * r[4], g2 + gx * r[2] + gy * r[5]
    return touch, (eta, g0, g1, g2), count - held, steepest


@inlined
def over_node(rest, r, tiles, store, near, away):
    """The rest of the elevation over a place `away` from the middle of the hull, in its frame.

    Also its gradient there, in the frame of the hull.
    """
    e = s0 = s1 = s2 = 0.0
    if rest.smooth:
        x, y, _ = rotate(r, away[0], away[1], away[2])
        t = find_tile(tiles, store, rest.place[0] + x, rest.place[1] + y, rest.time)
        e, sx, sy = tangent_in(tiles, store, t, rest.place[0] + x, rest.place[1] + y)
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


@inlined
def depth_away(plane, away):
    """Depth under the plane of a point that is `away` from the middle of the hull, in its frame."""
    g0, g1, g2 = plane.gradient
    return plane.depth + g0 * away[0] + g1 * away[1] + g2 * away[2]


@inlined
def see(vertices, first, count, plane, r, x, y, d):
    """See vertices from `first` on, from above, from the middle of the hull.

    Their places along x and y of the world, and their depths under the plane, are written.
    """
    c0, c1, c2 = plane.middle
    g0, g1, g2 = plane.gradient
    cx, cy, _ = rotate(r, c0, c1, c2)
    r0, r1, r2, r3, r4, r5 = r[0], r[1], r[2], r[3], r[4], r[5]
    for n in range(count):
        p0, p1, p2 = vertices[first + n, _X], vertices[first + n, _Y], vertices[first + n, _Z]
        x[n] = r0 * p0 + r1 * p1 + r2 * p2 - cx
        y[n] = r3 * p0 + r4 * p1 + r5 * p2 - cy
        d[n] = plane.origin_depth + (g0 * p0 + g1 * p1 + g2 * p2)


@njit(cache=True, error_model="numpy", _nrt=False)
def add_rest(x, y, count, rest, tiles, store, near, out):
    """Add the rest e at places seen from the middle of the hull to `out`."""
    if rest.smooth:
        eta, gx, gy = rest.touch
        for n in range(count):
            out[n] -= eta + gx * x[n] + gy * y[n]
        add_elevations(tiles, store, rest.place, x, y, count, rest.time, out)
    # each with a literal, so that the processor takes several places at once
    for i in range(rest.near):
        if rest.doubled == 0:
            _add_wave(x, y, count, near, i, 0, out)
        elif rest.doubled == 1:
            _add_wave(x, y, count, near, i, 1, out)
        elif rest.doubled == 2:
            _add_wave(x, y, count, near, i, 2, out)
        else:
            _add_wave(x, y, count, near, i, 3, out)


@inlined
def _add_wave(x, y, count, swell, i, doubled, out):
    """Add the near wave i, less its plane, at places seen from the middle of the hull."""
    crest, slope, kx, ky = swell[i, CREST], swell[i, SLOPE], swell[i, K_X], swell[i, K_Y]
    for n in range(count):
        sine, cosine = bend(kx * x[n] + ky * y[n], doubled)
        out[n] += crest * cosine - slope * sine

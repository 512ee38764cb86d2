"""The waves around one hull, in its own frame: a plane that touches the surface, and a rest.

The plane touches the surface over the middle of the hull.

The rest e(x, y) of the elevation is that of the near waves, which are taken one by one, and of a
polynomial that holds all others, see `local`.
"""

import math
from typing import NamedTuple

from buoyancy_mj.kernels import planning
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.hulls import DEGREE, LIMIT, WHOLE_HALF, WHOLE_MIDDLE
from buoyancy_mj.kernels.polynomials import add_at_many, add_series, on_ray, set_along_ray
from buoyancy_mj.kernels.series import bend, doublings
from buoyancy_mj.kernels.vectors import place, rotate, triple
from buoyancy_mj.kernels.waves import AMPLITUDE, phase_at

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

    Those are the near waves, and the coefficients of the polynomial.
    """

    near: int
    """How many waves are near."""
    degree: int
    """Degree of the polynomial."""
    smooth: bool
    """Whether it holds any wave."""
    doubled: int
    """How often angles between waves and hull are halved, see `series.bend`."""
    panels: int
    """Into how many panels the way from the middle to a cut is divided."""


@njit(cache=True, error_model="numpy", inline="always")
def approach(level, waves, origin, r, whole, h, time, swell, flat):
    """Bring the waves to a hull, a row of `Hulls.whole`: a `Plane` and a `Rest`.

    The arrays of the rest are `swell` and `flat`.
    """
    c0, c1, c2 = triple(whole, h, WHOLE_MIDDLE)
    eta, s0, s1, s2, near, change = _gather(waves, origin, r, whole, h, time, swell, flat)

    # the plane, as the depth under it: d + g (x - c)
    g0, g1, g2 = s0 - r[6], s1 - r[7], s2 - r[8]
    height = level + eta - origin[2]
    d = height - (r[6] * c0 + r[7] * c1 + r[8] * c2)
    still = d - (g0 * c0 + g1 * c1 + g2 * c2)
    gx, gy, _ = rotate(r, s0, s1, s2)
    plane = Plane((c0, c1, c2), d, still, (g0, g1, g2), height, (gx, gy))

    # the rest
    panels = min(max(1, math.ceil(change / PANEL)), PANELS)
    smooth = near < waves.shape[0]
    degree = int(whole[h, DEGREE])
    return plane, Rest(near, degree, smooth, doublings(change), panels)


@njit(cache=True, error_model="numpy")
def _gather(waves, origin, r, whole, h, time, swell, flat):
    """Sort the waves around a hull: near ones go to `swell`, all others into the polynomial `flat`.

    Returns the elevation over the middle, from the still level; its gradient in the hull's frame;
    how many waves are near; and by how much the phase of any changes over the hull.
    """
    eta = g0 = g1 = g2 = steepest = 0.0
    degree, limit = int(whole[h, DEGREE]), whole[h, LIMIT]
    c0, c1, c2 = triple(whole, h, WHOLE_MIDDLE)
    e0, e1, e2 = triple(whole, h, WHOLE_HALF)
    x, y, _ = place(origin, r, c0, c1, c2)
    radius = math.sqrt(e0**2 + e1**2 + e2**2)
    near = 0
    flat[:] = 0.0
    for w in range(waves.shape[0]):
        amplitude, kx, ky = triple(waves, w, AMPLITUDE)
        phase = phase_at(waves, w, x, y, time)
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        steepest = max(steepest, math.sqrt(kx * kx + ky * ky))
        if planning.remainder(waves, w, radius) <= limit:
            add_series(flat, 0, degree, crest, slope, kx, ky)
            continue
        k0, k1, k2 = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
        swell[near, CREST], swell[near, SLOPE] = crest, slope
        swell[near, K], swell[near, K + 1], swell[near, K + 2] = k0, k1, k2
        swell[near, K_WORLD], swell[near, K_WORLD + 1] = kx, ky
        near += 1
        eta += crest
        g0 -= slope * k0
        g1 -= slope * k1
        g2 -= slope * k2

    # the plane of the polynomial: coefficients of 1, y and x
    one, sx, sy = flat[0], flat[degree + 1], flat[1]
    flat[0] = flat[1] = flat[degree + 1] = 0.0
    g0 = g0 + sx * r[0] + sy * r[3]
    g1 = g1 + sx * r[1] + sy * r[4]
    g2 = g2 + sx * r[2] + sy * r[5]
    return eta + one, g0, g1, g2, near, steepest * radius


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
def add_rest(vertices, first, last, middle, r, rest, swell, flat, depths, room):
    """Add the rest to depths under the plane, of vertices from `first` up to `last`.

    `room` is scratch.
    """
    c0, c1, c2 = middle
    if rest.smooth:
        for n in range(first, last):
            x, y, _ = rotate(r, vertices[n, 0] - c0, vertices[n, 1] - c1, vertices[n, 2] - c2)
            room[0, n - first], room[1, n - first] = x, y
        add_at_many(flat, 0, rest.degree, room[0], room[1], last - first, room[2], room[3], depths)
    for w in range(rest.near):
        crest, slope = swell[w, CREST], swell[w, SLOPE]
        k0, k1, k2 = triple(swell, w, K)
        shift = k0 * c0 + k1 * c1 + k2 * c2
        for n in range(first, last):
            angle = k0 * vertices[n, 0] + k1 * vertices[n, 1] + k2 * vertices[n, 2] - shift
            sine, cosine = bend(angle, rest.doubled)
            depths[n - first] += crest * cosine - slope * sine


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
def waterplane_moments(ends, height, slope, rest, swell, flat, ray):
    """Integrals of e, x e, y e and (plane + e / 2) e over a triangle of the waterplane.

    Its corners are the middle of the hull and the `ends` of a cut. The plane has the `height` over
    the middle, and the `slope`. All is seen from above. By Gauss outward, in panels of at most
    `PANEL` / k, and along the cut; `ray` is scratch.
    """
    px, py, qx, qy = ends
    gx, gy = slope
    i0 = ix = iy = iz = 0.0
    apart = (qx - px) * (qx - px) + (qy - py) * (qy - py)
    slim = apart <= SLIM * (px * px + py * py + qx * qx + qy * qy)
    for n in range(1 if slim else 2):
        along, share = _ONE[0] if slim else _TWO[n]
        ex, ey = px + along * (qx - px), py + along * (qy - py)
        if rest.smooth:
            set_along_ray(flat, rest.degree, ex, ey, ray)
        for panel in range(rest.panels):
            for out, weight in _FOUR:
                u = (panel + out) / rest.panels
                x, y = u * ex, u * ey
                e = on_ray(ray, rest.degree, u) if rest.smooth else 0.0
                for w in range(rest.near):
                    kx, ky = swell[w, K_WORLD], swell[w, K_WORLD + 1]
                    sine, cosine = bend(kx * x + ky * y, rest.doubled)
                    e += swell[w, CREST] * cosine - swell[w, SLOPE] * sine
                e_dA = u * weight * share / rest.panels * e
                i0 += e_dA
                ix += x * e_dA
                iy += y * e_dA
                iz += (height + gx * x + gy * y + 0.5 * e) * e_dA
    whole = px * qy - py * qx
    return whole * i0, whole * ix, whole * iy, whole * iz

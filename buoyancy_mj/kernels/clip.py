"""The wet part of closed triangle meshes under a surface: exact on triangles, no lid needed.

With the depth d = elevation - z, the field (0, 0, -d) has divergence 1 in the water and vanishes on
the surface, so by Gauss

    V = - int d n_z dA,   int x dV = - int x d n_z dA,   int z dV = - int (z + d/2) d n_z dA

over the wet side of the mesh alone. In waves the elevation is that of the plane that touches the
surface over the middle of the hull, and a rest e(x, y), see `swell`. The field (0, 0, e) has no
divergence, so what e adds on the wet side it adds on the waterplane, and there alone it needs to be
summed:

    V = - int d n_z dA + int e dxdy,   int x dV = - int x d n_z dA + int x e dxdy,
    int z dV = - int (z + d/2) d n_z dA + int (p + e/2) e dxdy

with d the depth under the plane, p its height, and the last integrals over the waterplane, whose
outline is where the triangles are cut. All of it is summed in the frame of the hull, where the
vertices stand still and the vertical leans.
"""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels import local, swell, tree
from buoyancy_mj.kernels.hulls import (
    AREA_OF_FACE,
    FILL,
    WHOLE_AREA,
    WHOLE_CENTROID,
    WHOLE_HALF,
    WHOLE_MIDDLE,
    WHOLE_VOLUME,
)
from buoyancy_mj.kernels.polynomials import with_gradient
from buoyancy_mj.kernels.series import bend
from buoyancy_mj.kernels.triangles import cut, moments
from buoyancy_mj.kernels.vectors import place, rotate, triple
from buoyancy_mj.kernels.waves import swing

VOLUME, CX, CY, CZ, WETTED_AREA, WATERPLANE_AREA, COLUMNS = range(7)
"""Columns of one row of results, and how many: volume, its centroid (3), and areas."""
CENTROID = slice(CX, WETTED_AREA)
"""Columns of the centroid."""


@njit(cache=True, error_model="numpy")
def submerge_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    scratch,  # `hulls.Scratch`
    out,  # (h, 6) volume, centroid (world; NaN when dry), wetted area, waterplane area
):
    """The submersion of each hull; only hulls that the surface may cut cost more than a few operations."""
    for h in range(hulls.frames.shape[0]):
        origin, r = geoms.geom_xpos[hulls.frames[h]], geoms.geom_xmat[hulls.frames[h]]
        whole, row = hulls.whole[h], out[h]

        # how deep the middle of its box lies, and how much shallower or deeper any point of it can be
        c0, c1, c2 = triple(hulls.whole, h, WHOLE_MIDDLE)
        e0, e1, e2 = triple(hulls.whole, h, WHOLE_HALF)
        x, y, z = place(origin, r, c0, c1, c2)
        radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        eta, spread, curvature = swing(sea.waves, x, y, time, radius)
        depth = sea.level + eta - z
        spread += abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2

        # a hull that is lost, under water, dry, or cut
        if not math.isfinite(depth):
            row[:] = math.nan
        elif depth >= spread:
            _set_whole(row, whole, origin, r, whole[WHOLE_AREA], 0.0)
        elif depth <= -spread:
            _set_dry(row)
        else:
            v, mx, my, mz, p, area = _walk(hulls, h, origin, r, sea, time, curvature, scratch)
            _set_wet(row, whole, origin, r, v, mx, my, mz, area, p)


@njit(cache=True, error_model="numpy", inline="always")
def _set_dry(row):
    """The results of a hull that is not in the water."""
    row[VOLUME] = row[WETTED_AREA] = row[WATERPLANE_AREA] = 0.0
    row[CX] = row[CY] = row[CZ] = math.nan


@njit(cache=True, error_model="numpy", inline="always")
def _set_whole(row, whole, origin, r, area, waterplane):
    """The results of a hull whose whole volume is under water."""
    row[VOLUME], row[WETTED_AREA], row[WATERPLANE_AREA] = whole[WHOLE_VOLUME], area, waterplane
    row[CX], row[CY], row[CZ] = place(
        origin, r, whole[WHOLE_CENTROID], whole[WHOLE_CENTROID + 1], whole[WHOLE_CENTROID + 2]
    )


@njit(cache=True, error_model="numpy", inline="always")
def _set_wet(row, whole, origin, r, v, mx, my, mz, area, waterplane):
    """The results of a hull that the surface cuts, from its volume and first moments about the origin."""
    # never more than all of it, and below the rounding of the sums there is no centroid to speak of
    if v >= whole[WHOLE_VOLUME]:
        _set_whole(row, whole, origin, r, area, waterplane)
    elif v > 1e-14 * whole[WHOLE_VOLUME]:
        row[VOLUME], row[WETTED_AREA], row[WATERPLANE_AREA] = v, area, waterplane
        row[CX], row[CY], row[CZ] = origin[0] + mx / v, origin[1] + my / v, origin[2] + mz / v
    else:
        _set_dry(row)


@njit(cache=True, error_model="numpy")
def _walk(hulls, h, origin, r, sea, time, curvature, scratch):
    """Volume of a hull, first moments about its origin, horizontal and wetted area, by the tree over its triangles.

    Triangles are visited at the surface alone: nodes that are wholly wet are answered by their
    moments. `curvature` is a bound of the surface's over the hull.
    """
    flat, ray = np.empty(local.FLAT), np.empty(local.MOST + 1)
    plane, rest = swell.approach(sea, origin, r, hulls.whole, h, time, scratch.swell, flat)
    depths, spans = scratch.depths, hulls.spans

    # seven integrals over the wet side, and four of e over the waterplane
    total, extra = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    i, end = hulls.nodes[h], hulls.nodes[h + 1]
    while i < end:
        under, depth, spread = _depth_of_node(hulls.boxes, i, r, plane, rest, curvature)
        dry, wet = depth <= -spread, depth >= spread
        if wet and not dry:
            part = _moments_of_node(hulls.moments, hulls.boxes, i, r, under, plane.gradient)
            total = _sum(total, part)
        elif not dry and tree.is_leaf(spans, i):
            _set_depths(hulls, i, r, plane, rest, depths)
            total, extra = _add_leaf(total, extra, hulls, i, r, plane, rest, depths[0], ray)
        i = tree.node_after(spans, i, dry or wet)

    # in the world's axes
    v, lx, ly, lz, q, p, area = total
    mx, my, mz = rotate(r, lx, ly, lz)
    c0, c1, c2 = plane.middle
    cx, cy, _ = rotate(r, c0, c1, c2)
    fill = hulls.whole[h, FILL]
    i0, ix, iy, iz = fill * extra[0], fill * extra[1], fill * extra[2], fill * extra[3]
    return i0 - v, ix + cx * i0 - mx, iy + cy * i0 - my, iz - mz - 0.5 * q, -p, area


@njit(cache=True, error_model="numpy", inline="always")
def _depth_of_node(boxes, i, r, plane, rest, curvature):
    """Depth of the middle of a node's box under the plane and under the surface; and how much any point of it can differ."""
    b0, b1, b2 = triple(boxes, i, tree.MIDDLE)
    c0, c1, c2 = plane.middle
    h0, h1, h2 = plane.gradient
    y0, y1, y2 = b0 - c0, b1 - c1, b2 - c2
    under = plane.depth + h0 * y0 + h1 * y1 + h2 * y2
    depth = under
    if rest.smooth:
        x, y, _ = rotate(r, y0, y1, y2)
        e, sx, sy = with_gradient(rest.flat, 0, rest.degree, x, y)
        depth += e
        h0, h1, h2 = (
            h0 + sx * r[0] + sy * r[3],
            h1 + sx * r[1] + sy * r[4],
            h2 + sx * r[2] + sy * r[5],
        )
    for w in range(rest.near):
        crest, slope = rest.swell[w, swell.CREST], rest.swell[w, swell.SLOPE]
        k0, k1, k2 = triple(rest.swell, w, swell.K)
        angle = k0 * y0 + k1 * y1 + k2 * y2
        sine, cosine = bend(angle, rest.doubled)
        depth += crest * cosine - slope * sine
        change = -slope * cosine - crest * (sine + angle)
        h0, h1, h2 = h0 + change * k0, h1 + change * k1, h2 + change * k2
    return under, depth, tree.spread_in_box(boxes, i, h0, h1, h2, curvature)


@njit(cache=True, error_model="numpy", inline="always")
def _moments_of_node(moments_of_area, boxes, i, r, under, gradient):
    """The seven integrals over a node that is wholly wet, by its moments, with the depth `under` the plane at its middle."""
    # contracted with the vertical
    m = moments_of_area[i]
    s = _vertical(m, tree.VECTOR, r)
    t0, t1, t2 = _vertical(m, tree.X, r), _vertical(m, tree.Y, r), _vertical(m, tree.Z, r)
    u00, u11, u22 = _vertical(m, tree.XX, r), _vertical(m, tree.YY, r), _vertical(m, tree.ZZ, r)
    u01, u02, u12 = _vertical(m, tree.XY, r), _vertical(m, tree.XZ, r), _vertical(m, tree.YZ, r)

    # with the depth
    g0, g1, g2 = gradient
    tilted = g0 * t0 + g1 * t1 + g2 * t2
    n0 = g0 * u00 + g1 * u01 + g2 * u02
    n1 = g0 * u01 + g1 * u11 + g2 * u12
    n2 = g0 * u02 + g1 * u12 + g2 * u22
    part = under * s + tilted
    b0, b1, b2 = triple(boxes, i, tree.MIDDLE)
    return (
        part,
        b0 * part + under * t0 + n0,
        b1 * part + under * t1 + n1,
        b2 * part + under * t2 + n2,
        under * (part + tilted) + g0 * n0 + g1 * n1 + g2 * n2,
        s,
        m[tree.AREA],
    )


@njit(cache=True, error_model="numpy", inline="always")
def _vertical(m, k, r):
    """Three numbers of a row of moments, along the world's vertical."""
    return m[k] * r[6] + m[k + 1] * r[7] + m[k + 2] * r[8]


@njit(cache=True, error_model="numpy", inline="always")
def _sum(a, b):
    """Seven numbers and seven more."""
    return (
        a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5], a[6] + b[6],
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _set_depths(hulls, i, r, plane, rest, depths):
    """Write the depths of a leaf's vertices under the surface to the first row; the others are scratch."""
    first, last = hulls.spans[i, tree.FIRST_VERTEX], hulls.spans[i, tree.END_VERTEX]
    for n in range(first, last):
        depths[0, n - first] = swell.depth_under(plane, hulls.vertices, n)
    if rest.near > 0 or rest.smooth:
        swell.add_rest(hulls.vertices, first, last, plane.middle, r, rest, depths[0], depths[1:])


@njit(cache=True, error_model="numpy", inline="always")
def _add_leaf(total, extra, hulls, i, r, plane, rest, depths, ray):
    """Add the integrals over the triangles of a leaf, by the depths of its vertices."""
    faces, vertices, areas = hulls.faces, hulls.vertices, hulls.areas
    base, wavy = hulls.spans[i, tree.FIRST_VERTEX], rest.near > 0 or rest.smooth
    for f in range(hulls.spans[i, tree.FIRST_FACE], hulls.spans[i, tree.END_FACE]):
        j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
        w0, w1, w2 = depths[j - base], depths[k - base], depths[o - base]
        if w0 <= 0.0 and w1 <= 0.0 and w2 <= 0.0:
            continue
        a = r[6] * areas[f, 0] + r[7] * areas[f, 1] + r[8] * areas[f, 2]
        x0, y0, z0 = triple(vertices, j, 0)
        x1, y1, z1 = triple(vertices, k, 0)
        x2, y2, z2 = triple(vertices, o, 0)
        d0, d1, d2 = w0, w1, w2
        if wavy:
            d0 = swell.depth_under(plane, vertices, j)
            d1 = swell.depth_under(plane, vertices, k)
            d2 = swell.depth_under(plane, vertices, o)
        corner0, corner1, corner2 = (x0, y0, z0, d0), (x1, y1, z1, d1), (x2, y2, z2, d2)
        if w0 > 0.0 and w1 > 0.0 and w2 > 0.0:
            part, fraction = moments(a, corner0, corner1, corner2), 1.0
        else:
            part, fraction, one, other = cut(a, corner0, corner1, corner2, w0, w1, w2)
            if wavy:
                extra = _add_waterplane(extra, one, other, r, plane, rest, ray)
        total = _sum(total, (*part, fraction * a, fraction * areas[f, AREA_OF_FACE]))
    return total, extra


@njit(cache=True, error_model="numpy", inline="always")
def _add_waterplane(extra, one, other, r, plane, rest, ray):
    """Add the integrals of e over the triangle from the middle of the hull to the ends of a cut."""
    c0, c1, c2 = plane.middle
    px, py, _ = rotate(r, one[0] - c0, one[1] - c1, one[2] - c2)
    qx, qy, _ = rotate(r, other[0] - c0, other[1] - c1, other[2] - c2)
    part = swell.waterplane_moments(px, py, qx, qy, plane, rest, ray)
    return extra[0] + part[0], extra[1] + part[1], extra[2] + part[2], extra[3] + part[3]

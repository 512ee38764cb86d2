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
outline is where the triangles are cut. The waterplane's own area is - int n_z dA over the wet side,
and its centroid is summed along the outline, over the triangles from the middle of the hull to each
cut. All of it is summed in the frame of the hull, where the
vertices stand still and the vertical leans.
"""

import math

from numba import njit

from buoyancy_mj.kernels import swell, tree
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
from buoyancy_mj.kernels.vectors import difference, place, rotate, triple
from buoyancy_mj.kernels.waves import swing

VOLUME, CX, CY, CZ, WETTED_AREA, WATERPLANE_AREA, WATERPLANE_X, WATERPLANE_Y, COLUMNS = range(9)
"""Columns of one row of results, and how many: volume, its centroid (3), areas, and the centroid of
the waterplane (2)."""
CENTROID = slice(CX, WETTED_AREA)
"""Columns of the centroid."""


@njit(cache=True, error_model="numpy")
def submerge_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    level,  # of the water [m]
    waves,  # (w, 7)
    time,  # [s]
    scratch,  # `scratch.CutScratch`
    out,  # (h, 8) volume, centroid (world; NaN when dry), wetted area, waterplane (NaN when none)
    first,  # hull, and one past the last
    last,
):
    """Write the submersion of hulls to their rows of `out`.

    Only hulls that the surface may cut cost more than a few operations.
    """
    wholes, frames = hulls.whole, hulls.frames
    positions, rotations = geoms.geom_xpos, geoms.geom_xmat
    for h in range(first, last):
        origin, r = positions[frames[h]], rotations[frames[h]]

        # how deep the middle of its box lies, and how much shallower or deeper any point of it can
        # be
        c0, c1, c2 = triple(wholes, h, WHOLE_MIDDLE)
        e0, e1, e2 = triple(wholes, h, WHOLE_HALF)
        x, y, z = place(origin, r, c0, c1, c2)
        radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        eta, spread, curvature = swing(waves, x, y, time, radius)
        depth = level + eta - z
        spread += abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2

        # a hull that is lost, under water, dry, or cut
        if not math.isfinite(depth):
            out[h, :] = math.nan
        elif depth >= spread:
            _set_whole(out, h, wholes, origin, r, wholes[h, WHOLE_AREA])
        elif depth <= -spread:
            _set_dry(out, h)
        else:
            wet = _walk(hulls, h, origin, r, level, waves, time, curvature, scratch)
            _set_wet(out, h, wholes, origin, r, wet)


@njit(cache=True, error_model="numpy", inline="always")
def _set_dry(out, h):
    """Write the results of a hull that is not in the water."""
    out[h, VOLUME] = out[h, WETTED_AREA] = out[h, WATERPLANE_AREA] = 0.0
    out[h, CX] = out[h, CY] = out[h, CZ] = out[h, WATERPLANE_X] = out[h, WATERPLANE_Y] = math.nan


@njit(cache=True, error_model="numpy", inline="always")
def _set_whole(out, h, wholes, origin, r, area):
    """Write the results of a hull whose whole volume is under water."""
    out[h, VOLUME], out[h, WETTED_AREA] = wholes[h, WHOLE_VOLUME], area
    out[h, WATERPLANE_AREA] = 0.0
    out[h, WATERPLANE_X] = out[h, WATERPLANE_Y] = math.nan
    x, y, z = triple(wholes, h, WHOLE_CENTROID)
    out[h, CX], out[h, CY], out[h, CZ] = place(origin, r, x, y, z)


@njit(cache=True, error_model="numpy")
def _set_wet(out, h, wholes, origin, r, wet):
    """Write the results of a hull that the surface cuts, by what `_walk` found."""
    v, mx, my, mz, area, waterplane, px, py = wet
    # below the rounding of the sums there is no centroid to speak of, and never more than all of it
    if not v > 1e-14 * wholes[h, WHOLE_VOLUME]:
        _set_dry(out, h)
        return
    _set_whole(out, h, wholes, origin, r, area)
    if v < wholes[h, WHOLE_VOLUME]:
        out[h, VOLUME] = v
        out[h, CX] = origin[0] + mx / v
        out[h, CY] = origin[1] + my / v
        out[h, CZ] = origin[2] + mz / v
    if waterplane != 0.0:
        out[h, WATERPLANE_AREA] = waterplane
        out[h, WATERPLANE_X] = origin[0] + px / waterplane
        out[h, WATERPLANE_Y] = origin[1] + py / waterplane


@njit(cache=True, error_model="numpy")
def _walk(  # noqa: C901 (a call for each node would cost more than what it does)
    hulls, h, origin, r, level, waves, time, curvature, scratch
):
    """Volume of a hull, its first moments, wetted area, waterplane and its moments, by its tree.

    All moments are about the origin of the hull's frame, in the world's axes.

    Triangles are visited at the surface alone: nodes that are wholly wet are answered by their
    moments. `curvature` is a bound of the surface's over the hull.
    """
    near, flat, ray = scratch.swell, scratch.flat, scratch.ray
    depths, room = scratch.depths[0], scratch.depths[1:]
    vertices, faces, areas = hulls.vertices, hulls.faces, hulls.areas
    spans, boxes, node_moments = hulls.spans, hulls.boxes, hulls.moments
    plane, rest = swell.approach(level, waves, origin, r, hulls.whole, h, time, near, flat)
    wavy = rest.near > 0 or rest.smooth

    # seven integrals over the wet side, four of e over the waterplane, and its moments
    total, extra = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)
    ax = ay = 0.0
    i = hulls.nodes[h]
    end = spans[i, tree.BEHIND]
    while i < end:
        middle, half = triple(boxes, i, tree.MIDDLE), triple(boxes, i, tree.HALF)
        away = difference(middle, plane.middle)
        under = swell.depth_away(plane, away)
        depth, slope = under, plane.gradient
        if wavy:
            # with the rest of the elevation over the middle of the node
            if rest.smooth:
                x, y, _ = rotate(r, away[0], away[1], away[2])
                e, sx, sy = with_gradient(flat, 0, rest.degree, x, y)
                depth += e
                slope = (
                    slope[0] + sx * r[0] + sy * r[3],
                    slope[1] + sx * r[1] + sy * r[4],
                    slope[2] + sx * r[2] + sy * r[5],
                )
            for w in range(rest.near):
                crest, steep = near[w, swell.CREST], near[w, swell.SLOPE]
                k0, k1, k2 = triple(near, w, swell.K)
                angle = k0 * away[0] + k1 * away[1] + k2 * away[2]
                sine, cosine = bend(angle, rest.doubled)
                depth += crest * cosine - steep * sine
                change = -steep * cosine - crest * (sine + angle)
                slope = slope[0] + change * k0, slope[1] + change * k1, slope[2] + change * k2
        spread = tree.spread_in_box(half, slope, curvature)
        dry, wet = depth <= -spread, depth >= spread
        if wet and not dry:
            part = _moments_of_node(node_moments[i], middle, r, under, plane.gradient)
            total = _sum(total, part)
        elif not dry and tree.is_leaf(spans, i):
            first, last = spans[i, tree.FIRST_VERTEX], spans[i, tree.END_VERTEX]
            swell.set_depths(vertices, first, last, plane, depths)
            if wavy:
                swell.add_rest(
                    vertices, first, last, plane.middle, r, rest, near, flat, depths, room
                )
            for f in range(spans[i, tree.FIRST_FACE], spans[i, tree.END_FACE]):
                j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
                w0, w1, w2 = depths[j - first], depths[k - first], depths[o - first]
                if w0 <= 0.0 and w1 <= 0.0 and w2 <= 0.0:
                    continue
                a = r[6] * areas[f, 0] + r[7] * areas[f, 1] + r[8] * areas[f, 2]
                p = _corner(triple(vertices, j, 0), w0, plane, wavy)
                q = _corner(triple(vertices, k, 0), w1, plane, wavy)
                s = _corner(triple(vertices, o, 0), w2, plane, wavy)
                if w0 > 0.0 and w1 > 0.0 and w2 > 0.0:
                    part, fraction = moments(a, p, q, s), 1.0
                else:
                    part, fraction, one, other = cut(a, p, q, s, w0, w1, w2)
                    ends = swell.seen_from_above(plane, r, one, other)
                    px, py, qx, qy = ends
                    sixth = (px * qy - py * qx) / 6.0
                    ax, ay = ax + sixth * (px + qx), ay + sixth * (py + qy)
                    if wavy:
                        more = swell.waterplane_moments(
                            ends, plane.height, plane.slope, rest, near, flat, ray
                        )
                        extra = _sum_four(extra, more)
                total = _sum(total, (*part, fraction * a, fraction * areas[f, AREA_OF_FACE]))
        i = tree.node_after(spans, i, dry or wet)

    # in the world's axes
    v, lx, ly, lz, q, p, area = total
    mx, my, mz = rotate(r, lx, ly, lz)
    c0, c1, c2 = plane.middle
    cx, cy, _ = rotate(r, c0, c1, c2)
    fill = hulls.whole[h, FILL]
    i0, ix, iy, iz = fill * extra[0], fill * extra[1], fill * extra[2], fill * extra[3]
    return (
        i0 - v, ix + cx * i0 - mx, iy + cy * i0 - my, iz - mz - 0.5 * q,
        area, -p, fill * ax - cx * p, fill * ay - cy * p,
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _sum_four(a, b):
    """Four numbers and four more."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]


@njit(cache=True, error_model="numpy", inline="always")
def _moments_of_node(m, middle, r, under, gradient):
    """The seven integrals over a node that is wholly wet, by its moments m.

    The middle of its box lies `under` the plane.
    """
    # contracted with the vertical
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
    b0, b1, b2 = middle
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
def _corner(vertex, depth, plane, wavy):
    """A vertex as a corner of a triangle, with its depth under the plane.

    Without waves that is the depth under the surface.
    """
    x, y, z = vertex
    return x, y, z, swell.depth_under(plane, vertex) if wavy else depth

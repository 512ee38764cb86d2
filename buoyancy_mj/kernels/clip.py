"""The wet part of closed triangle meshes under a surface: exact on triangles, no lid needed.

With the depth d = elevation - z, the field (0, 0, -d) has divergence 1 in the water and vanishes on
the surface, so by Gauss

    V = - int d n_z dA,   int x dV = - int x d n_z dA,   int z dV = - int (z + d/2) d n_z dA

over the wet side of the mesh alone. In waves the elevation is that of the plane that touches the
surface over the middle of the hull, and a rest e(x, y). The field (0, 0, e) has no divergence, so
what e adds on the wet side it adds on the waterplane, and there alone it needs to be summed:

    V = - int d n_z dA + int e dxdy,   int x dV = - int x d n_z dA + int x e dxdy,
    int z dV = - int (z + d/2) d n_z dA + int (p + e/2) e dxdy

with d the depth under the plane, p its height, and the last integrals over the waterplane, whose
outline is where the triangles are cut. d is linear, so the integrands over triangles are quadratic,
and the integral of a product of linear functions f, g over a triangle of area a is exactly
a (sum f sum g + sum f g) / 12. All of it is summed in the frame of the hull, where the vertices
stand still and the vertical leans.
"""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels import local
from buoyancy_mj.kernels.waves import bend, doublings, swing

# columns of one row of results
VOLUME, CENTROID, WETTED_AREA, WATERPLANE_AREA, COLUMNS = 0, slice(1, 4), 4, 5, 6


@njit(cache=True, error_model="numpy", inline="always")
def _moments(a, x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2):
    """Of d n_z dA over one wholly wet triangle, whose signed area seen from above is a: plain, by x y z, and by d."""
    d = d0 + d1 + d2
    twelfth = a / 12.0
    return (
        a * d / 3.0,
        twelfth * (d * (x0 + x1 + x2) + d0 * x0 + d1 * x1 + d2 * x2),
        twelfth * (d * (y0 + y1 + y2) + d0 * y0 + d1 * y1 + d2 * y2),
        twelfth * (d * (z0 + z1 + z2) + d0 * z0 + d1 * z1 + d2 * z2),
        twelfth * (d * d + d0 * d0 + d1 * d1 + d2 * d2),
    )


@njit(cache=True, error_model="numpy")
def cut(a, x0, y0, z0, d0, w0, x1, y1, z1, d1, w1, x2, y2, z2, d2, w2):
    """The wet part of a triangle that the surface cuts, by the depths w of its corners.

    Gives `_moments`, the fraction of its area, and the two ends of the cut, such that the waterplane
    lies to the left of the way from the first to the second, seen from above.
    """
    wet0, wet1, wet2 = w0 > 0.0, w1 > 0.0, w2 > 0.0
    # turn the triangle so that corner 0 is alone on its side
    alone = int(wet0) + int(wet1) + int(wet2) == 1
    if wet1 == alone and wet0 != alone and wet2 != alone:
        x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2 = (
            x1,
            y1,
            z1,
            d1,
            x2,
            y2,
            z2,
            d2,
            x0,
            y0,
            z0,
            d0,
        )
        w0, w1, w2 = w1, w2, w0
    elif wet2 == alone and wet0 != alone and wet1 != alone:
        x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2 = (
            x2,
            y2,
            z2,
            d2,
            x0,
            y0,
            z0,
            d0,
            x1,
            y1,
            z1,
            d1,
        )
        w0, w1, w2 = w2, w0, w1
    # where its two edges meet the surface
    s, t = w0 / (w0 - w1), w0 / (w0 - w2)
    px, py, pz, pd = x0 + s * (x1 - x0), y0 + s * (y1 - y0), z0 + s * (z1 - z0), d0 + s * (d1 - d0)
    qx, qy, qz, qd = x0 + t * (x2 - x0), y0 + t * (y2 - y0), z0 + t * (z2 - z0), d0 + t * (d2 - d0)
    if alone:
        part = _moments(s * t * a, x0, y0, z0, d0, px, py, pz, pd, qx, qy, qz, qd)
        return part, s * t, (qx, qy, qz), (px, py, pz)
    v, mx, my, mz, q = _moments((1.0 - s) * a, px, py, pz, pd, x1, y1, z1, d1, x2, y2, z2, d2)
    u, nx, ny, nz, r = _moments(s * (1.0 - t) * a, px, py, pz, pd, x2, y2, z2, d2, qx, qy, qz, qd)
    return (v + u, mx + nx, my + ny, mz + nz, q + r), 1.0 - s * t, (px, py, pz), (qx, qy, qz)


@njit(cache=True, error_model="numpy", inline="always")
def _turned(r, x, y, z):
    """A vector of a frame, turned by the row-major rotation r (9,)."""
    return (
        r[0] * x + r[1] * y + r[2] * z,
        r[3] * x + r[4] * y + r[5] * z,
        r[6] * x + r[7] * y + r[8] * z,
    )


@njit(cache=True, error_model="numpy", inline="always")
def placed(origin, r, x, y, z):
    """A point of a frame, in the world."""
    tx, ty, tz = _turned(r, x, y, z)
    return origin[0] + tx, origin[1] + ty, origin[2] + tz


@njit(cache=True, error_model="numpy", inline="always")
def _vertical(m, k, r):
    """Three numbers of a row of moments, along the world's vertical."""
    return m[k] * r[6] + m[k + 1] * r[7] + m[k + 2] * r[8]


@njit(cache=True, error_model="numpy")
def _approach(waves, origin, r, box, degree, limit, time, swell, flat):
    """Bring the waves to a hull with its middle and half sides in `box`, in its own frame, by its `local.plan`.

    Rows of `swell` become A cos and A sin of the phase over the middle, the wave vector in the hull's
    frame (3), and in the world's (2); of those waves that the polynomial `flat` does not hold, see
    `local`. It has what the others add, but for its plane. Gives the elevation over the middle, from
    the still level, its gradient in the hull's frame, how many waves are in `swell`, and by how much the
    phase of any changes over the hull.
    """
    eta = g0 = g1 = g2 = steepest = 0.0
    x, y, _ = placed(origin, r, box[0], box[1], box[2])
    radius = math.sqrt(box[3] ** 2 + box[4] ** 2 + box[5] ** 2)
    many, near = waves.shape[0], 0
    flat[:] = 0.0
    for w in range(many):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        phase = kx * x + ky * y - waves[w, 3] * time + waves[w, 4]
        crest, slope = amplitude * math.cos(phase), amplitude * math.sin(phase)
        steepest = max(steepest, math.sqrt(kx * kx + ky * ky))
        if local.remainder(waves, w, radius) <= limit:
            local.add_series(flat, 0, degree, crest, slope, kx, ky)
            continue
        k0, k1, k2 = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
        swell[near, 0], swell[near, 1], swell[near, 2], swell[near, 3], swell[near, 4] = (
            crest,
            slope,
            k0,
            k1,
            k2,
        )
        swell[near, 5], swell[near, 6] = kx, ky
        near += 1
        eta += crest
        g0, g1, g2 = g0 - slope * k0, g1 - slope * k1, g2 - slope * k2
    # coefficients of 1, y and x
    one, sx, sy = flat[0], flat[degree + 1], flat[1]
    flat[0] = flat[1] = flat[degree + 1] = 0.0
    g0, g1, g2 = g0 + sx * r[0] + sy * r[3], g1 + sx * r[1] + sy * r[4], g2 + sx * r[2] + sy * r[5]
    return eta + one, g0, g1, g2, near, steepest * radius


@njit(cache=True, error_model="numpy")
def _add_rest(
    vertices, first, last, c0, c1, c2, r, swell, waves, flat, degree, smooth, doubled, depths, room
):
    """Add to depths under the plane, of vertices from `first` up to `last`, the rest of the elevation."""
    if smooth:
        for n in range(first, last):
            x, y, _ = _turned(r, vertices[n, 0] - c0, vertices[n, 1] - c1, vertices[n, 2] - c2)
            room[0, n - first], room[1, n - first] = x, y
        local.add_at_many(flat, 0, degree, room[0], room[1], last - first, room[2], room[3], depths)
    for w in range(waves):
        crest, slope, k0, k1, k2 = swell[w, 0], swell[w, 1], swell[w, 2], swell[w, 3], swell[w, 4]
        middle = k0 * c0 + k1 * c1 + k2 * c2
        for n in range(first, last):
            sine, cosine = bend(
                k0 * vertices[n, 0] + k1 * vertices[n, 1] + k2 * vertices[n, 2] - middle, doubled
            )
            depths[n - first] += crest * cosine - slope * sine


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
"""Square of the ends' distance, over that of their distances from the middle, for which one point along a cut is enough."""


@njit(cache=True, error_model="numpy")
def _waterplane(
    px, py, qx, qy, height, gx, gy, swell, waves, flat, degree, smooth, ray, panels, doubled
):
    """Of the rest e over the triangle from the middle of the hull to a cut p q, all seen from above.

    Gives the integrals of e, x e, y e and (plane + e / 2) e. The plane has the `height` over the
    middle, and a gradient g. By Gauss outward, in `panels` of at most `PANEL` / k, and along the cut.
    """
    i0 = ix = iy = iz = 0.0
    apart = (qx - px) * (qx - px) + (qy - py) * (qy - py)
    slim = apart <= SLIM * (px * px + py * py + qx * qx + qy * qy)
    for n in range(1 if slim else 2):
        along, share = _ONE[0] if slim else _TWO[n]
        ex, ey = px + along * (qx - px), py + along * (qy - py)
        if smooth:
            local.along_ray(flat, degree, ex, ey, ray)
        for panel in range(panels):
            for out, weight in _FOUR:
                u = (panel + out) / panels
                x, y = u * ex, u * ey
                e = local.on_ray(ray, degree, u) if smooth else 0.0
                for w in range(waves):
                    sine, cosine = bend(swell[w, 5] * x + swell[w, 6] * y, doubled)
                    e += swell[w, 0] * cosine - swell[w, 1] * sine
                e_dA = u * weight * share / panels * e
                i0 += e_dA
                ix += x * e_dA
                iy += y * e_dA
                iz += (height + gx * x + gy * y + 0.5 * e) * e_dA
    whole = px * qy - py * qx
    return whole * i0, whole * ix, whole * iy, whole * iz


@njit(cache=True, error_model="numpy")
def _walk(
    vertices, faces, areas, spans, boxes, moments, start, end, origin, r, level, waves, time, hull, curvature, scratch, swell
):  # fmt: skip
    """Volume, first moments about the origin, horizontal and wetted area under the nodes from `start` up to `end`.

    Triangles are visited at the surface alone: nodes that are wholly wet are answered by their moments.
    `hull` is the hull's row of `whole`, and `curvature` a bound of the surface's over it.
    """
    v = lx = ly = lz = q = p = area = i0 = ix = iy = iz = 0.0
    depths = scratch[0]
    c0, c1, c2 = hull[5], hull[6], hull[7]
    degree = int(hull[12])
    flat, ray = np.empty(local.FLAT), np.empty(local.MOST + 1)
    eta, s0, s1, s2, many, reach = _approach(
        waves, origin, r, hull[5:], degree, hull[13], time, swell, flat
    )
    wavy, smooth = waves.shape[0] > 0, many < waves.shape[0]
    doubled, panels = doublings(reach), min(max(1, math.ceil(reach / PANEL)), PANELS)
    # the plane, as the depth under it: d + g (x - c)
    g0, g1, g2 = s0 - r[6], s1 - r[7], s2 - r[8]
    d = level + eta - origin[2] - (r[6] * c0 + r[7] * c1 + r[8] * c2)
    height = level + eta - origin[2]
    gx, gy, _ = _turned(r, s0, s1, s2)
    i = start
    while i < end:
        b0, b1, b2 = boxes[i, 0], boxes[i, 1], boxes[i, 2]
        e0, e1, e2 = boxes[i, 3], boxes[i, 4], boxes[i, 5]
        y0, y1, y2 = b0 - c0, b1 - c1, b2 - c2
        plane = d + g0 * y0 + g1 * y1 + g2 * y2
        # the depth of the middle of the box, and how much less or more any point of it has
        depth, h0, h1, h2 = plane, g0, g1, g2
        if smooth:
            x, y, _ = _turned(r, y0, y1, y2)
            e, sx, sy = local.with_gradient(flat, 0, degree, x, y)
            depth += e
            h0, h1, h2 = (
                h0 + sx * r[0] + sy * r[3],
                h1 + sx * r[1] + sy * r[4],
                h2 + sx * r[2] + sy * r[5],
            )
        for w in range(many):
            crest, slope, k0, k1, k2 = (
                swell[w, 0],
                swell[w, 1],
                swell[w, 2],
                swell[w, 3],
                swell[w, 4],
            )
            angle = k0 * y0 + k1 * y1 + k2 * y2
            sine, cosine = bend(angle, doubled)
            depth += crest * cosine - slope * sine
            change = -slope * cosine - crest * (sine + angle)
            h0, h1, h2 = h0 + change * k0, h1 + change * k1, h2 + change * k2
        reach = (
            abs(h0) * e0
            + abs(h1) * e1
            + abs(h2) * e2
            + 0.5 * curvature * (e0 * e0 + e1 * e1 + e2 * e2)
        )
        after = spans[i, 4]
        if depth <= -reach:
            i = after
            continue
        if depth >= reach:
            m = moments[i]
            # contracted with the vertical
            s = _vertical(m, 0, r)
            t0, t1, t2 = _vertical(m, 3, r), _vertical(m, 6, r), _vertical(m, 9, r)
            u00, u11, u22 = _vertical(m, 12, r), _vertical(m, 15, r), _vertical(m, 18, r)
            u01, u02, u12 = _vertical(m, 21, r), _vertical(m, 24, r), _vertical(m, 27, r)
            tilted = g0 * t0 + g1 * t1 + g2 * t2
            n0 = g0 * u00 + g1 * u01 + g2 * u02
            n1 = g0 * u01 + g1 * u11 + g2 * u12
            n2 = g0 * u02 + g1 * u12 + g2 * u22
            part = plane * s + tilted
            v += part
            lx += b0 * part + plane * t0 + n0
            ly += b1 * part + plane * t1 + n1
            lz += b2 * part + plane * t2 + n2
            q += plane * (part + tilted) + g0 * n0 + g1 * n1 + g2 * n2
            p += s
            area += m[30]
            i = after
            continue
        if after > i + 1:
            i += 1
            continue
        base, top = spans[i, 2], spans[i, 3]
        still = d - (g0 * c0 + g1 * c1 + g2 * c2)
        for n in range(base, top):
            depths[n - base] = (
                still + g0 * vertices[n, 0] + g1 * vertices[n, 1] + g2 * vertices[n, 2]
            )
        if wavy:
            _add_rest(
                vertices,
                base,
                top,
                c0,
                c1,
                c2,
                r,
                swell,
                many,
                flat,
                degree,
                smooth,
                doubled,
                depths,
                scratch[1:],
            )
        for f in range(spans[i, 0], spans[i, 1]):
            j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
            w0, w1, w2 = depths[j - base], depths[k - base], depths[o - base]
            if w0 <= 0.0 and w1 <= 0.0 and w2 <= 0.0:
                continue
            a = r[6] * areas[f, 0] + r[7] * areas[f, 1] + r[8] * areas[f, 2]
            x0, y0, z0 = vertices[j, 0], vertices[j, 1], vertices[j, 2]
            x1, y1, z1 = vertices[k, 0], vertices[k, 1], vertices[k, 2]
            x2, y2, z2 = vertices[o, 0], vertices[o, 1], vertices[o, 2]
            d0, d1, d2 = w0, w1, w2
            if wavy:
                d0 = still + g0 * x0 + g1 * y0 + g2 * z0
                d1 = still + g0 * x1 + g1 * y1 + g2 * z1
                d2 = still + g0 * x2 + g1 * y2 + g2 * z2
            if w0 > 0.0 and w1 > 0.0 and w2 > 0.0:
                some, fraction = _moments(a, x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2), 1.0
            else:
                some, fraction, one, other = cut(
                    a, x0, y0, z0, d0, w0, x1, y1, z1, d1, w1, x2, y2, z2, d2, w2
                )
                if wavy:
                    px, py, _ = _turned(r, one[0] - c0, one[1] - c1, one[2] - c2)
                    qx, qy, _ = _turned(r, other[0] - c0, other[1] - c1, other[2] - c2)
                    rest = _waterplane(
                        px,
                        py,
                        qx,
                        qy,
                        height,
                        gx,
                        gy,
                        swell,
                        many,
                        flat,
                        degree,
                        smooth,
                        ray,
                        panels,
                        doubled,
                    )
                    i0, ix, iy, iz = i0 + rest[0], ix + rest[1], iy + rest[2], iz + rest[3]
            v += some[0]
            lx += some[1]
            ly += some[2]
            lz += some[3]
            q += some[4]
            p += fraction * a
            area += fraction * areas[f, 3]
        i = after
    mx, my, mz = _turned(r, lx, ly, lz)
    cx, cy, _ = _turned(r, c0, c1, c2)
    fill = hull[11]
    i0, ix, iy, iz = fill * i0, fill * ix, fill * iy, fill * iz
    return i0 - v, ix + cx * i0 - mx, iy + cy * i0 - my, iz - mz - 0.5 * q, -p, area


@njit(cache=True, error_model="numpy")
def is_rotation(r):
    """Whether a matrix (3, 3) turns, to one part in a million, and neither stretches nor mirrors."""
    for i in range(3):
        for j in range(i, 3):
            product = r[i, 0] * r[j, 0] + r[i, 1] * r[j, 1] + r[i, 2] * r[j, 2]
            if not abs(product - (1.0 if i == j else 0.0)) <= 1e-6:
                return False
    x = r[1, 1] * r[2, 2] - r[1, 2] * r[2, 1]
    y = r[1, 2] * r[2, 0] - r[1, 0] * r[2, 2]
    z = r[1, 0] * r[2, 1] - r[1, 1] * r[2, 0]
    return r[0, 0] * x + r[0, 1] * y + r[0, 2] * z > 0.0


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
    waves, level, whole, frames = sea.waves, sea.level, hulls.whole, hulls.frames
    for h in range(frames.shape[0]):
        origin, r = geoms.geom_xpos[frames[h]], geoms.geom_xmat[frames[h]]
        # how deep the middle of its box lies, and how much shallower or deeper any point of it can be
        x, y, z = placed(origin, r, whole[h, 5], whole[h, 6], whole[h, 7])
        ex, ey, ez = whole[h, 8], whole[h, 9], whole[h, 10]
        eta, reach, curvature = swing(waves, x, y, time, math.sqrt(ex * ex + ey * ey + ez * ez))
        depth = level + eta - z
        reach += abs(r[6]) * ex + abs(r[7]) * ey + abs(r[8]) * ez
        if not math.isfinite(depth):
            out[h, :] = math.nan
            continue
        if depth >= reach:
            out[h, 0], out[h, 4], out[h, 5] = whole[h, 0], whole[h, 4], 0.0
            out[h, 1], out[h, 2], out[h, 3] = placed(
                origin, r, whole[h, 1], whole[h, 2], whole[h, 3]
            )
            continue
        out[h, 0], out[h, 4], out[h, 5] = 0.0, 0.0, 0.0
        out[h, 1:4] = math.nan
        if depth <= -reach:
            continue
        v, mx, my, mz, p, area = _walk(
            hulls.vertices, hulls.faces, hulls.areas, hulls.spans, hulls.boxes, hulls.moments, hulls.nodes[h],
            hulls.nodes[h + 1], origin, r, level, waves, time, whole[h], curvature, scratch.depths, scratch.swell,
        )  # fmt: skip
        # never more than all of it, and below the rounding of the sums there is no centroid to speak of
        if v >= whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = whole[h, 0], area, p
            out[h, 1], out[h, 2], out[h, 3] = placed(
                origin, r, whole[h, 1], whole[h, 2], whole[h, 3]
            )
        elif v > 1e-14 * whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = v, area, p
            out[h, 1], out[h, 2], out[h, 3] = (
                origin[0] + mx / v,
                origin[1] + my / v,
                origin[2] + mz / v,
            )

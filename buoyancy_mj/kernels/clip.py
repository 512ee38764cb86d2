"""The wet part of closed triangle meshes under a surface: exact on triangles, no lid needed.

With the depth d = elevation - z, the field (0, 0, -d) has divergence 1 in the water and vanishes on
the surface, so by Gauss

    V = - int d n_z dA,   int x dV = - int x d n_z dA,   int z dV = - int (z + d/2) d n_z dA

over the wet side of the mesh alone. With d linear on a triangle the integrands are quadratic, and
the integral of a product of linear functions f, g over a triangle of area a is exactly
a (sum f sum g + sum f g) / 12. All of it is summed in the frame of the hull, where the vertices
stand still and the vertical leans.
"""

import math

from numba import njit

from buoyancy_mj.kernels.waves import SHORT, elevation, short_sincos

# columns of one row of results
VOLUME, CENTROID, WETTED_AREA, WATERPLANE_AREA, COLUMNS = 0, slice(1, 4), 4, 5, 6


@njit(cache=True, inline="always")
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


@njit(cache=True)
def _cut(a, x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2):
    """`_moments` of the wet part of a triangle with one or two wet corners, and the fraction of its area that is wet."""
    wet0, wet1, wet2 = d0 > 0.0, d1 > 0.0, d2 > 0.0
    # turn the triangle so that corner 0 is alone on its side
    alone = int(wet0) + int(wet1) + int(wet2) == 1
    if wet1 == alone and wet0 != alone and wet2 != alone:
        x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2 = x1, y1, z1, d1, x2, y2, z2, d2, x0, y0, z0, d0
    elif wet2 == alone and wet0 != alone and wet1 != alone:
        x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2 = x2, y2, z2, d2, x0, y0, z0, d0, x1, y1, z1, d1
    # where its two edges meet the surface
    s, t = d0 / (d0 - d1), d0 / (d0 - d2)
    px, py, pz = x0 + s * (x1 - x0), y0 + s * (y1 - y0), z0 + s * (z1 - z0)
    qx, qy, qz = x0 + t * (x2 - x0), y0 + t * (y2 - y0), z0 + t * (z2 - z0)
    if alone:
        return _moments(s * t * a, x0, y0, z0, d0, px, py, pz, 0.0, qx, qy, qz, 0.0), s * t
    v, mx, my, mz, w = _moments((1.0 - s) * a, px, py, pz, 0.0, x1, y1, z1, d1, x2, y2, z2, d2)
    u, nx, ny, nz, o = _moments(s * (1.0 - t) * a, px, py, pz, 0.0, x2, y2, z2, d2, qx, qy, qz, 0.0)
    return (v + u, mx + nx, my + ny, mz + nz, w + o), 1.0 - s * t


@njit(cache=True, inline="always")
def _turned(r, x, y, z):
    """A vector of a frame, turned by the row-major rotation r (9,)."""
    return r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z


@njit(cache=True, inline="always")
def _placed(origin, r, x, y, z):
    """A point of a frame, in the world."""
    tx, ty, tz = _turned(r, x, y, z)
    return origin[0] + tx, origin[1] + ty, origin[2] + tz


@njit(cache=True)
def _triangles(vertices, base, faces, areas, first, last, r, depths):
    """`_moments` under the faces from `first` up to `last`, horizontal and wetted area; depths begin with vertex `base`."""
    v = mx = my = mz = q = p = area = 0.0
    up0, up1, up2 = r[6], r[7], r[8]
    for f in range(first, last):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        d0, d1, d2 = depths[i - base], depths[j - base], depths[k - base]
        if d0 <= 0.0 and d1 <= 0.0 and d2 <= 0.0:
            continue
        a = up0 * areas[f, 0] + up1 * areas[f, 1] + up2 * areas[f, 2]
        x0, y0, z0 = vertices[i, 0], vertices[i, 1], vertices[i, 2]
        x1, y1, z1 = vertices[j, 0], vertices[j, 1], vertices[j, 2]
        x2, y2, z2 = vertices[k, 0], vertices[k, 1], vertices[k, 2]
        if d0 > 0.0 and d1 > 0.0 and d2 > 0.0:
            part = _moments(a, x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2)
            p += a
            area += areas[f, 3]
        else:
            part, fraction = _cut(a, x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2)
            p += fraction * a
            area += fraction * areas[f, 3]
        v += part[0]
        mx += part[1]
        my += part[2]
        mz += part[3]
        q += part[4]
    return v, mx, my, mz, q, p, area


@njit(cache=True, inline="always")
def _vertical(m, k, r):
    """Three numbers of a row of moments, along the world's vertical."""
    return m[k] * r[6] + m[k + 1] * r[7] + m[k + 2] * r[8]


@njit(cache=True)
def _approach(waves, origin, r, cx, cy, cz, radius, time, swell):
    """Bring the waves to a hull, whose middle is c and half diagonal `radius`, in its own frame.

    Rows of `swell` become A cos and A sin of the phase in the middle, and the wave vector. Gives
    bounds of the surface's second and third derivatives, and whether phases differ by short angles.
    """
    curvature = twist = steepest = 0.0
    x, y, _ = _placed(origin, r, cx, cy, cz)
    for w in range(waves.shape[0]):
        amplitude, kx, ky = waves[w, 0], waves[w, 1], waves[w, 2]
        k = math.hypot(kx, ky)
        curvature += abs(amplitude) * k * k
        twist += abs(amplitude) * k * k * k
        steepest = max(steepest, k)
        phase = kx * x + ky * y - waves[w, 3] * time + waves[w, 4]
        row = swell[w]
        row[0], row[1] = amplitude * math.cos(phase), amplitude * math.sin(phase)
        row[2], row[3], row[4] = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
    return curvature, twist, steepest * radius <= SHORT


@njit(cache=True)
def _depths(vertices, first, last, dry, r, cx, cy, cz, swell, waves, short, depths):
    """Depths of vertices from `first` up to `last`; `dry` is the height of the still level over the hull's origin."""
    for n in range(first, last):
        depths[n - first] = dry - (r[6] * vertices[n, 0] + r[7] * vertices[n, 1] + r[8] * vertices[n, 2])
    for w in range(waves):
        c, s, k0, k1, k2 = swell[w, 0], swell[w, 1], swell[w, 2], swell[w, 3], swell[w, 4]
        middle = k0 * cx + k1 * cy + k2 * cz
        if short:
            for n in range(first, last):
                sine, cosine = short_sincos(k0 * vertices[n, 0] + k1 * vertices[n, 1] + k2 * vertices[n, 2] - middle)
                depths[n - first] += c * cosine - s * sine
        else:
            for n in range(first, last):
                angle = k0 * vertices[n, 0] + k1 * vertices[n, 1] + k2 * vertices[n, 2] - middle
                depths[n - first] += c * math.cos(angle) - s * math.sin(angle)


@njit(cache=True)
def _walk(
    vertices, faces, areas, spans, boxes, moments, start, end, origin, r, level, waves, time, slack, middle, depths, swell
):  # fmt: skip
    """Volume, first moments about the origin, horizontal and wetted area under the nodes from `start` up to `end`.

    Triangles are visited at the surface alone. Under a node small enough for it the depth is taken
    as d + g y + y H y / 2 about the middle a of its box, y = x - a, with the gradient g and the
    curvature H of the surface there; on still water that is the depth itself, everywhere. Nodes in
    it that are wholly wet, and small enough for that, are answered by their moments, which lack what
    is of third order in y. How small, `tree.slack` says.
    """
    v = lx = ly = lz = q = p = area = 0.0
    x0, x1, x2 = middle[0], middle[1], middle[2]
    radius = math.sqrt(middle[3] ** 2 + middle[4] ** 2 + middle[5] ** 2)
    curvature, twist, short = _approach(waves, origin, r, x0, x1, x2, radius, time, swell)
    dry = level - origin[2]
    # the depth about a, which holds for nodes before `until`
    until = start
    a0 = a1 = a2 = d = g0 = g1 = g2 = h00 = h11 = h22 = h01 = h02 = h12 = 0.0
    i = start
    while i < end:
        cx, cy, cz = boxes[i, 0], boxes[i, 1], boxes[i, 2]
        ex, ey, ez = boxes[i, 3], boxes[i, 4], boxes[i, 5]
        squared = ex * ex + ey * ey + ez * ez
        cubed = squared * math.sqrt(squared)
        bend = 0.5 * curvature * squared
        if i >= until:
            a0, a1, a2 = cx, cy, cz
            d = dry - (r[6] * cx + r[7] * cy + r[8] * cz)
            g0, g1, g2 = -r[6], -r[7], -r[8]
            h00 = h11 = h22 = h01 = h02 = h12 = 0.0
            for w in range(waves.shape[0]):
                k0, k1, k2 = swell[w, 2], swell[w, 3], swell[w, 4]
                angle = k0 * (cx - x0) + k1 * (cy - x1) + k2 * (cz - x2)
                sine, cosine = short_sincos(angle) if short else (math.sin(angle), math.cos(angle))
                crest, slope = swell[w, 0] * cosine - swell[w, 1] * sine, swell[w, 1] * cosine + swell[w, 0] * sine
                d += crest
                g0 -= slope * k0
                g1 -= slope * k1
                g2 -= slope * k2
                h00 -= crest * k0 * k0
                h11 -= crest * k1 * k1
                h22 -= crest * k2 * k2
                h01 -= crest * k0 * k1
                h02 -= crest * k0 * k2
                h12 -= crest * k1 * k2
            if twist * cubed <= 6.0 * slack[0]:
                until = spans[i, 4]
        # about the middle of this node
        y0, y1, y2 = cx - a0, cy - a1, cz - a2
        w0, w1, w2 = h00 * y0 + h01 * y1 + h02 * y2, h01 * y0 + h11 * y1 + h12 * y2, h02 * y0 + h12 * y1 + h22 * y2
        depth = d + (g0 + 0.5 * w0) * y0 + (g1 + 0.5 * w1) * y1 + (g2 + 0.5 * w2) * y2
        b0, b1, b2 = g0 + w0, g1 + w1, g2 + w2
        reach = abs(b0) * ex + abs(b1) * ey + abs(b2) * ez + bend
        after = spans[i, 4]
        if depth <= -reach:
            i = after
            continue
        wet = depth >= reach
        if wet and i < until and curvature * cubed <= 2.0 * slack[1]:
            m = moments[i]
            # contracted with the vertical
            s = _vertical(m, 0, r)
            t0, t1, t2 = _vertical(m, 3, r), _vertical(m, 6, r), _vertical(m, 9, r)
            u00, u11, u22 = _vertical(m, 12, r), _vertical(m, 15, r), _vertical(m, 18, r)
            u01, u02, u12 = _vertical(m, 21, r), _vertical(m, 24, r), _vertical(m, 27, r)
            bent = 0.5 * (h00 * u00 + h11 * u11 + h22 * u22) + h01 * u01 + h02 * u02 + h12 * u12
            tilted = b0 * t0 + b1 * t1 + b2 * t2
            n0 = b0 * u00 + b1 * u01 + b2 * u02
            n1 = b0 * u01 + b1 * u11 + b2 * u12
            n2 = b0 * u02 + b1 * u12 + b2 * u22
            part = depth * s + tilted + bent
            v += part
            lx += cx * part + depth * t0 + n0
            ly += cy * part + depth * t1 + n1
            lz += cz * part + depth * t2 + n2
            q += depth * (depth * s + 2.0 * (tilted + bent)) + b0 * n0 + b1 * n1 + b2 * n2
            p += s
            area += m[30]
            i = after
            continue
        # down the tree, unless it ends here, or all below is wet too and too large to answer
        if after > i + 1 and not (wet and curvature * boxes[i, 6] > 2.0 * slack[1]):
            i += 1
            continue
        base, top = spans[i, 2], spans[i, 3]
        if i < until:
            for n in range(base, top):
                y0, y1, y2 = vertices[n, 0] - a0, vertices[n, 1] - a1, vertices[n, 2] - a2
                w0 = g0 + 0.5 * (h00 * y0 + h01 * y1 + h02 * y2)
                w1 = g1 + 0.5 * (h01 * y0 + h11 * y1 + h12 * y2)
                w2 = g2 + 0.5 * (h02 * y0 + h12 * y1 + h22 * y2)
                depths[n - base] = d + w0 * y0 + w1 * y1 + w2 * y2
        else:
            _depths(vertices, base, top, dry, r, x0, x1, x2, swell, waves.shape[0], short, depths)
        some = _triangles(vertices, base, faces, areas, spans[i, 0], spans[i, 1], r, depths)
        v += some[0]
        lx += some[1]
        ly += some[2]
        lz += some[3]
        q += some[4]
        p += some[5]
        area += some[6]
        i = after
    mx, my, mz = _turned(r, lx, ly, lz)
    return -v, -mx, -my, -mz - 0.5 * q, -p, area


@njit(cache=True)
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


@njit(cache=True)
def submerge_hulls(
    vertices,  # (v, 3) of all hulls, in the frame of each; leaf by leaf, so that leaves share none
    faces,  # (f, 3) into vertices, in the order of the leaves
    areas,  # (f, 4) vector area of each face, and its length
    nodes,  # (h + 1,) first node of each hull
    spans,  # (n, 5) of the nodes: first face and last, first vertex and last, the node behind all below; see `tree`
    boxes,  # (n, 7)
    moments,  # (n, 31)
    slacks,  # (h, 2) see `tree.slack`
    whole,  # (h, 11) volume, centroid, area of each whole hull, middle and half sides of its bounding box
    frames,  # (h,) row of each hull in positions and rotations
    positions,  # (n, 3) of the frames in the world
    rotations,  # (n, 9) world_from_frame, row-major
    level,
    waves,  # (w, 6)
    time,
    depths,  # scratch, as long as the most vertices of a hull
    swell,  # (w, 5) scratch
    out,  # (h, 6) volume, centroid (world; NaN when dry), wetted area, waterplane area
):
    """The submersion of each hull; only hulls that the surface may cut cost more than a few operations."""
    amplitude = steepness = 0.0
    for i in range(waves.shape[0]):
        amplitude += abs(waves[i, 0])
        steepness += abs(waves[i, 0]) * math.hypot(waves[i, 1], waves[i, 2])
    for h in range(frames.shape[0]):
        origin, r = positions[frames[h]], rotations[frames[h]]
        # how deep the middle of its box lies, and how much shallower or deeper any point of it can be
        x, y, z = _placed(origin, r, whole[h, 5], whole[h, 6], whole[h, 7])
        depth = level + elevation(waves, x, y, time) - z
        ex, ey, ez = whole[h, 8], whole[h, 9], whole[h, 10]
        reach = abs(r[6]) * ex + abs(r[7]) * ey + abs(r[8]) * ez
        reach += min(2.0 * amplitude, steepness * math.sqrt(ex * ex + ey * ey + ez * ez))
        if not math.isfinite(depth):
            out[h, :] = math.nan
            continue
        if depth >= reach:
            out[h, 0], out[h, 4], out[h, 5] = whole[h, 0], whole[h, 4], 0.0
            out[h, 1], out[h, 2], out[h, 3] = _placed(origin, r, whole[h, 1], whole[h, 2], whole[h, 3])
            continue
        out[h, 0], out[h, 4], out[h, 5] = 0.0, 0.0, 0.0
        out[h, 1:4] = math.nan
        if depth <= -reach:
            continue
        v, mx, my, mz, p, area = _walk(
            vertices, faces, areas, spans, boxes, moments, nodes[h], nodes[h + 1], origin, r, level, waves, time, slacks[h],
            whole[h, 5:], depths, swell,
        )  # fmt: skip
        # never more than all of it, and below the rounding of the sums there is no centroid to speak of
        if v >= whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = whole[h, 0], area, p
            out[h, 1], out[h, 2], out[h, 3] = _placed(origin, r, whole[h, 1], whole[h, 2], whole[h, 3])
        elif v > 1e-14 * whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = v, area, p
            out[h, 1], out[h, 2], out[h, 3] = origin[0] + mx / v, origin[1] + my / v, origin[2] + mz / v

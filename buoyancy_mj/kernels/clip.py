"""The wet part of closed triangle meshes under a surface: exact on triangles, no lid needed.

With the depth d = elevation - z, the field (0, 0, -d) has divergence 1 in the water and vanishes on
the surface, so by Gauss

    V = - int d n_z dA,   int x dV = - int x d n_z dA,   int z dV = - int (z + d/2) d n_z dA

over the wet side of the mesh alone. With d linear on a triangle the integrands are quadratic, and
the integral of a product of linear functions f, g over a triangle of area a is exactly
a (sum f sum g + sum f g) / 12.
"""

import math

from numba import njit

from buoyancy_mj.kernels.waves import elevation

# columns of one row of results
VOLUME, CENTROID, WETTED_AREA, WATERPLANE_AREA, COLUMNS = 0, slice(1, 4), 4, 5, 6


@njit(cache=True, inline="always")
def _moments(x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2):
    """Volume, first moments and signed horizontal area under one wholly wet triangle."""
    # n_z dA over the triangle: its signed area seen from above
    a = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    d = d0 + d1 + d2
    w0, w1, w2 = z0 + 0.5 * d0, z1 + 0.5 * d1, z2 + 0.5 * d2
    return (
        -a * d / 3.0,
        -a * (d * (x0 + x1 + x2) + d0 * x0 + d1 * x1 + d2 * x2) / 12.0,
        -a * (d * (y0 + y1 + y2) + d0 * y0 + d1 * y1 + d2 * y2) / 12.0,
        -a * (d * (w0 + w1 + w2) + d0 * w0 + d1 * w1 + d2 * w2) / 12.0,
        -a,
    )


@njit(cache=True)
def _cut(x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2):
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
    ax, ay, az = x0 + s * (x1 - x0), y0 + s * (y1 - y0), z0 + s * (z1 - z0)
    bx, by, bz = x0 + t * (x2 - x0), y0 + t * (y2 - y0), z0 + t * (z2 - z0)
    if alone:
        return _moments(x0, y0, z0, d0, ax, ay, az, 0.0, bx, by, bz, 0.0), s * t
    v, mx, my, mz, p = _moments(ax, ay, az, 0.0, x1, y1, z1, d1, x2, y2, z2, d2)
    w, nx, ny, nz, q = _moments(ax, ay, az, 0.0, x2, y2, z2, d2, bx, by, bz, 0.0)
    return (v + w, mx + nx, my + ny, mz + nz, p + q), 1.0 - s * t


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
def _triangles(faces, face_areas, first, last, points):
    """Volume, first moments, horizontal area and wetted area under the faces from `first` up to `last`, placed before."""
    v = mx = my = mz = p = area = 0.0
    for f in range(first, last):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        d0, d1, d2 = points[a, 3], points[b, 3], points[c, 3]
        if d0 <= 0.0 and d1 <= 0.0 and d2 <= 0.0:
            continue
        x0, y0, z0 = points[a, 0], points[a, 1], points[a, 2]
        x1, y1, z1 = points[b, 0], points[b, 1], points[b, 2]
        x2, y2, z2 = points[c, 0], points[c, 1], points[c, 2]
        if d0 > 0.0 and d1 > 0.0 and d2 > 0.0:
            part = _moments(x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2)
            area += face_areas[f]
        else:
            part, fraction = _cut(x0, y0, z0, d0, x1, y1, z1, d1, x2, y2, z2, d2)
            area += fraction * face_areas[f]
        v += part[0]
        mx += part[1]
        my += part[2]
        mz += part[3]
        p += part[4]
    return v, mx, my, mz, p, area


@njit(cache=True)
def _place(vertices, first, last, origin, r, level, waves, time, points):
    """Vertices from `first` up to `last`, relative to the origin, turned as the world, and their depths."""
    for i in range(first, last):
        x, y, z = _turned(r, vertices[i, 0], vertices[i, 1], vertices[i, 2])
        points[i, 0], points[i, 1], points[i, 2] = x, y, z
        points[i, 3] = level + elevation(waves, origin[0] + x, origin[1] + y, time) - (origin[2] + z)


@njit(cache=True)
def _place_corners(vertices, faces, first, last, stamp, stamps, origin, r, level, waves, time, points):
    """The same of the corners of faces from `first` up to `last`, unless they bear the stamp already."""
    for f in range(first, last):
        for corner in range(3):
            i = faces[f, corner]
            if stamps[i] == stamp:
                continue
            stamps[i] = stamp
            x, y, z = _turned(r, vertices[i, 0], vertices[i, 1], vertices[i, 2])
            points[i, 0], points[i, 1], points[i, 2] = x, y, z
            points[i, 3] = level + elevation(waves, origin[0] + x, origin[1] + y, time) - (origin[2] + z)


@njit(cache=True)
def _walk(
    vertices, first_vertex, last_vertex, faces, face_areas, start, end, first, last, skip, boxes, moments, origin, r, level,
    waves, time, slack, stamp, points, stamps, leaves,
):  # fmt: skip
    """The same under the nodes from `start` up to `end`: triangles are visited at the surface alone.

    Under a node that is wholly wet the depth is taken as d + g y + y H y / 2 about the middle of its
    box, y = x - o, with the gradient g and the curvature H of the surface there: on still water
    that is the depth itself. In waves the moments lack what is of third order in y, see `exact`.
    """
    v = p = area = 0.0
    count = due = 0
    # moments in the frame of the hull, and the integral of d^2 dA_z
    lx = ly = lz = q = 0.0
    curvature = 0.0
    for w in range(waves.shape[0]):
        curvature += abs(waves[w, 0]) * (waves[w, 1] ** 2 + waves[w, 2] ** 2)
    i = start
    while i < end:
        cx, cy, cz = boxes[i, 0], boxes[i, 1], boxes[i, 2]
        x, y, z = _turned(r, cx, cy, cz)
        eta = ux = uy = h00 = h11 = h22 = h01 = h02 = h12 = 0.0
        for w in range(waves.shape[0]):
            kx, ky = waves[w, 1], waves[w, 2]
            phase = kx * (origin[0] + x) + ky * (origin[1] + y) - waves[w, 3] * time + waves[w, 4]
            crest, slope = waves[w, 0] * math.cos(phase), waves[w, 0] * math.sin(phase)
            eta += crest
            ux -= kx * slope
            uy -= ky * slope
            k0, k1, k2 = kx * r[0] + ky * r[3], kx * r[1] + ky * r[4], kx * r[2] + ky * r[5]
            h00 -= 0.5 * crest * k0 * k0
            h11 -= 0.5 * crest * k1 * k1
            h22 -= 0.5 * crest * k2 * k2
            h01 -= crest * k0 * k1
            h02 -= crest * k0 * k2
            h12 -= crest * k1 * k2
        d = level + eta - (origin[2] + z)
        g0, g1, g2 = ux * r[0] + uy * r[3] - r[6], ux * r[1] + uy * r[4] - r[7], ux * r[2] + uy * r[5] - r[8]
        ex, ey, ez = boxes[i, 3], boxes[i, 4], boxes[i, 5]
        squared = ex * ex + ey * ey + ez * ez
        bend = 0.5 * curvature * squared
        reach = abs(g0) * ex + abs(g1) * ey + abs(g2) * ez + bend
        if d <= -reach:
            i = skip[i]
            continue
        if d >= reach and bend * math.sqrt(squared) <= slack:
            m = moments[i]
            # contracted with the vertical
            s = _vertical(m, 0, r)
            t0, t1, t2 = _vertical(m, 3, r), _vertical(m, 6, r), _vertical(m, 9, r)
            u00, u11, u22 = _vertical(m, 12, r), _vertical(m, 15, r), _vertical(m, 18, r)
            u01, u02, u12 = _vertical(m, 21, r), _vertical(m, 24, r), _vertical(m, 27, r)
            bent = h00 * u00 + h11 * u11 + h22 * u22 + h01 * u01 + h02 * u02 + h12 * u12
            tilted = g0 * t0 + g1 * t1 + g2 * t2
            n0 = g0 * u00 + g1 * u01 + g2 * u02
            n1 = g0 * u01 + g1 * u11 + g2 * u12
            n2 = g0 * u02 + g1 * u12 + g2 * u22
            part = d * s + tilted + bent
            v -= part
            lx -= cx * part + d * t0 + n0
            ly -= cy * part + d * t1 + n1
            lz -= cz * part + d * t2 + n2
            q -= d * (d * s + 2.0 * (tilted + bent)) + g0 * n0 + g1 * n1 + g2 * n2
            p -= s
            area += m[30]
        # down the tree, unless it ends here or all below is wet too and too large to answer
        elif skip[i] > i + 1 and not (d >= reach and 0.5 * curvature * boxes[i, 6] > slack):
            i += 1
            continue
        else:
            leaves[count] = i
            count += 1
            due += last[i] - first[i]
        i = skip[i]
    mx, my, mz = _turned(r, lx, ly, lz)
    mz += 0.5 * q
    # where many triangles are due, all corners are placed in one go
    total = last[start] - first[start]
    if 4 * due > total:
        _place(vertices, first_vertex, last_vertex, origin, r, level, waves, time, points)
    for n in range(count):
        i = leaves[n]
        if 4 * due <= total:
            _place_corners(vertices, faces, first[i], last[i], stamp, stamps, origin, r, level, waves, time, points)
        some = _triangles(faces, face_areas, first[i], last[i], points)
        v += some[0]
        mx += some[1]
        my += some[2]
        mz += some[3]
        p += some[4]
        area += some[5]
    return v, mx, my, mz, p, area


@njit(cache=True, inline="always")
def _vertical(m, k, r):
    """Three numbers of a row of moments, along the world's vertical."""
    return m[k] * r[6] + m[k + 1] * r[7] + m[k + 2] * r[8]


@njit(cache=True)
def submerge_hulls(
    vertices,  # (v, 3) of all hulls, in the frame of each
    vertex_starts,  # (h + 1,)
    faces,  # (f, 3) into vertices
    face_starts,  # (h + 1,)
    face_areas,  # (f,)
    nodes,  # (h + 1,) first node of each
    first,  # (n,) first, last, skip, boxes (n, 7) and moments (n, 31) of the nodes, see `tree`
    last,
    skip,
    boxes,
    moments,
    slacks,  # (h,) see `exact.slack`
    whole,  # (h, 11) volume, centroid, area of each whole hull, middle and half sides of its bounding box
    frames,  # (h,) row of each hull in positions and rotations
    positions,  # (n, 3) of the frames in the world
    rotations,  # (n, 9) world_from_frame, row-major
    level,
    waves,  # (w, 6)
    time,
    stamp,  # a number not given before
    points,  # (v, 4) scratch
    stamps,  # (v,) of integers, likewise
    leaves,  # (n,) likewise
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
        start, end = nodes[h], nodes[h + 1]
        if end == start + 1:
            _place(vertices, vertex_starts[h], vertex_starts[h + 1], origin, r, level, waves, time, points)
            v, mx, my, mz, p, area = _triangles(faces, face_areas, face_starts[h], face_starts[h + 1], points)
        else:
            v, mx, my, mz, p, area = _walk(
                vertices, vertex_starts[h], vertex_starts[h + 1], faces, face_areas, start, end, first, last, skip, boxes,
                moments, origin, r, level, waves, time, slacks[h], stamp, points, stamps, leaves,
            )  # fmt: skip
        # never more than all of it, and below the rounding of the sums there is no centroid to speak of
        if v >= whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = whole[h, 0], area, p
            out[h, 1], out[h, 2], out[h, 3] = _placed(origin, r, whole[h, 1], whole[h, 2], whole[h, 3])
        elif v > 1e-14 * whole[h, 0]:
            out[h, 0], out[h, 4], out[h, 5] = v, area, p
            out[h, 1], out[h, 2], out[h, 3] = origin[0] + mx / v, origin[1] + my / v, origin[2] + mz / v

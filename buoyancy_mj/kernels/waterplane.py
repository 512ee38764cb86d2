"""Where a level surface cuts hulls: area, moments and extents of the waterplane, along the waterline.

By Gauss each is summed over the triangles from one point to the pieces of the waterline, whose ends
are where the surface cuts the edges of the mesh: exact, and only triangles at the surface are visited.
"""

import math

from numba import njit

from buoyancy_mj.kernels.clip import cut, placed

# columns of one row of results
AREA, FIRST, SECOND, EXTENTS, COLUMNS = 0, slice(1, 3), slice(3, 6), slice(6, 10), 10


@njit(cache=True, error_model="numpy")
def waterplanes(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    about,  # (3,) the point that all is about
    level,
    depths,  # scratch
    out,  # (h, 10) integrals of 1, x, y, x x, x y, y y, each times the part that displaces; and the lowest x, y and
    # highest x, y of the waterline
):
    """The waterplane of each hull on still water, seen from above, in the world's axes."""
    vertices, faces, spans, boxes = hulls.vertices, hulls.faces, hulls.spans, hulls.boxes
    whole, frames = hulls.whole, hulls.frames
    for h in range(frames.shape[0]):
        origin, r = geoms.geom_xpos[frames[h]], geoms.geom_xmat[frames[h]]
        out[h, 0:6] = 0.0
        out[h, 6:8], out[h, 8:10] = math.inf, -math.inf
        still = level - origin[2]
        # about the middle of the hull, lest the moments cancel
        corner = (origin[0] - about[0], origin[1] - about[1], 0.0)
        mx, my, _ = placed(corner, r, whole[h, 5], whole[h, 6], whole[h, 7])
        a = ax = ay = axx = axy = ayy = 0.0
        i, end = hulls.nodes[h], hulls.nodes[h + 1]
        while i < end:
            depth = still - (r[6] * boxes[i, 0] + r[7] * boxes[i, 1] + r[8] * boxes[i, 2])
            reach = abs(r[6]) * boxes[i, 3] + abs(r[7]) * boxes[i, 4] + abs(r[8]) * boxes[i, 5]
            after = spans[i, 4]
            if abs(depth) >= reach:
                i = after
                continue
            if after > i + 1:
                i += 1
                continue
            base = spans[i, 2]
            for n in range(base, spans[i, 3]):
                depths[n - base] = still - (
                    r[6] * vertices[n, 0] + r[7] * vertices[n, 1] + r[8] * vertices[n, 2]
                )
            for f in range(spans[i, 0], spans[i, 1]):
                j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
                w0, w1, w2 = depths[j - base], depths[k - base], depths[o - base]
                wet = int(w0 > 0.0) + int(w1 > 0.0) + int(w2 > 0.0)
                if wet == 0 or wet == 3:
                    continue
                _, _, one, other = cut(
                    1.0, vertices[j, 0], vertices[j, 1], vertices[j, 2], w0, w0,
                    vertices[k, 0], vertices[k, 1], vertices[k, 2], w1, w1,
                    vertices[o, 0], vertices[o, 1], vertices[o, 2], w2, w2,
                )  # fmt: skip
                px, py, _ = placed(corner, r, one[0], one[1], one[2])
                qx, qy, _ = placed(corner, r, other[0], other[1], other[2])
                out[h, 6], out[h, 8] = min(out[h, 6], px, qx), max(out[h, 8], px, qx)
                out[h, 7], out[h, 9] = min(out[h, 7], py, qy), max(out[h, 9], py, qy)
                px, py, qx, qy = px - mx, py - my, qx - mx, qy - my
                # exact on the triangle from the middle to the cut
                twice = px * qy - py * qx
                a += twice / 2.0
                ax += twice * (px + qx) / 6.0
                ay += twice * (py + qy) / 6.0
                axx += twice * (px * px + px * qx + qx * qx) / 12.0
                ayy += twice * (py * py + py * qy + qy * qy) / 12.0
                axy += twice * (2.0 * px * py + px * qy + qx * py + 2.0 * qx * qy) / 24.0
            i = after
        fill = whole[h, 11]
        out[h, 0] = fill * a
        out[h, 1], out[h, 2] = fill * (ax + mx * a), fill * (ay + my * a)
        out[h, 3] = fill * (axx + 2.0 * mx * ax + mx * mx * a)
        out[h, 4] = fill * (axy + mx * ay + my * ax + mx * my * a)
        out[h, 5] = fill * (ayy + 2.0 * my * ay + my * my * a)

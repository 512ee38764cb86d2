"""The waterplane of hulls at a level: area, moments and extents, along the waterline.

By Gauss each is summed over the triangles from one point to the pieces of the waterline, whose ends
are where the surface cuts the edges of the mesh: exact, and only triangles at the surface are
visited.
"""

import math

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.hulls import FILL, WHOLE_MIDDLE
from buoyancy_mj.kernels.triangles import cut
from buoyancy_mj.kernels.vectors import place, triple

AREA, X, Y, XX, XY, YY, LOW_X, LOW_Y, HIGH_X, HIGH_Y, COLUMNS = range(11)
"""Columns of one row of results, and how many: integrals of 1, x, y, x x, x y and y y over the
waterplane, each times the part that displaces; and the lowest x, y and the highest x, y of the
waterline."""
INTEGRALS, LOWEST, HIGHEST = slice(AREA, LOW_X), slice(LOW_X, HIGH_X), slice(HIGH_X, COLUMNS)
"""The same columns in groups."""


@njit(cache=True, error_model="numpy")
def waterplanes(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    about,  # (3,) the point that all is about
    level,  # [m]
    depths,  # scratch, as long as the most vertices of a leaf
    out,  # (h, 10)
):
    """The waterplane of each hull on still water, seen from above, in the world's axes."""
    vertices, faces, spans, boxes = hulls.vertices, hulls.faces, hulls.spans, hulls.boxes
    whole, frames, nodes = hulls.whole, hulls.frames, hulls.nodes
    for h in range(frames.shape[0]):
        origin, r = geoms.geom_xpos[frames[h]], geoms.geom_xmat[frames[h]]
        still = level - origin[2]

        # about the middle of the hull, lest the moments cancel
        corner = (origin[0] - about[0], origin[1] - about[1], 0.0)
        c0, c1, c2 = triple(whole, h, WHOLE_MIDDLE)
        mx, my, _ = place(corner, r, c0, c1, c2)
        a = ax = ay = axx = axy = ayy = 0.0
        low_x = low_y = math.inf
        high_x = high_y = -math.inf

        # the triangles at the surface, by the tree over them
        i = nodes[h]
        end = hulls.spans[i, tree.BEHIND]
        while i < end:
            missed = _misses(boxes, i, r, still)
            if not missed and tree.is_leaf(spans, i):
                base = spans[i, tree.FIRST_VERTEX]
                for n in range(base, spans[i, tree.END_VERTEX]):
                    x, y, z = triple(vertices, n, 0)
                    depths[n - base] = still - (r[6] * x + r[7] * y + r[8] * z)
                for f in range(spans[i, tree.FIRST_FACE], spans[i, tree.END_FACE]):
                    j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
                    w0, w1, w2 = depths[j - base], depths[k - base], depths[o - base]
                    if (w0 > 0.0) == (w1 > 0.0) == (w2 > 0.0):
                        continue

                    # the ends of the cut
                    x0, y0, z0 = triple(vertices, j, 0)
                    x1, y1, z1 = triple(vertices, k, 0)
                    x2, y2, z2 = triple(vertices, o, 0)
                    _, _, one, other = cut(
                        1.0, (x0, y0, z0, w0), (x1, y1, z1, w1), (x2, y2, z2, w2), w0, w1, w2
                    )
                    px, py, _ = place(corner, r, one[0], one[1], one[2])
                    qx, qy, _ = place(corner, r, other[0], other[1], other[2])
                    low_x, high_x = min(low_x, px, qx), max(high_x, px, qx)
                    low_y, high_y = min(low_y, py, qy), max(high_y, py, qy)

                    # exact on the triangle from the middle to the cut
                    px, py, qx, qy = px - mx, py - my, qx - mx, qy - my
                    twice = px * qy - py * qx
                    a += twice / 2.0
                    ax += twice * (px + qx) / 6.0
                    ay += twice * (py + qy) / 6.0
                    axx += twice * (px * px + px * qx + qx * qx) / 12.0
                    ayy += twice * (py * py + py * qy + qy * qy) / 12.0
                    axy += twice * (2.0 * px * py + px * qy + qx * py + 2.0 * qx * qy) / 24.0
            i = tree.node_after(spans, i, missed)

        # about the point, times the part that displaces
        row, fill = out[h], whole[h, FILL]
        row[AREA] = fill * a
        row[X] = fill * (ax + mx * a)
        row[Y] = fill * (ay + my * a)
        row[XX] = fill * (axx + 2.0 * mx * ax + mx * mx * a)
        row[XY] = fill * (axy + mx * ay + my * ax + mx * my * a)
        row[YY] = fill * (ayy + 2.0 * my * ay + my * my * a)
        row[LOW_X], row[LOW_Y] = low_x, low_y
        row[HIGH_X], row[HIGH_Y] = high_x, high_y


@njit(cache=True, error_model="numpy", inline="always")
def _misses(boxes, node, r, still):
    """Whether the level surface misses the box of a node."""
    x, y, z = triple(boxes, node, tree.MIDDLE)
    depth = still - (r[6] * x + r[7] * y + r[8] * z)
    half = triple(boxes, node, tree.HALF)
    return abs(depth) >= tree.spread_in_box(half, (r[6], r[7], r[8]), 0.0)

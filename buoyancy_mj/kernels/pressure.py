"""The water's pressure in waves, integrated over the wet side of hulls: forces and torques.

By a tree: a wet node that is small beside the waves is answered by its rule, see `rules`; elsewhere
triangles are cut at the surface and have rules of their own, see `quadrature`. The pressure at the
points of all rules comes from `heads`.
"""

import math

import numpy as np
from numba import int64
from numpy.typing import NDArray

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.halving import CORNER, PART, split
from buoyancy_mj.kernels.heads import HEAD, Sea, set_depths
from buoyancy_mj.kernels.hulls import ALLOWED, WHOLE_HALF, WHOLE_MIDDLE
from buoyancy_mj.kernels.quadrature import PLACES, POINT, TRIANGLE, add_wet_part, sum_points
from buoyancy_mj.kernels.rules import POINTS, let_node_wait
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.kernels.surface import swing, tangent_at
from buoyancy_mj.kernels.vectors import place, rotate, scale, triple
from buoyancy_mj.kernels.waves import AMPLITUDE, KX, KY

SMALL = 0.8
"""Half the diagonal of a node, times the typical wave number, for its rule: to 1.5e-4 of the
amplitude in the mean, 1e-3 in corners."""
COARSE = 0.1
"""Longest edge of a triangle, over half the diagonal of its hull, for one point: the slope of the
surface over it is left out of its torque."""
DEPTHS = 16
"""Depths for which the typical wave number is known."""


def typical(waves: NDArray[np.float64]) -> NDArray[np.float64]:
    """Wave numbers (DEPTHS,) [rad/m] of one wave that stands for all waves of a sea.

    It is as high as all at the surface, and its third derivatives are as large.

    At depths of 0, 1, 2, ... over the first of them: the pressure of short waves fades soonest.
    Half of the fading counts, so that what is left out stays small beside the faded waves too.
    """
    square, k = waves[:, AMPLITUDE] ** 2, np.hypot(waves[:, KX], waves[:, KY])
    if not square.sum() > 0.0 or not k.any():
        return np.zeros(DEPTHS)
    bent = square / square.sum() * k**6
    fades = np.exp(-np.outer(np.arange(DEPTHS), k) / bent.sum() ** (1.0 / 6.0))
    numbers: NDArray[np.float64] = (fades @ bent) ** (1.0 / 6.0)
    return numbers


@njit(cache=True, error_model="numpy", _nrt=False)
def press_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    scratch,  # `scratch.Scratch`
    out,  # (h, 6)
    first,  # hull, and one past the last
    last,
):
    """Write the pressure of the water, integrated over the wet side of hulls, to `out`.

    That is a force over rho g [m^3], and a torque about the origin of the hull's frame over rho g
    [m^4], in the world's axes.
    """
    wholes, frames = hulls.whole, hulls.frames
    positions, rotations, level = geoms.geom_xpos, geoms.geom_xmat, sea.level
    store = scratch.cut.store
    sums = scratch.pressure.sums
    dynamic = sea.pressure == PressureModel.froude_krylov
    around = Sea(hulls.tiles, store, hulls.blocks, scratch.pressure.store, time, dynamic)
    for h in range(first, last):
        origin, r = positions[frames[h]], rotations[frames[h]]
        out[h, :] = 0.0

        # a hull that is dry, or lost
        c0, c1, c2 = triple(wholes, h, WHOLE_MIDDLE)
        e0, e1, e2 = triple(wholes, h, WHOLE_HALF)
        x, y, z = place(origin, r, c0, c1, c2)
        radius = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        eta, spread, curvature = swing(hulls.tiles, store, x, y, time, radius)
        depth = level + eta - z
        if not math.isfinite(depth) or depth <= -radius - spread:
            out[h, :] = 0.0 if depth < math.inf else math.nan
            continue

        sums[:] = 0.0
        _walk(hulls, h, around, (origin[0], origin[1], origin[2] - level), r, curvature, scratch)

        # outward
        for i in range(6):
            out[h, i] = -sums[i]


@njit(cache=True, error_model="numpy", _nrt=False)
def _walk(  # noqa: C901 (a call for each node would cost more than what it does)
    hulls, h, sea, origin, r, curvature, scratch
):
    """Add nodes and triangles of a hull; `curvature` is a bound of the surface's over it.

    The sea is a `heads.Sea`, and the origin that of the hull's frame, from the still level.
    """
    typical, spans, boxes, rules = hulls.typical, hulls.spans, hulls.boxes, hulls.rules
    vertices, faces, areas = hulls.vertices, hulls.faces, hulls.areas
    tiles, store, time, dynamic = sea.tiles, sea.known_tiles, sea.time, sea.dynamic
    points, corners, sums = scratch.pressure.points, scratch.pressure.corners, scratch.pressure.sums
    stack, allowed = scratch.cut.stack, hulls.whole[h, ALLOWED]
    w0, w1, w2 = triple(hulls.whole, h, WHOLE_HALF)
    coarse = POINT / (COARSE * math.sqrt(w0 * w0 + w1 * w1 + w2 * w2))
    edges, most_bent = hulls.edges, 0.125 * curvature
    # int64: a literal 0 would have all that it is given to compiled twice
    count = int64(0)
    i, wet_until = hulls.nodes[h], int64(0)
    end = spans[i, tree.BEHIND]
    while i < end:
        b0, b1, b2 = triple(boxes, i, tree.MIDDLE)
        e0, e1, e2 = triple(boxes, i, tree.HALF)
        size = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
        x, y, z = place(origin, r, b0, b1, b2)

        # the depth of the middle of the box, and how much less or more any point of it has
        dry, wet = False, i < wet_until
        if not wet:
            eta, along, across = tangent_at(tiles, store, x, y, time)
            h0 = along * r[0] + across * r[3] - r[6]
            h1 = along * r[1] + across * r[4] - r[7]
            h2 = along * r[2] + across * r[5] - r[8]
            spread = tree.spread_in_box((e0, e1, e2), (h0, h1, h2), curvature)
            dry, wet = eta - z <= -spread, eta - z >= spread
            if wet:
                wet_until = tree.node_after(spans, i, True)

        # a small wet node, or the triangles of a leaf; the choice is the same in crests and
        # troughs, where its error would have a mean
        most = typical[0]
        if wet and dynamic:
            rise = abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2
            top = max(-z - rise, 0.0)
            most = typical[int(min(top * most, DEPTHS - 1.0))]
        small = wet and not dry and most * size <= SMALL and size > 0.0
        if small:
            if count > PLACES - POINTS:
                count = sum_points(sea, points, count, origin, sums)
            count = let_node_wait(points, count, rules, boxes, i, origin, r)
        elif not dry and tree.is_leaf(spans, i):
            # its vertices in the world, and their depths where some may be dry
            first, last = spans[i, tree.FIRST_VERTEX], spans[i, tree.END_VERTEX]
            for n in range(last - first):
                v0, v1, v2 = triple(vertices, first + n, 0)
                corners[0, n], corners[1, n], corners[2, n] = place(origin, r, v0, v1, v2)
                corners[HEAD, n] = 1.0
            if not wet:
                set_depths(sea, corners, last - first)
            rough = most_bent * edges[i] * edges[i] > allowed and not wet

            # what is wet of each triangle; one point is for those that are small beside the hull
            fine = max(most, coarse)
            for f in range(spans[i, tree.FIRST_FACE], spans[i, tree.END_FACE]):
                j, k, o = faces[f, 0] - first, faces[f, 1] - first, faces[f, 2] - first
                dj, dk, do = corners[HEAD, j], corners[HEAD, k], corners[HEAD, o]
                if dj <= 0.0 and dk <= 0.0 and do <= 0.0 and not rough:
                    continue
                if count > PLACES - TRIANGLE:
                    count = sum_points(sea, points, count, origin, sums)
                p, q, s = _corner(corners, j), _corner(corners, k), _corner(corners, o)
                area = rotate(r, areas[f, 0], areas[f, 1], areas[f, 2])
                if not rough:
                    count = add_wet_part(points, count, p, q, s, dj, dk, do, area, fine, sums)
                    continue

                # halved where the surface bends along its edges
                _set_corner(stack, 0, p, dj)
                _set_corner(stack, 1, q, dk)
                _set_corner(stack, 2, s, do)
                stack[0, PART] = 1.0
                top = int64(0)
                while top >= 0:
                    more = split(
                        stack, top, curvature, allowed, (tiles, store),
                        (0.0, 0.0), (0.0, 0.0, 0.0), time,
                    )  # fmt: skip
                    if more > top:
                        top = more
                        continue
                    dj, dk, do = stack[top, 3], stack[top, CORNER + 3], stack[top, 2 * CORNER + 3]
                    if dj > 0.0 or dk > 0.0 or do > 0.0:
                        if count > PLACES - TRIANGLE:
                            count = sum_points(sea, points, count, origin, sums)
                        p, q, s = (
                            _corner_of(stack, top, 0),
                            _corner_of(stack, top, 1),
                            _corner_of(stack, top, 2),
                        )
                        part = scale(stack[top, PART], area)
                        count = add_wet_part(points, count, p, q, s, dj, dk, do, part, fine, sums)
                    top -= 1
        i = tree.node_after(spans, i, dry or small)
    sum_points(sea, points, count, origin, sums)


@njit(cache=True, error_model="numpy", inline="always")
def _corner(corners, n):
    """A vertex of a leaf, from the still level."""
    return corners[0, n], corners[1, n], corners[2, n]


@njit(cache=True, error_model="numpy", inline="always")
def _set_corner(stack, corner, p, depth):
    """Write a corner of the lowest triangle of a stack of `halving`; the plane is still water."""
    i = CORNER * corner
    stack[0, i], stack[0, i + 1], stack[0, i + 2], stack[0, i + 3] = p[0], p[1], -p[2], depth


@njit(cache=True, error_model="numpy", inline="always")
def _corner_of(stack, row, corner):
    """A corner of a triangle of a stack, from the still level."""
    i = CORNER * corner
    return stack[row, i], stack[row, i + 1], -stack[row, i + 2]

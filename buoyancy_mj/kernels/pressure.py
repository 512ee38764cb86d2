"""The water's pressure in waves, integrated over the wet side of hulls: forces and torques.

By a tree of moments: a wet node that is small beside the waves is answered by its moments, with the
pressure as a quadratic about its middle, see `expansions`; elsewhere triangles are cut at the
surface and summed at points, see `quadrature`.
"""

import math

import numpy as np
from numba import int64, njit
from numpy.typing import NDArray

from buoyancy_mj.kernels import local, tree
from buoyancy_mj.kernels.expansions import add_node, sum_nodes
from buoyancy_mj.kernels.hulls import (
    BOTTOM_DEGREE,
    DEGREE,
    LIMIT,
    WHOLE_HALF,
    WHOLE_MIDDLE,
)
from buoyancy_mj.kernels.local import HEAD, elevations, gather, surface
from buoyancy_mj.kernels.quadrature import Setting, add_wet_part, sum_points
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.kernels.vectors import place, rotate, triple
from buoyancy_mj.kernels.waves import AMPLITUDE, KX, KY, swing

SMALL = 0.3
"""Half the diagonal of a node, times the typical wave number, for moments: to SMALL^3 / 6."""
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


@njit(cache=True, error_model="numpy")
def press_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    scratch,  # `scratch.PressureScratch`
    out,  # (h, 6)
    first,  # hull, and one past the last
    last,
):
    """Write the pressure of the water, integrated over the wet side of hulls, to `out`.

    That is a force over rho g [m^3], and a torque about the origin of the hull's frame over rho g
    [m^4], in the world's axes.
    """
    wholes, frames, typical = hulls.whole, hulls.frames, hulls.typical
    vertices, faces, areas, nodes = hulls.vertices, hulls.faces, hulls.areas, hulls.nodes
    spans, boxes, moments = hulls.spans, hulls.boxes, hulls.moments
    positions, rotations, level, waves = geoms.geom_xpos, geoms.geom_xmat, sea.level, sea.waves
    near, points, corners = scratch.near, scratch.points, scratch.corners
    asked, waiting, depths = scratch.asked, scratch.nodes, scratch.depths
    # triangles in the world, nodes in the frame; both about its origin
    sums, turned = scratch.sums, scratch.turned
    dynamic = sea.pressure == PressureModel.froude_krylov
    for h in range(first, last):
        origin, r = positions[frames[h]], rotations[frames[h]]
        out[h, :] = 0.0
        dry, curvature = _gather(level, waves, wholes, h, origin, r, time, dynamic, near)
        if dry:
            continue
        setting = Setting((origin[0], origin[1], origin[2] - level), time, dynamic)
        sums[:], turned[:] = 0.0, 0.0
        # int64: a literal 0 would have all that it is given to compiled twice
        count = many = int64(0)
        i = nodes[h]
        end = spans[i, tree.BEHIND]
        while i < end:
            b0, b1, b2 = triple(boxes, i, tree.MIDDLE)
            e0, e1, e2 = triple(boxes, i, tree.HALF)
            size = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)

            # the depth of the middle of the box, and how much less or more any point of it has
            x, y, z = place(origin, r, b0, b1, b2)
            eta, along, across = surface(near, x, y, time)
            depth = level + eta - z
            h0 = along * r[0] + across * r[3] - r[6]
            h1 = along * r[1] + across * r[4] - r[7]
            h2 = along * r[2] + across * r[5] - r[8]
            spread = tree.spread_in_box((e0, e1, e2), (h0, h1, h2), curvature)
            dry, wet = depth <= -spread, depth >= spread

            # a small wet node, or the triangles of a leaf; the choice is the same in crests and
            # troughs, where its error would have a mean
            most = typical[0]
            if wet and dynamic:
                rise = abs(r[6]) * e0 + abs(r[7]) * e1 + abs(r[8]) * e2
                top = max(level - z - rise, 0.0)
                most = typical[int(min(top * most, DEPTHS - 1.0))]
            small = wet and not dry and most * size <= SMALL and size > 0.0
            if small:
                many = add_node(
                    asked, waiting, many, near, setting, turned, moments, boxes, i, origin, r, level
                )
            elif not dry and tree.is_leaf(spans, i):
                count = _add_leaf(
                    vertices, faces, areas, spans, i, r, near, setting, wet, corners, depths,
                    points, count, sums, most,
                )  # fmt: skip
            i = tree.node_after(spans, i, dry or small)

        # the sum, outward
        sum_points(points, count, near, setting, sums)
        sum_nodes(asked, waiting, many, near, setting, turned, moments, boxes)
        fx, fy, fz = rotate(r, turned[0], turned[1], turned[2])
        tx, ty, tz = rotate(r, turned[3], turned[4], turned[5])
        out[h, 0], out[h, 1], out[h, 2] = -(sums[0] + fx), -(sums[1] + fy), -(sums[2] + fz)
        out[h, 3], out[h, 4], out[h, 5] = -(sums[3] + tx), -(sums[4] + ty), -(sums[5] + tz)


@njit(cache=True, error_model="numpy")
def _gather(level, waves, wholes, h, origin, r, time, dynamic, near):
    """Bring the waves to a hull that is not dry.

    Returns whether it is dry, and a bound of the surface's curvature over it.
    """
    c0, c1, c2 = triple(wholes, h, WHOLE_MIDDLE)
    e0, e1, e2 = triple(wholes, h, WHOLE_HALF)
    x, y, z = place(origin, r, c0, c1, c2)
    radius = math.sqrt(e0**2 + e1**2 + e2**2)
    eta, spread, curvature = swing(waves, x, y, time, radius)
    dry = level + eta - z <= -radius - spread
    if not dry:
        degree, limit = int(wholes[h, DEGREE]), wholes[h, LIMIT]
        bottom = int(wholes[h, BOTTOM_DEGREE])
        gather(waves, x, y, z - level, eta, time, radius, degree, limit, bottom, dynamic, near)
    return dry, curvature


@njit(cache=True, error_model="numpy")
def _add_leaf(
    vertices, faces, areas, spans, i, r, near, setting, wet, corners, depths,
    points, count, sums, most,
):  # fmt: skip
    """Add the wet parts of the triangles of a leaf, see `quadrature.add_wet_part`.

    Returns how many points wait then.
    """
    first, last = spans[i, tree.FIRST_VERTEX], spans[i, tree.END_VERTEX]

    # depths of the vertices, where some may be dry
    for n in range(0 if wet else last - first):
        x, y, z = _corner(vertices, first + n, r, setting)
        corners[0, n], corners[1, n], corners[2, n] = x - near[local.X], y - near[local.Y], z
    if not wet:
        elevations(near, corners, last - first, setting.time)
    for n in range(last - first):
        depths[n] = 1.0 if wet else corners[HEAD, n] - corners[2, n]

    # what is wet of each triangle
    for f in range(spans[i, tree.FIRST_FACE], spans[i, tree.END_FACE]):
        j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
        dj, dk, do = depths[j - first], depths[k - first], depths[o - first]
        if dj <= 0.0 and dk <= 0.0 and do <= 0.0:
            continue
        p = _corner(vertices, j, r, setting)
        q = _corner(vertices, k, r, setting)
        s = _corner(vertices, o, r, setting)
        area = rotate(r, areas[f, 0], areas[f, 1], areas[f, 2])
        count = add_wet_part(points, count, near, setting, sums, p, q, s, dj, dk, do, area, most)
    return count


@njit(cache=True, error_model="numpy", inline="always")
def _corner(vertices, n, r, setting):
    """A vertex in the world, from the still level."""
    x, y, z = triple(vertices, n, 0)
    return place(setting.origin, r, x, y, z)

"""The water's pressure in waves, integrated over the wet side of hulls: forces and torques.

By a tree of moments: a wet node that is small beside the waves is answered by its moments, with the
pressure as a quadratic about its middle, see `expansions`; elsewhere triangles are cut at the surface
and summed at points, see `quadrature`.
"""

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from buoyancy_mj.kernels import local, tree
from buoyancy_mj.kernels.expansions import NODES, Expansion, add_node, sum_nodes
from buoyancy_mj.kernels.hulls import DEGREE, LIMIT, WHOLE_HALF, WHOLE_MIDDLE
from buoyancy_mj.kernels.local import HEAD, ROOM, elevations, gather, surface
from buoyancy_mj.kernels.quadrature import PLACES, Quadrature, add_wet_part, sum_points
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.kernels.vectors import place, rotate, triple
from buoyancy_mj.kernels.waves import AMPLITUDE, KX, KY, swing

SMALL = 0.3
"""Half the diagonal of a node, times the typical wave number, for which moments do: to SMALL^3 / 6 of the pressure."""
DEPTHS = 16
"""Depths for which the typical wave number is known."""


def typical(waves: NDArray[np.float64]) -> NDArray[np.float64]:
    """Wave numbers (DEPTHS,) [rad/m] of a single wave as high as all at the surface, whose third derivatives are as large.

    At depths of 0, 1, 2, ... over the first of them: the pressure of short waves fades soonest.
    """
    square, k = waves[:, AMPLITUDE] ** 2, np.hypot(waves[:, KX], waves[:, KY])
    if not square.sum() > 0.0 or not k.any():
        return np.zeros(DEPTHS)
    bent = square / square.sum() * k**6
    fades = np.exp(-2.0 * np.outer(np.arange(DEPTHS), k) / bent.sum() ** (1.0 / 6.0))
    numbers: NDArray[np.float64] = (fades @ bent) ** (1.0 / 6.0)
    return numbers


@njit(cache=True, error_model="numpy")
def press_hulls(
    hulls,  # `hulls.Hulls`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    depths,  # scratch, as long as the most vertices of a leaf
    out,  # (h, 6) force over rho g [m^3] and torque over rho g about the frame's origin [m^4], world frame
):
    """The pressure of the water on the wet side of each hull."""
    dynamic = sea.pressure == PressureModel.froude_krylov
    near = np.empty(local.NEAR + local.WAVE * sea.waves.shape[0])
    # rooms for the points of triangles, for what nodes ask, and for the corners in a leaf
    points, asked = np.empty((ROOM + 3, PLACES)), np.empty((ROOM, PLACES))
    corners, nodes = np.empty((ROOM, depths.shape[0])), np.empty(NODES, np.int64)
    # triangles in the world, nodes in the frame; both about its origin
    sums, turned = np.empty(6), np.empty(6)
    for h in range(hulls.frames.shape[0]):
        origin, r = geoms.geom_xpos[hulls.frames[h]], geoms.geom_xmat[hulls.frames[h]]
        out[h, :] = 0.0

        # what is dry needs no waves
        c0, c1, c2 = triple(hulls.whole, h, WHOLE_MIDDLE)
        e0, e1, e2 = triple(hulls.whole, h, WHOLE_HALF)
        x, y, z = place(origin, r, c0, c1, c2)
        radius = math.sqrt(e0**2 + e1**2 + e2**2)
        eta, spread, curvature = swing(sea.waves, x, y, time, radius)
        if sea.level + eta - z <= -radius - spread:
            continue
        degree, limit = int(hulls.whole[h, DEGREE]), hulls.whole[h, LIMIT]
        gather(sea.waves, x, y, z - sea.level, eta, time, radius, degree, limit, dynamic, near)

        # triangles and nodes
        sums[:], turned[:] = 0.0, 0.0
        base = (origin[0], origin[1], origin[2] - sea.level)
        rule = Quadrature(points, near, base, time, dynamic, sums)
        expansion = Expansion(asked, nodes, near, time, dynamic, turned)
        _walk(hulls, h, origin, r, sea.level, curvature, rule, expansion, corners, depths)

        # the sum, outward
        fx, fy, fz = rotate(r, turned[0], turned[1], turned[2])
        tx, ty, tz = rotate(r, turned[3], turned[4], turned[5])
        out[h, 0], out[h, 1], out[h, 2] = -(sums[0] + fx), -(sums[1] + fy), -(sums[2] + fz)
        out[h, 3], out[h, 4], out[h, 5] = -(sums[3] + tx), -(sums[4] + ty), -(sums[5] + tz)


@njit(cache=True, error_model="numpy", inline="always")
def _walk(hulls, h, origin, r, level, curvature, rule, expansion, corners, depths):
    """Add the pressure on one hull to the sums of a rule, in the world, and of an expansion, in its frame."""
    spans, typical = hulls.spans, hulls.typical
    count = many = 0
    i, end = hulls.nodes[h], hulls.nodes[h + 1]
    while i < end:
        depth, spread, size = _depth_of_node(hulls.boxes, i, origin, r, level, curvature, rule)
        dry, wet = depth <= -spread, depth >= spread
        most = typical[0]
        if wet and rule.dynamic:
            most = typical[int(min((depth - spread) * typical[0], DEPTHS - 1.0))]
        small = wet and not dry and most * size <= SMALL and size > 0.0
        if small:
            many = add_node(expansion, many, hulls, i, size, origin, r, level)
        elif not dry and tree.is_leaf(spans, i):
            _set_depths(hulls, i, r, rule, wet, corners, depths)
            count = _add_leaf(hulls, i, r, rule, count, most, depths)
        i = tree.node_after(spans, i, dry or small)
    sum_points(rule, count)
    sum_nodes(expansion, many, hulls)


@njit(cache=True, error_model="numpy", inline="always")
def _depth_of_node(boxes, i, origin, r, level, curvature, rule):
    """Depth of the middle of a node's box, by how much any point of it can differ, and half its diagonal."""
    b0, b1, b2 = triple(boxes, i, tree.MIDDLE)
    e0, e1, e2 = triple(boxes, i, tree.HALF)
    x, y, z = place(origin, r, b0, b1, b2)
    size = math.sqrt(e0 * e0 + e1 * e1 + e2 * e2)
    eta, along, across = surface(rule.near, x, y, rule.time)
    h0 = along * r[0] + across * r[3] - r[6]
    h1 = along * r[1] + across * r[4] - r[7]
    h2 = along * r[2] + across * r[5] - r[8]
    return level + eta - z, tree.spread_in_box(boxes, i, h0, h1, h2, curvature), size


@njit(cache=True, error_model="numpy", inline="always")
def _set_depths(hulls, i, r, rule, wet, corners, depths):
    """Write the depths of a leaf's vertices; 1 where all of it is wet. `corners` is scratch."""
    first, last = hulls.spans[i, tree.FIRST_VERTEX], hulls.spans[i, tree.END_VERTEX]
    if wet:
        depths[: last - first] = 1.0
        return
    for n in range(last - first):
        v0, v1, v2 = triple(hulls.vertices, first + n, 0)
        x, y, z = place(rule.origin, r, v0, v1, v2)
        corners[0, n], corners[1, n] = x - rule.near[local.X], y - rule.near[local.Y]
        corners[2, n] = z
    elevations(rule.near, corners, last - first, rule.time)
    for n in range(last - first):
        depths[n] = corners[HEAD, n] - corners[2, n]


@njit(cache=True, error_model="numpy", inline="always")
def _add_leaf(hulls, i, r, rule, count, most, depths):
    """Add the wet parts of the triangles of a leaf; returns how many points wait then."""
    faces, areas, base = hulls.faces, hulls.areas, hulls.spans[i, tree.FIRST_VERTEX]
    for f in range(hulls.spans[i, tree.FIRST_FACE], hulls.spans[i, tree.END_FACE]):
        j, k, o = faces[f, 0], faces[f, 1], faces[f, 2]
        dj, dk, do = depths[j - base], depths[k - base], depths[o - base]
        if dj <= 0.0 and dk <= 0.0 and do <= 0.0:
            continue
        p = _corner(hulls.vertices, j, r, rule)
        q = _corner(hulls.vertices, k, r, rule)
        s = _corner(hulls.vertices, o, r, rule)
        area = rotate(r, areas[f, 0], areas[f, 1], areas[f, 2])
        count = add_wet_part(rule, count, p, q, s, dj, dk, do, area, most)
    return count


@njit(cache=True, error_model="numpy", inline="always")
def _corner(vertices, n, r, rule):
    """A vertex in the world, from the still level."""
    x, y, z = triple(vertices, n, 0)
    return place(rule.origin, r, x, y, z)

"""Rules by which functions are integrated over the area of a node, at points of its box.

A rule has the same points for each node, in parts of its box, and a vector area for each point. It
is exact for all polynomials up to `DEGREE`, in the frame of the hull and about the middle of the
box: as exact as moments of that degree, and the points lie in the water if the box does.
"""

import itertools

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.polynomials import size_in_space
from buoyancy_mj.kernels.quadrature import AREA, RULE
from buoyancy_mj.kernels.vectors import triple

DEGREE = 4
"""Degree of the polynomials that are integrated exactly."""
NUMBERS = size_in_space.py_func(DEGREE)
"""How many coefficients such a polynomial has."""


def _list_points() -> NDArray[np.float64]:
    """Points in a cube (3, p): its middle, and what mirrors and turns make of three others."""
    kinds = ((0.0, 0.0, 0.0), (0.91, 0.91, 0.91), (0.9, 0.9, 0.0), (0.84, 0.38, 0.0))
    points = {
        tuple(s * c for s, c in zip(signs, turned, strict=True))
        for kind in kinds
        for turned in itertools.permutations(kind)
        for signs in itertools.product((-1.0, 1.0), repeat=3)
    }
    return np.array(sorted({tuple(c + 0.0 for c in point) for point in points})).T


STENCIL = _list_points()
"""The points in parts of the half sides of a box (3, p)."""
POINTS = STENCIL.shape[1]
"""How many they are."""
_POWERS = np.array(
    [
        (m, n, p)
        for p in range(DEGREE + 1)
        for m in range(DEGREE - p + 1)
        for n in range(DEGREE - p - m + 1)
    ]
)
"""Exponents of x, y and z, in the order of `polynomials`."""
_FIT = np.linalg.pinv(np.prod(STENCIL.T[:, None] ** _POWERS[None], axis=2).T)
"""Shares of points (p, c), by integrals of powers."""


@njit(cache=True, error_model="numpy")
def find_rules(corners, spans, boxes, rules):
    """Write the rule of each node.

    Args:
        corners: of the triangles, in the order of the tree (n, 3, 3).
        spans: of the nodes, see `tree`.
        boxes: of the nodes.
        rules: vector areas of the points of each node (nodes, 3 POINTS), along x of all, along y,
            along z; written.
    """
    powers, integrals = np.empty(NUMBERS), np.empty((3, NUMBERS))
    # from the last back, so that the rules below a node are known
    for node in range(spans.shape[0] - 1, -1, -1):
        middle, half = triple(boxes, node, tree.MIDDLE), triple(boxes, node, tree.HALF)
        integrals[:, :] = 0.0
        if tree.is_leaf(spans, node):
            for f in range(spans[node, tree.FIRST_FACE], spans[node, tree.END_FACE]):
                _add_triangle(corners[f], middle, half, powers, integrals)
        else:
            below = node + 1
            while below < spans[node, tree.BEHIND]:
                _add_node(boxes, rules, below, middle, half, powers, integrals)
                below = spans[below, tree.BEHIND]
        for c in range(3):
            for k in range(POINTS):
                total = 0.0
                for i in range(NUMBERS):
                    total += _FIT[k, i] * integrals[c, i]
                rules[node, c * POINTS + k] = total


@njit(cache=True, error_model="numpy")
def _add_triangle(corners, middle, half, powers, integrals):
    """Add the integrals of powers over a triangle (3, 3), about a middle and in parts of a box."""
    p, q, o = corners[0], corners[1], corners[2]
    area = 0.5 * np.cross(q - p, o - p)
    for s, t, weight in RULE:
        point = s * p + t * q + (1.0 - s - t) * o
        _set_powers((point[0], point[1], point[2]), middle, half, powers)
        for c in range(3):
            for i in range(NUMBERS):
                integrals[c, i] += weight * area[c] * powers[i]


@njit(cache=True, error_model="numpy")
def _add_node(boxes, rules, node, middle, half, powers, integrals):
    """Add the integrals of powers over a node whose rule is known."""
    m0, m1, m2 = triple(boxes, node, tree.MIDDLE)
    e0, e1, e2 = triple(boxes, node, tree.HALF)
    for k in range(POINTS):
        point = m0 + e0 * STENCIL[0, k], m1 + e1 * STENCIL[1, k], m2 + e2 * STENCIL[2, k]
        _set_powers(point, middle, half, powers)
        for c in range(3):
            for i in range(NUMBERS):
                integrals[c, i] += rules[node, c * POINTS + k] * powers[i]


@njit(cache=True, error_model="numpy")
def _set_powers(point, middle, half, out):
    """Write the powers of a place, about a middle and in parts of half sides."""
    u, v, w = 0.0, 0.0, 0.0
    # a flat box has no width to speak of
    if half[0] > 0.0:
        u = (point[0] - middle[0]) / half[0]
    if half[1] > 0.0:
        v = (point[1] - middle[1]) / half[1]
    if half[2] > 0.0:
        w = (point[2] - middle[2]) / half[2]
    i, up = 0, 1.0
    for p in range(DEGREE + 1):
        along = up
        for m in range(DEGREE - p + 1):
            power = along
            for _ in range(DEGREE - p - m + 1):
                out[i] = power
                power *= v
                i += 1
            along *= u
        up *= w


@njit(cache=True, error_model="numpy", _nrt=False)
def let_node_wait(points, first, rules, boxes, node, origin, r):
    """Let the points of a wet node wait behind `first` others, see `quadrature`.

    Args:
        points: see `quadrature.add_wet_part`; written.
        first: how many wait.
        rules: of the nodes.
        boxes: of the nodes.
        node: the node.
        origin: of the hull's frame, from the still level.
        r: world_from_frame.

    Returns:
        How many points wait then.
    """
    m0, m1, m2 = triple(boxes, node, tree.MIDDLE)
    e0, e1, e2 = triple(boxes, node, tree.HALF)
    for c in range(3):
        r0, r1, r2 = r[3 * c], r[3 * c + 1], r[3 * c + 2]
        place, area = points[c], points[c + AREA]
        middle = origin[c] + (r0 * m0 + r1 * m1 + r2 * m2)
        a0, a1, a2 = r0 * e0, r1 * e1, r2 * e2
        for k in range(POINTS):
            place[first + k] = middle + (
                a0 * STENCIL[0, k] + a1 * STENCIL[1, k] + a2 * STENCIL[2, k]
            )
            area[first + k] = (
                r0 * rules[node, k]
                + r1 * rules[node, POINTS + k]
                + r2 * rules[node, 2 * POINTS + k]
            )
    return first + POINTS

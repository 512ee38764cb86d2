"""A tree over the triangles of a mesh, with bounds and moments of the area under each node.

Nodes are in preorder: the first child of a node comes right behind it, and each node names the one
behind all that are below it, so that a walk needs no stack; for a leaf that one comes next. The
faces of a node stand in the order of the tree, and so do its vertices. Each leaf has vertices of
its own, so that they lie together. A walk goes

    while node < end:
        ...  # look at the node, and decide whether all below it is answered
        if not answered and is_leaf(spans, node):
            ...  # look at its triangles
        node = node_after(spans, node, answered)

The moments of the vector area dA about the middle o of the node's box, with y = x - o, are

    int dA (3),  int y dA (3 x 3),  int y y dA (6 x 3, order xx yy zz xy xz yz),  int |dA| (1)

exact on triangles, and from them follows the integral of any product of two linear functions.
"""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import njit

FIRST_FACE, END_FACE, FIRST_VERTEX, END_VERTEX, BEHIND, SPAN = range(6)
"""Columns of the span of a node, and how many: its faces, its vertices, and the node behind all
that are below it."""
MIDDLE, HALF, BOX = 0, 3, 6
"""Columns of the box of a node, and how many: its middle (3) and half its sides (3)."""
VECTOR, X, Y, Z, XX, YY, ZZ, XY, XZ, YZ, AREA = range(0, 31, 3)
"""Columns of the moments of a node: three for each, but one for the area."""
MOMENTS = 31
"""Columns of the moments of a node."""


# walking


@njit(cache=True, error_model="numpy", inline="always")
def is_leaf(spans, node):
    """Whether no other node is below this one."""
    return spans[node, BEHIND] == node + 1


@njit(cache=True, error_model="numpy", inline="always")
def node_after(spans, node, answered):
    """The next node of a walk: behind all below this one if answered, else its first child."""
    return spans[node, BEHIND] if answered else node + 1


@njit(cache=True, error_model="numpy", inline="always")
def spread_in_box(half, gradient, curvature):
    """By how much a function can differ from its value in the middle of a box with half sides (3).

    The gradient is that in the middle; `curvature` bounds that of the function everywhere.
    """
    e0, e1, e2 = half
    g0, g1, g2 = gradient
    straight = abs(g0) * e0 + abs(g1) * e1 + abs(g2) * e2
    return straight + 0.5 * curvature * (e0 * e0 + e1 * e1 + e2 * e2)


# building


@njit(cache=True, error_model="numpy")
def build(corners, leaf, order, spans):
    """Sort triangles into a tree: the sides of what is thin apart, else by halves.

    The halves divide the widest side of the triangles' middles.

    Thin is what is a quarter as wide along one axis as along the next; a plate that lies in the
    surface would else be under and above it in every box.

    Args:
        corners: of the triangles (n, 3, 3).
        leaf: most triangles of a leaf.
        order: (n,) of 0 .. n - 1; becomes the order of the tree.
        spans: of the nodes, written but for the vertices (at least 4 n / leaf + 1, 5).

    Returns:
        The number of nodes.
    """
    n = corners.shape[0]
    middles = np.empty((n, 3))
    for i in range(n):
        for k in range(3):
            middles[i, k] = (corners[i, 0, k] + corners[i, 1, k] + corners[i, 2, k]) / 3.0

    # ranges still to be done, the next on top
    lows, highs = np.empty(128, np.int64), np.empty(128, np.int64)
    lows[0], highs[0], top, count = 0, n, 1, 0
    while top:
        top -= 1
        low, high = lows[top], highs[top]
        spans[count, FIRST_FACE], spans[count, END_FACE] = low, high
        count += 1
        if high - low > leaf:
            half = _divide(corners, middles, order, low, high)
            lows[top], highs[top] = half, high
            lows[top + 1], highs[top + 1] = low, half
            top += 2

    # from the last node back, the nodes behind are known
    for node in range(count - 1, -1, -1):
        after = node + 1
        while after < count and spans[after, FIRST_FACE] < spans[node, END_FACE]:
            after = spans[after, BEHIND]
        spans[node, BEHIND] = after
    return count


@njit(cache=True, error_model="numpy")
def _divide(corners, middles, order, low, high):
    """Sort a range of the order into two; returns where the second begins."""
    part = order[low:high].copy()
    widths = np.empty(3)
    for k in range(3):
        least, most = math.inf, -math.inf
        for i in part:
            least, most = min(least, middles[i, k]), max(most, middles[i, k])
        widths[k] = most - least
    thin, widest = np.argmin(widths), np.argmax(widths)
    half, next_widest = low, widths.sum() - widths[thin] - widths[widest]
    if 4.0 * widths[thin] < next_widest:
        half = _part_sides(corners, part, thin, order, low)
    # where nearly all face one way there are no two sides
    if min(half - low, high - half) < (high - low) // 4:
        # stable, so that what lies side by side stays so
        along = np.empty(high - low)
        for i in range(high - low):
            along[i] = middles[part[i], widest]
        ranks = np.argsort(along, kind="mergesort")
        for i in range(high - low):
            order[low + i] = part[ranks[i]]
        half = (low + high) // 2
    return half


@njit(cache=True, error_model="numpy")
def _part_sides(corners, part, axis, order, low):
    """Write those of a part that face along an axis to the order, then those that face against it.

    They go to the order from `low` on.

    Returns where the latter begin.
    """
    half = low
    for i in part:
        if _faces_along(corners[i], axis):
            order[half] = i
            half += 1
    behind = half
    for i in part:
        if not _faces_along(corners[i], axis):
            order[behind] = i
            behind += 1
    return half


@njit(cache=True, error_model="numpy")
def _faces_along(corners, k):
    """Whether the normal of a triangle (3, 3) points along an axis rather than against it."""
    p, q = (k + 1) % 3, (k + 2) % 3
    across = (corners[1, p] - corners[0, p]) * (corners[2, q] - corners[0, q])
    return across > (corners[1, q] - corners[0, q]) * (corners[2, p] - corners[0, p])


@njit(cache=True, error_model="numpy")
def spread(faces, spans, vertices, picked):
    """Give each leaf vertices of its own.

    Args:
        faces: of the mesh, in the order of the tree (n, 3); become indices into `picked`.
        spans: of the nodes; those of the vertices are written.
        vertices: how many the mesh has.
        picked: written: which vertex of the mesh each is (3 n).

    Returns:
        How many there are.
    """
    # the leaf that used a vertex last, and where it stands there
    leaf, place = np.full(vertices, -1), np.empty(vertices, np.int64)
    count = 0
    for node in range(spans.shape[0]):
        spans[node, FIRST_VERTEX] = count
        if is_leaf(spans, node):
            for f in range(spans[node, FIRST_FACE], spans[node, END_FACE]):
                for k in range(3):
                    i = faces[f, k]
                    if leaf[i] != node:
                        leaf[i], place[i] = node, count
                        picked[count] = i
                        count += 1
                    faces[f, k] = place[i]

    # vertices of a node end where those of the node behind begin
    for node in range(spans.shape[0] - 1, -1, -1):
        after = spans[node, BEHIND]
        spans[node, END_VERTEX] = count if after == spans.shape[0] else spans[after, FIRST_VERTEX]
    return count


@njit(cache=True, error_model="numpy")
def measure(corners, spans, boxes, moments):
    """Write boxes (nodes, 6) and moments (nodes, 31) of triangles (n, 3, 3).

    The triangles stand in the order of the tree.
    """
    moments[:, :] = 0.0
    y = np.empty((3, 3))
    for node in range(spans.shape[0]):
        first, last = spans[node, FIRST_FACE], spans[node, END_FACE]
        for k in range(3):
            low, high = math.inf, -math.inf
            for i in range(first, last):
                for j in range(3):
                    low, high = min(low, corners[i, j, k]), max(high, corners[i, j, k])
            boxes[node, MIDDLE + k], boxes[node, HALF + k] = 0.5 * (low + high), 0.5 * (high - low)
        for i in range(first, last):
            for k in range(3):
                for j in range(3):
                    y[j, k] = corners[i, j, k] - boxes[node, MIDDLE + k]
            _add_moments(y, moments[node])


@njit(cache=True, error_model="numpy")
def _add_moments(y, row):
    """Add the moments of a triangle with corners y (3, 3) to a row (31,)."""
    total, area = np.empty(3), np.empty(3)
    for k in range(3):
        total[k] = y[0, k] + y[1, k] + y[2, k]
        p, q = (k + 1) % 3, (k + 2) % 3
        area[k] = 0.5 * (
            (y[1, p] - y[0, p]) * (y[2, q] - y[0, q]) - (y[1, q] - y[0, q]) * (y[2, p] - y[0, p])
        )
    for k in range(3):
        row[VECTOR + k] += area[k]
        for a in range(3):
            row[X + 3 * a + k] += total[a] / 3.0 * area[k]
        for m in range(6):
            a, b = (m, m) if m < 3 else ((0, 1) if m == 3 else (0, 2) if m == 4 else (1, 2))
            mean = total[a] * total[b] + y[0, a] * y[0, b] + y[1, a] * y[1, b] + y[2, a] * y[2, b]
            row[XX + 3 * m + k] += mean / 12.0 * area[k]
    row[AREA] += math.sqrt(area[0] ** 2 + area[1] ** 2 + area[2] ** 2)

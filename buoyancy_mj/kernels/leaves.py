"""The triangles of a leaf at the surface: sorted without branches, and summed.

Two lists hold them: those of which two corners or three are wet, and the others. What the surface
cuts stands in a third list too, and is summed by `cuts`. A leaf of which the most is wet is its
moments less the others, so that no more than half of its triangles are summed.

Where straight cuts do not follow the waves well enough, faces with an edge that bends stand in a
fourth list, see `halving`.

Indices are unsigned, since Numba asks of a signed one whether it counts from the end.
"""

import numpy as np
from numba import uint64

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.compiling import inlined, njit
from buoyancy_mj.kernels.cuts import Sums, set_corner, set_size
from buoyancy_mj.kernels.halving import CORNER, PART, bends

_ZERO, _ONE, _TWO = np.uint64(0), np.uint64(1), np.uint64(2)


@inlined
def vertices_of(spans, node):
    """The first vertex of a node, and how many it has."""
    first = uint64(spans[node, tree.FIRST_VERTEX])
    return first, uint64(spans[node, tree.END_VERTEX]) - first


@inlined
def faces_of(spans, node):
    """The first face of a node, and one past its last."""
    return uint64(spans[node, tree.FIRST_FACE]), uint64(spans[node, tree.END_FACE])


@inlined
def corners(faces, face, base):
    """Where the corners of a face stand among the vertices of its leaf, from `base` on."""
    return (
        uint64(faces[face, _ZERO]) - base,
        uint64(faces[face, _ONE]) - base,
        uint64(faces[face, _TWO]) - base,
    )


@inlined
def sort_faces(faces, first, end, base, w, most, others, crossed):
    """Sort the faces of a leaf by the depths w of its vertices under the surface.

    Faces with two or three wet corners go to `most`, all others to `others`, and those that the
    surface cuts to `crossed` as well.

    Returns how many there are in each.
    """
    many, few, cut = _ZERO, _ZERO, _ZERO
    for t in range(first, end):
        j, k, o = corners(faces, t, base)
        wet = uint64(w[j] > 0.0) + uint64(w[k] > 0.0) + uint64(w[o] > 0.0)
        most[many] = others[few] = crossed[cut] = t
        half = wet >> _ONE
        many += half
        few += _ONE - half
        # one or two: their two bits differ
        cut += half ^ (wet & _ONE)
    return many, few, cut


@njit(cache=True, error_model="numpy", _nrt=False)
def sort_bent_faces(
    faces, first, end, base, x, y, w, curvature, allowed, most, others, crossed, bent
):
    """Sort the faces of a leaf as `sort_faces` does, but for those that are to be halved.

    These go to `bent`, and to `others` besides, so that what is wet of them counts nowhere yet.

    Returns how many there are in each.
    """
    many, few, cut, halved = _ZERO, _ZERO, _ZERO, _ZERO
    for t in range(first, end):
        j, k, o = corners(faces, t, base)
        wet = uint64(w[j] > 0.0) + uint64(w[k] > 0.0) + uint64(w[o] > 0.0)
        if (
            bends(x[j], y[j], w[j], x[k], y[k], w[k], curvature, allowed)
            or bends(x[k], y[k], w[k], x[o], y[o], w[o], curvature, allowed)
            or bends(x[o], y[o], w[o], x[j], y[j], w[j], curvature, allowed)
        ):
            bent[halved] = others[few] = t
            halved += _ONE
            few += _ONE
            continue
        most[many] = others[few] = crossed[cut] = t
        half = wet >> _ONE
        many += half
        few += _ONE - half
        cut += half ^ (wet & _ONE)
    return many, few, cut, halved


@inlined
def set_triangle(stack, face, faces, base, x, y, d, w):
    """Write a face as the lowest triangle of a stack of `halving`."""
    j, k, o = corners(faces, face, base)
    for c, v in ((0, j), (CORNER, k), (2 * CORNER, o)):
        stack[0, c], stack[0, c + 1], stack[0, c + 2], stack[0, c + 3] = x[v], y[v], d[v], w[v]
    stack[0, PART] = 1.0


@inlined
def count_wet(stack, row):
    """How many corners of a triangle of a stack are wet."""
    wet = (stack[row, 3] > 0.0) + (stack[row, CORNER + 3] > 0.0)
    return wet + (stack[row, 2 * CORNER + 3] > 0.0)


@inlined
def sum_triangle(stack, row, size):
    """`cuts.Sums` of a wet triangle of a stack, part of a face of a size."""
    x0, y0, d0 = stack[row, 0], stack[row, 1], stack[row, 2]
    x1, y1, d1 = stack[row, CORNER], stack[row, CORNER + 1], stack[row, CORNER + 2]
    x2, y2, d2 = stack[row, 2 * CORNER], stack[row, 2 * CORNER + 1], stack[row, 2 * CORNER + 2]
    return _sum_one(x0, y0, d0, x1, y1, d1, x2, y2, d2, stack[row, PART] * size)


@inlined
def _sum_one(x0, y0, d0, x1, y1, d1, x2, y2, d2, area):
    """`cuts.Sums` of a wet triangle of an area."""
    a = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
    total, twelfth = d0 + d1 + d2, a * (1.0 / 12.0)
    return Sums(
        a * (1.0 / 3.0) * total,
        twelfth * (total * (x0 + x1 + x2) + d0 * x0 + d1 * x1 + d2 * x2),
        twelfth * (total * (y0 + y1 + y2) + d0 * y0 + d1 * y1 + d2 * y2),
        twelfth * (total * total + d0 * d0 + d1 * d1 + d2 * d2),
        a,
        area,
        0.0,
        0.0,
    )


@inlined
def let_triangle_wait(cuts, n, stack, row, size):
    """Let a triangle of a stack that the surface cuts wait as the n-th of `cuts`."""
    a, b = stack[row, 3] > 0.0, stack[row, CORNER + 3] > 0.0
    c = stack[row, 2 * CORNER + 3] > 0.0
    first = 0 if b == c else 1 if a == c else 2
    for corner in range(3):
        i = CORNER * ((first + corner) % 3)
        set_corner(
            cuts, corner, n, stack[row, i], stack[row, i + 1], stack[row, i + 2], stack[row, i + 3]
        )
    set_size(cuts, n, stack[row, PART] * size)


@inlined
def sum_faces(faces, sizes, base, picked, count, x, y, d):
    """Sum picked faces as though they were wet: `cuts.Sums` without an outline."""
    volume = first_x = first_y = square = above = area = 0.0
    for n in range(count):
        t = picked[n]
        j, k, o = corners(faces, t, base)
        x0, x1, x2 = x[j], x[k], x[o]
        y0, y1, y2 = y[j], y[k], y[o]
        d0, d1, d2 = d[j], d[k], d[o]
        a = 0.5 * ((x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0))
        total, twelfth = d0 + d1 + d2, a * (1.0 / 12.0)
        volume += a * (1.0 / 3.0) * total
        first_x += twelfth * (total * (x0 + x1 + x2) + d0 * x0 + d1 * x1 + d2 * x2)
        first_y += twelfth * (total * (y0 + y1 + y2) + d0 * y0 + d1 * y1 + d2 * y2)
        square += twelfth * (total * total + d0 * d0 + d1 * d1 + d2 * d2)
        above += a
        area += sizes[t]
    return Sums(volume, first_x, first_y, square, above, area, 0.0, 0.0)


@inlined
def let_wait(cuts, n, face, faces, sizes, base, x, y, d, w):
    """Let a face that the surface cuts wait as the n-th of `cuts`, its lone corner first."""
    j, k, o = corners(faces, face, base)
    a, b = w[j] > 0.0, w[k] > 0.0
    c = w[o] > 0.0
    # turned so that the corner that is alone on its side comes first
    one = j if b == c else k if a == c else o
    two = k if b == c else o if a == c else j
    three = o if b == c else j if a == c else k
    set_corner(cuts, 0, n, x[one], y[one], d[one], w[one])
    set_corner(cuts, 1, n, x[two], y[two], d[two], w[two])
    set_corner(cuts, 2, n, x[three], y[three], d[three], w[three])
    set_size(cuts, n, sizes[face])

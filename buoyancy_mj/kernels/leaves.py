"""The triangles of a leaf at the surface: sorted without branches, and summed.

Two lists hold them: those of which two corners or three are wet, and the others. What the surface
cuts stands in a third list too, and is summed by `cuts`. A leaf of which the most is wet is its
moments less the others, so that no more than half of its triangles are summed.

Indices are unsigned, since Numba asks of a signed one whether it counts from the end.
"""

import numpy as np
from numba import njit, uint64

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.cuts import Sums, set_corner, set_size

_ZERO, _ONE, _TWO = np.uint64(0), np.uint64(1), np.uint64(2)


@njit(cache=True, error_model="numpy", inline="always")
def vertices_of(spans, node):
    """The first vertex of a node, and how many it has."""
    first = uint64(spans[node, tree.FIRST_VERTEX])
    return first, uint64(spans[node, tree.END_VERTEX]) - first


@njit(cache=True, error_model="numpy", inline="always")
def faces_of(spans, node):
    """The first face of a node, and one past its last."""
    return uint64(spans[node, tree.FIRST_FACE]), uint64(spans[node, tree.END_FACE])


@njit(cache=True, error_model="numpy", inline="always")
def corners(faces, face, base):
    """Where the corners of a face stand among the vertices of its leaf, from `base` on."""
    return (
        uint64(faces[face, _ZERO]) - base,
        uint64(faces[face, _ONE]) - base,
        uint64(faces[face, _TWO]) - base,
    )


@njit(cache=True, error_model="numpy", inline="always")
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


@njit(cache=True, error_model="numpy", inline="always")
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


@njit(cache=True, error_model="numpy", inline="always")
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

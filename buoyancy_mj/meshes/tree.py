"""`Tree`: the triangles of a mesh in boxes, so that only those at the waterline need to be looked at."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import tree as kernels

LEAF = 32
"""Most triangles of a leaf."""
FEW = 1000
"""Size of mesh below which one leaf is as fast as a tree."""


class Tree(NamedTuple):
    """A tree over the triangles of a mesh, see `kernels.tree`."""

    vertices: NDArray[np.float64]
    """Of the leaves, one after the other (v, 3) [m]."""
    faces: NDArray[np.int64]
    """Indices into them (m, 3), in the order of the tree."""
    spans: NDArray[np.int64]
    """First face of each node and one behind its last, the same for its vertices, and the node behind all below (n, 5)."""
    boxes: NDArray[np.float64]
    """Middle and half sides of its bounding box (n, 6) [m]."""
    moments: NDArray[np.float64]
    """Moments of its vector area (n, 31) [m^2, m^3, m^4]."""


def grow_tree(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Tree:
    """A tree over the triangles of a mesh; of one leaf alone where the plain way is as fast."""
    n = len(faces)
    leaf = LEAF if n >= FEW else n
    order, spans = np.arange(n), np.empty((4 * n // leaf + 8, 5), np.int64)
    spans = spans[: kernels.build(vertices[faces], leaf, order, spans)].copy()
    boxes, moments = np.empty((len(spans), 6)), np.empty((len(spans), kernels.MOMENTS))
    kernels.measure(vertices[faces[order]], spans, boxes, moments)
    faces, picked = faces[order], np.empty(3 * n, np.int64)
    count = kernels.spread(faces, spans, len(vertices), picked)
    return Tree(vertices[picked[:count]], faces, spans, boxes, moments)

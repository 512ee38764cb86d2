"""`Tree`: the triangles of a mesh in nested boxes, so that only the waterline's are looked at."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import rules
from buoyancy_mj.kernels import tree as kernels

LEAF = 32
"""Most triangles of a leaf."""
FEW = 300
"""Number of triangles below which one leaf is as fast as a tree."""


class Tree(NamedTuple):
    """A tree over the triangles of a mesh; see `kernels.tree`."""

    vertices: NDArray[np.float64]
    """Vertices of the leaves, one leaf after the other (v, 3) [m]."""
    faces: NDArray[np.int64]
    """Indices into the vertices (m, 3), in the order of the tree."""
    spans: NDArray[np.int64]
    """First face of each node and one past its last, the same for vertices, next node (n, 5).

    The next node is the one behind all nodes below this one."""
    boxes: NDArray[np.float64]
    """Middle and half sides of each node's bounding box (n, 6) [m]."""
    moments: NDArray[np.float64]
    """Moments of each node's vector area (n, 31) [m^2, m^3, m^4]."""
    vectors: NDArray[np.float64]
    """Vector area of each face, in the order of the tree (m, 3) [m^2]."""


def build_tree(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Tree:
    """Build a tree over the triangles of a mesh; a small mesh becomes a single leaf.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
    """
    # sort the faces into nodes
    n = len(faces)
    leaf = LEAF if n >= FEW else n
    order = np.arange(n)
    spans = np.empty((4 * n // leaf + 8, 5), np.int64)
    spans = spans[: kernels.build(vertices[faces], leaf, order, spans)].copy()

    # measure the nodes
    boxes = np.empty((len(spans), 6))
    moments = np.empty((len(spans), kernels.MOMENTS))
    kernels.measure(vertices[faces[order]], spans, boxes, moments)

    # measure the faces
    a, b, c = vertices[faces[order].T]
    vectors = 0.5 * np.cross(b - a, c - a)

    # give each leaf its own vertices
    faces = faces[order]
    used = np.empty(3 * n, np.int64)
    count = kernels.spread(faces, spans, len(vertices), used)
    return Tree(vertices[used[:count]], faces, spans, boxes, moments, vectors)


def find_rules(of: Tree) -> NDArray[np.float64]:
    """The rule of each node (n, 3 p), see `kernels.rules` [m^2]."""
    found = np.empty((len(of.spans), 3 * rules.POINTS))
    rules.find_rules(of.vertices[of.faces], of.spans, of.boxes, found)
    return found

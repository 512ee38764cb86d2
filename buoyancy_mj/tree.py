"""`Tree`: the triangles of a mesh in boxes, so that only those at the waterline need to be looked at."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import tree as kernels
from buoyancy_mj.mesh import TriMesh
from buoyancy_mj.water import Water

TREE_TOLERANCE = 1e-4
"""Bound, as a fraction of the hull's volume, on what the moments of the tree lack in waves; on still water nothing."""
LEAVES = 64, 16
"""Most triangles of a leaf; the smaller one in waves that larger leaves miss too much of."""
FEW = 1000
"""Size of mesh below which one leaf is as fast as a tree."""
SMALL = 0.5
"""Part of its leaves that must be small enough for the waves, that a tree is worth its while."""


class Tree(NamedTuple):
    """A tree over the triangles of a mesh, see `kernels.tree`."""

    vertices: NDArray[np.float64]
    """Of the leaves, one after the other (v, 3) [m]."""
    faces: NDArray[np.int64]
    """Indices into them (m, 3), in the order of the tree."""
    spans: NDArray[np.int64]
    """First face of each node and one behind its last, the same for its vertices, and the node behind all below (n, 5)."""
    boxes: NDArray[np.float64]
    """Middle and half sides of its bounding box [m], and the cube of the smallest half diagonal under it (n, 7) [m^3]."""
    moments: NDArray[np.float64]
    """Moments of its vector area (n, 31) [m^2, m^3, m^4]."""


def grown(mesh: TriMesh, vertices: NDArray[np.float64], faces: NDArray[np.int64], water: Water) -> Tree:
    """A tree over the triangles of a mesh, refined for the waves; of one leaf alone where the plain way is as fast.

    That is with few triangles, and in waves for which most leaves are too large to be answered by
    their moments.
    """
    for leaf in LEAVES if len(faces) >= FEW else ():
        tree = _tree(vertices, faces, leaf)
        cubes = tree.boxes[tree.spans[:, 4] == np.arange(1, len(tree.spans) + 1), 6]
        height, moment = slack(mesh)
        small = (water.twist * cubes <= 6.0 * height) & (water.curvature * cubes <= 2.0 * moment)
        if small.mean() >= SMALL:
            return tree
    return _tree(vertices, faces, len(faces))


def _tree(vertices: NDArray[np.float64], faces: NDArray[np.int64], leaf: int) -> Tree:
    n = len(faces)
    order, spans = np.arange(n), np.empty((4 * n // leaf + 8, 5), np.int64)
    spans = spans[: kernels.build(vertices[faces], leaf, order, spans)].copy()
    boxes, moments = np.empty((len(spans), 7)), np.empty((len(spans), kernels.MOMENTS))
    kernels.measure(vertices[faces[order]], spans, boxes, moments)
    faces, picked = faces[order], np.empty(3 * n, np.int64)
    count = kernels.spread(faces, spans, len(vertices), picked)
    return Tree(vertices[picked[:count]], faces, spans, boxes, moments)


def slack(mesh: TriMesh) -> tuple[float, float]:
    """How much of the waves a node may miss: height [m], and first moment of it [m^2].

    About the middle of a box of half diagonal r the depth is a quadratic function and a remainder of
    at most A k^3 r^3 / 6, which the first number bounds, t = T V / (3 S), with `TREE_TOLERANCE` T and
    the hull's volume V and surface S. The volume lacks no more than that over S. First moments lack
    it times the hull's radius L, and what the curvature adds about the middle of a node that is
    answered by its moments, at most A k^2 r^3 / 2, twice in the vertical one; the second number
    bounds that, t L. So the volume is off by less than T V and first moments by less than T V L.
    """
    height = TREE_TOLERANCE * mesh.volume / (3.0 * mesh.area)
    return height, height * mesh.radius

"""`Tree`: the triangles of a mesh in boxes, so that only those at the waterline need to be looked at."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import tree as kernels
from buoyancy_mj.mesh import TriMesh
from buoyancy_mj.water import Water

TREE_TOLERANCE = 1e-4
"""Bound, as a fraction of the hull's volume, on what the moments of the tree lack in waves; on still water nothing."""
LEAF, LEAF_IN_WAVES = 64, 32
"""Most triangles of a leaf."""
FEW, FEW_IN_WAVES = 2000, 4000
"""Sizes of mesh below which one leaf is as fast as a tree."""


class Tree(NamedTuple):
    """A tree over the triangles of a mesh, see `kernels.tree`."""

    faces: NDArray[np.int64]
    """Of the mesh (m, 3), in the order of the tree."""
    first: NDArray[np.int64]
    """First face of each node (n,)."""
    last: NDArray[np.int64]
    """One behind its last face (n,)."""
    skip: NDArray[np.int64]
    """The node behind all of its children (n,)."""
    boxes: NDArray[np.float64]
    """Middle and half sides of its bounding box [m], and the cube of the smallest half diagonal under it (n, 7) [m^3]."""
    moments: NDArray[np.float64]
    """Moments of its vector area (n, 31) [m^2, m^3, m^4]."""


def grown(vertices: NDArray[np.float64], faces: NDArray[np.int64], water: Water) -> Tree:
    """A tree over the triangles of a mesh; of one leaf alone where the plain way is as fast."""
    n = len(faces)
    few, leaf = (FEW_IN_WAVES, LEAF_IN_WAVES) if water.curvature else (FEW, LEAF)
    leaf = n if n < few else leaf
    order, (first, last, skip) = np.arange(n), np.empty((3, 4 * n // leaf + 8), np.int64)
    count = kernels.build(vertices[faces], leaf, order, first, last, skip)
    first, last, skip = first[:count], last[:count], skip[:count]
    boxes, moments = np.empty((count, 7)), np.empty((count, kernels.MOMENTS))
    kernels.measure(vertices[faces[order]], first, last, skip, boxes, moments)
    return Tree(faces[order], first, last, skip, boxes, moments)


def slack(mesh: TriMesh, water: Water) -> float:
    """Largest A k^2 r^3 / 2 [m^2] of a node of half diagonal r whose moments may stand for its triangles in waves.

    About the middle of a node's box the depth is a quadratic function and a remainder of at most
    A k^3 r^3 / 6, a third of k times the above. The volume lacks the remainder alone, over no more
    than the hull's surface S. First moments lack that times the hull's radius L, and what the
    curvature adds about that middle, at most A k^2 r^3 / 2, twice in the vertical one. So with
    A k^2 r^3 / 2 max(1 / L, k / 3) below a third of `TREE_TOLERANCE` V / S the volume is off by less
    than the tolerance of V and the first moments of V L.
    """
    k = np.hypot(water.rows[:, 1], water.rows[:, 2]).max(initial=0.0)
    return float(TREE_TOLERANCE * mesh.volume / (3.0 * mesh.area * max(1.0 / mesh.radius, k / 3.0)))

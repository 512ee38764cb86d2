"""Volume and centroid of the convex hull of points, by Quickhull."""

import numpy as np
import scipy
from numpy.typing import NDArray

FLAT = 1e-12
"""Smallest over largest extent of a set of points that counts as flat."""


def hull_moments(
    points: NDArray[np.float64], centroid: str = "hull"
) -> tuple[float, NDArray[np.float64]]:
    """Volume [m^3] and centroid (3,) [m] of the convex hull of points (n, 3) [m].

    The volume is the sum of the signed tetrahedra that the hull's triangles span with the mean of
    its vertices. Fewer than four points, flat sets and coincident points enclose nothing: 0 and
    NaN.

    Args:
        points: the points (n, 3) [m].
        centroid: "hull" for the true centroid, "vertices" for the mean of the hull's vertices.
    """
    nothing = 0.0, np.full(3, np.nan)
    hull = _convex_hull(points)
    if hull is None:
        return nothing

    # Qhull gives the outward normals, but not the order of the corners
    middle: NDArray[np.float64] = points[hull.vertices].mean(axis=0)
    a, b, c = (points - middle)[hull.simplices.T]
    normals = np.cross(b - a, c - a)
    outward = np.sign(np.einsum("ij,ij->i", normals, hull.equations[:, :3]))

    # sums over the tetrahedra
    tetrahedra = outward * np.einsum("ij,ij->i", a, normals) / 6.0
    volume = float(tetrahedra.sum())
    if not volume > 0.0:
        return nothing
    if centroid == "vertices":
        return volume, middle
    return volume, middle + tetrahedra @ (a + b + c) / (4.0 * volume)


def _convex_hull(points: NDArray[np.float64]) -> "scipy.spatial.ConvexHull | None":
    """The convex hull of points; None if they enclose nothing."""
    if len(points) < 4 or not np.isfinite(points).all():
        return None
    try:
        return scipy.spatial.ConvexHull(points)
    except scipy.spatial.QhullError:
        extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if extents[2] <= FLAT * extents[0]:
            return None

    # Qhull cannot tell the facets apart: let it shake the points a little
    try:
        return scipy.spatial.ConvexHull(points, qhull_options="QJ")
    except scipy.spatial.QhullError:
        return None

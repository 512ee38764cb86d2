"""The convex hull of a mesh, closed however slender its facets are."""

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import compact, signed_volume


def convex_hull(vertices: NDArray[np.float64], name: str = "mesh") -> TriMesh:
    """The convex hull of vertices (n, 3) [m]: an approximation for meshes that bound no volume.

    It has all facets that Qhull found, those without area too: without them it would be open.

    Raises:
        MeshError: the vertices lie in a plane; the message calls them `name`.
    """
    try:
        hull = scipy.spatial.ConvexHull(vertices)
    except scipy.spatial.QhullError as error:
        raise MeshError(
            f"{name}: it is flat and has no convex hull; give it thickness, or leave the geom out"
        ) from error
    corners, faces = compact(vertices, _wind_alike(hull.simplices, hull.neighbors))
    return TriMesh(corners, faces if signed_volume(corners, faces) > 0.0 else faces[:, ::-1])


def _wind_alike(facets: NDArray[np.int32], neighbours: NDArray[np.int32]) -> NDArray[np.int64]:
    """Wind facets (n, 3) so that two neighbours run along their common edge in both directions.

    Args:
        facets: corners of each facet, in any order.
        neighbours: the facet across the edge opposite each corner (n, 3).
    """
    # whether a facet and its neighbour run in the same direction, so that one must be turned
    start, end = np.roll(facets, -1, axis=1)[..., None], np.roll(facets, -2, axis=1)[..., None]
    across = facets[neighbours]
    same = ((across == start) & (np.roll(across, -1, axis=2) == end)).any(axis=2)

    # from the first facet on, each after one of its neighbours
    rows = np.repeat(np.arange(len(facets)), 3)
    links = scipy.sparse.csr_array((np.ones(len(rows)), (rows, neighbours.ravel())))
    order, before = scipy.sparse.csgraph.breadth_first_order(links, 0)
    differs = (same & (neighbours == before[:, None])).any(axis=1)
    turned = np.zeros(len(facets), bool)
    for facet in order[1:]:
        turned[facet] = turned[before[facet]] ^ differs[facet]
    return np.where(turned[:, None], facets[:, ::-1], facets).astype(np.int64)

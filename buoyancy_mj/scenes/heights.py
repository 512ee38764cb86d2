"""Heights of geoms under points: where a vehicle has ground under it."""

import itertools

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

_PLANE, _HEIGHT_FIELD, _MESH, _SDF = (
    int(getattr(mujoco.mjtGeom, f"mjGEOM_{name}")) for name in ("PLANE", "HFIELD", "MESH", "SDF")
)
_LEVEL_COSINE = 0.95
"""Cosine of the slope up to which a plane counts as level ground."""
TOUCH = 1e-9
"""Depth [m] up to which ground counts as level with the water."""
SQUARE = np.array([(x, y, 0.0) for x, y in itertools.product(np.linspace(-1.0, 1.0, 7), repeat=2)])
"""Places (n, 3) of vertical lines on a level square from -1 to 1."""


def bound_geoms(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    geoms: NDArray[np.int64],
    place: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Lowest and highest corner (2, 3) [m] of geoms and a place (3,) [m].

    Args:
        model: their model.
        data: their poses.
        geoms: their indices.
        place: a point that lies within the bounds too.
    """
    # boxes around the geoms, turned as these are
    turns = data.geom_xmat[geoms].reshape(-1, 3, 3)
    middles = data.geom_xpos[geoms] + np.einsum("gij,gj->gi", turns, model.geom_aabb[geoms, :3])
    halves = np.einsum("gij,gj->gi", np.abs(turns), model.geom_aabb[geoms, 3:])
    corners = np.vstack([middles - halves, middles + halves, place[None]])
    return np.array([corners.min(axis=0), corners.max(axis=0)])


def find_heights(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Heights (n,) [m] of a geom's surface under points (n, 3), minus infinity where there is none.

    A point inside the geom has its top above it. A mesh is its convex hull, as for its contacts.
    """
    kind = int(model.geom_type[geom])
    turn, middle = data.geom_xmat[geom].reshape(3, 3), data.geom_xpos[geom]
    if kind == _PLANE:
        return np.full(len(points), middle[2] if turn[2, 2] > _LEVEL_COSINE else -np.inf)
    if kind == _SDF:
        # it is no ground: its contacts are with the surface that it draws
        return np.full(len(points), -np.inf)
    if kind == _MESH:
        return _find_hull_heights(_list_vertices(model, geom) @ turn.T + middle, points)

    # a height field has one surface, which is found from above it
    box = model.geom_aabb[geom]
    top = float(middle[2] + turn[2] @ box[:3] + np.abs(turn[2]) @ box[3:])
    down, normal = np.array([0.0, 0.0, -1.0]), np.zeros(3)
    heights = []
    for point in points:
        if kind == _HEIGHT_FIELD:
            start = np.array([point[0], point[1], max(point[2], top + 1.0)])
            distance = mujoco.mj_rayHfield(model, data, geom, start, down, normal)
        else:
            start, size = point, model.geom_size[geom]
            distance = mujoco.mju_rayGeom(middle, turn.ravel(), size, start, down, kind, normal)
        below = start[2] - distance if normal[2] > 0.0 else top
        heights.append(below if distance >= 0.0 else -np.inf)
    return np.array(heights)


def _list_vertices(model: mujoco.MjModel, geom: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the mesh of a geom, in its frame."""
    mesh = model.geom_dataid[geom]
    first = model.mesh_vertadr[mesh]
    return np.asarray(model.mesh_vert[first : first + model.mesh_vertnum[mesh]], float)


def _find_hull_heights(
    vertices: NDArray[np.float64], points: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same for the convex hull of vertices (m, 3) [m].

    It is where all half spaces n . x + d <= 0 of its facets meet, whose vertical lines have ends.
    """
    equations = scipy.spatial.ConvexHull(vertices).equations
    upward = equations[:, 2]
    beside = points[:, :2] @ equations[:, :2].T + equations[:, 3]
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = -beside / upward
    upper = np.where(upward > 0.0, ends, np.inf).min(axis=1)
    lower = np.where(upward < 0.0, ends, -np.inf).max(axis=1)
    outside = ((upward == 0.0) & (beside > 0.0)).any(axis=1)
    reached = ~outside & (lower <= upper) & (lower <= points[:, 2])
    return np.where(reached, upper, -np.inf)

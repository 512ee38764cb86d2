"""The wetted surface of a mesh as triangles, and its waterline: what an eye would see wet."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water


def cut_wetted_surface(
    mesh: TriMesh,
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
    water: Water,
    time: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Cut the faces of a mesh along the water's surface, and keep what is under it.

    Each face is cut where the depth, linear on it, is zero.

    Args:
        mesh: the hull, in its own frame.
        position: origin of the mesh's frame (3,) [m], world frame.
        rotation: world_from_mesh (3, 3), or row-major (9,).
        water: the sea.
        time: time of the waves [s].

    Returns:
        Triangles (n, 3, 3) and pieces of the waterline (k, 2, 3) [m], world frame.
    """
    # depths of all corners
    points = mesh.vertices @ np.asarray(rotation, float).reshape(3, 3).T + position
    depths = water.depth(points, time)
    corners, d = points[mesh.faces], depths[mesh.faces]
    wet = d > 0.0
    count = wet.sum(axis=1)

    # turn each face that is cut so that the corner alone on its side comes first
    cut = (count == 1) | (count == 2)
    alone = np.argmax(wet[cut] == (count[cut] == 1)[:, None], axis=1)
    order = (alone[:, None] + np.arange(3)) % 3
    p = np.take_along_axis(corners[cut], order[:, :, None], axis=1)
    q = np.take_along_axis(d[cut], order, axis=1)

    # the ends of its waterline
    s = q[:, 0] / (q[:, 0] - q[:, 1])
    t = q[:, 0] / (q[:, 0] - q[:, 2])
    a = p[:, 0] + s[:, None] * (p[:, 1] - p[:, 0])
    b = p[:, 0] + t[:, None] * (p[:, 2] - p[:, 0])

    # whole faces; of those cut a triangle with one corner wet, a quadrangle with two
    one = count[cut] == 1
    triangles = np.concatenate(
        [
            corners[count == 3],
            np.stack([p[:, 0], a, b], axis=1)[one],
            np.stack([a, p[:, 1], p[:, 2]], axis=1)[~one],
            np.stack([a, p[:, 2], b], axis=1)[~one],
        ]
    )
    return triangles, np.stack([a, b], axis=1)

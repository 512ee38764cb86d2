"""The wetted surface of a mesh as triangles, and its waterline: what an eye would see wet."""

from collections.abc import Sequence
from typing import NamedTuple

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
    cut = _cut_faces(_place(mesh, position, rotation), mesh.faces, water, time)
    p, (a, b), one = cut.corners, cut.ends, cut.wet_corners == 1

    # whole faces; of those cut a triangle with one corner wet, a quadrangle with two
    triangles = np.concatenate(
        [
            cut.points[mesh.faces[cut.whole]],
            np.stack([p[:, 0], a, b], axis=1)[one],
            np.stack([a, p[:, 1], p[:, 2]], axis=1)[~one],
            np.stack([a, p[:, 2], b], axis=1)[~one],
        ]
    )
    return triangles, np.stack([a, b], axis=1)


class Placed(NamedTuple):
    """A mesh where it is."""

    mesh: TriMesh
    """The hull, in its own frame."""
    position: NDArray[np.float64]
    """Origin of the mesh's frame (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """Rotation world_from_mesh (3, 3), or row-major (9,)."""


def cut_waterlines(hulls: Sequence[Placed], water: Water, time: float) -> NDArray[np.float64]:
    """The pieces of the waterlines (k, 2, 3) [m] that `cut_wetted_surface` gives, of all hulls.

    Args:
        hulls: meshes, with their poses; all at once takes less time than one by one.
        water: the sea.
        time: time of the waves [s].
    """
    if not hulls:
        return np.zeros((0, 2, 3))
    points = np.concatenate([_place(*hull) for hull in hulls])
    starts = np.cumsum([0, *(len(hull.mesh.vertices) for hull in hulls[:-1])])
    faces = np.concatenate(
        [hull.mesh.faces + start for hull, start in zip(hulls, starts, strict=True)]
    )
    return np.stack(_cut_faces(points, faces, water, time).ends, axis=1)


class _Cut(NamedTuple):
    """A mesh in the water, and those of its faces that the surface cuts."""

    points: NDArray[np.float64]
    """Corners of the mesh (n, 3) [m], world frame."""
    whole: NDArray[np.bool_]
    """Whether each face is under water."""
    corners: NDArray[np.float64]
    """Of the faces that are cut (k, 3, 3) [m], that alone on its side first."""
    wet_corners: NDArray[np.int64]
    """How many of them are wet (k,), 1 or 2."""
    ends: tuple[NDArray[np.float64], NDArray[np.float64]]
    """Ends of the waterline on each, (k, 3) [m]."""


def _place(
    mesh: TriMesh, position: NDArray[np.float64], rotation: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Corners of a mesh (n, 3) [m], world frame."""
    points: NDArray[np.float64] = mesh.vertices @ np.reshape(rotation, (3, 3)).T + position
    return points


def _cut_faces(
    points: NDArray[np.float64], faces: NDArray[np.integer], water: Water, time: float
) -> _Cut:
    """Cut faces where the depth, linear on each, is zero."""
    # depths of all corners
    depths = water.depth(points, time)
    one, two, three = (depths > 0.0)[faces.T]
    whole = one & two & three
    cut = np.flatnonzero((one | two | three) & ~whole)
    corners, d = points[faces[cut]], depths[faces[cut]]
    wet = d > 0.0
    count = wet.sum(axis=1)

    # turn each face that is cut so that the corner alone on its side comes first
    alone = np.argmax(wet == (count == 1)[:, None], axis=1)
    order = (alone[:, None] + np.arange(3)) % 3
    p = np.take_along_axis(corners, order[:, :, None], axis=1)
    q = np.take_along_axis(d, order, axis=1)

    # the ends of its waterline
    s = q[:, 0] / (q[:, 0] - q[:, 1])
    t = q[:, 0] / (q[:, 0] - q[:, 2])
    a = p[:, 0] + s[:, None] * (p[:, 1] - p[:, 0])
    b = p[:, 0] + t[:, None] * (p[:, 2] - p[:, 0])
    return _Cut(points, whole, p, count, (a, b))

"""Triangles as viewers draw them: with normals, sharp edges and both sides."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

_SHARP = 0.6
"""Angle between neighbouring triangles above which their edge is sharp [rad]."""


class SmoothMesh(NamedTuple):
    """A mesh with a normal at each corner."""

    vertices: NDArray[np.float64]
    """Corners (n, 3) [m], doubled along sharp edges."""
    faces: NDArray[np.int64]
    """Indices of the corners of each triangle (m, 3)."""
    normals: NDArray[np.float64]
    """Unit normals at the corners (n, 3)."""


def smooth_mesh(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> SmoothMesh:
    """Give a mesh normals that are smooth but at sharp edges."""
    import trimesh

    mesh = trimesh.graph.smooth_shade(trimesh.Trimesh(vertices, faces, process=False), angle=_SHARP)
    return SmoothMesh(
        np.asarray(mesh.vertices), np.asarray(mesh.faces), np.asarray(mesh.vertex_normals)
    )


def rectangle(half: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A rectangle in the plane z = 0 about the origin, seen from above.

    Args:
        half: half lengths of its sides along x and y (2,) [m].

    Returns:
        Its corners (4, 3) [m] and its triangles (2, 3).
    """
    signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    corners = np.column_stack([signs * np.asarray(half), np.zeros(4)])
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


def both_sides(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (m, 3), and the same facing the other way (2 m, 3)."""
    return np.vstack([faces, faces[:, ::-1]])

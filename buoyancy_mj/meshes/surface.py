"""Facts of a triangle surface given as arrays, closed or not: edges, volume, winding number."""

import manifold3d
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.components import label_components

Surface = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Vertices (n, 3) [m], and faces (m, 3) as indices into them."""


def check_arrays(vertices: ArrayLike, faces: ArrayLike) -> Surface:
    """Convert `vertices` to finite floats (n, 3) and `faces` to indices (m, 3) into them.

    Raises:
        MeshError: a wrong shape, no triangle, a coordinate that is not finite, or an index out of
            range.
    """
    # numbers in the right shapes
    try:
        v, f = np.asarray(vertices, np.float64), np.asarray(faces)
    except (TypeError, ValueError) as error:
        raise MeshError(f"vertices and faces must be arrays of numbers: {error}") from error
    if v.ndim != 2 or v.shape[1] != 3:
        raise MeshError(f"vertices have shape {v.shape}; they must be (n, 3)")
    if f.ndim != 2 or f.shape[1] != 3:
        raise MeshError(f"faces have shape {f.shape}; they must be triangles (m, 3)")
    if not len(f):
        raise MeshError("a mesh without a single triangle encloses nothing; export it again")

    # values that make sense
    if not np.issubdtype(f.dtype, np.integer):
        raise MeshError(
            f"faces are of type {f.dtype}; they must be integer indices into the vertices"
        )
    if not np.isfinite(v).all():
        bad = int(np.flatnonzero(~np.isfinite(v).all(axis=1))[0])
        raise MeshError(
            f"vertex {bad} is {v[bad].tolist()}; every coordinate must be a finite number"
        )
    if f.min() < 0 or f.max() >= len(v):
        raise MeshError(f"faces name vertices {f.min()} to {f.max()}; there are 0 to {len(v) - 1}")
    return v, f.astype(np.int64)


def directed_edges(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """All edges (3 m, 2) of faces (m, 3), each in the direction in which its face runs."""
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def undirected_edges(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Each edge (k, 2) of faces (m, 3) once, its lower vertex first, in the order of vertices."""
    edges = directed_edges(faces)
    # one number for each pair of vertices
    count = int(faces.max()) + 1
    pairs = np.unique(edges.min(axis=1) * count + edges.max(axis=1))
    return np.column_stack([pairs // count, pairs % count])


def boundary_edges(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Directed edges (k, 2) that no reverse edge cancels; a closed surface has none."""
    edges = directed_edges(faces)
    edges = edges[edges[:, 0] != edges[:, 1]]
    low, high = edges.min(axis=1), edges.max(axis=1)

    # one number for each pair of vertices; its edges forward less those backward
    count = int(faces.max()) + 1
    pairs, inverse = np.unique(low * count + high, return_inverse=True)
    net = np.bincount(inverse, np.where(edges[:, 0] == low, 1, -1), len(pairs)).astype(np.int64)

    # the surplus, in its own direction
    ends = np.column_stack([pairs // count, pairs % count])
    directed = np.where((net > 0)[:, None], ends, ends[:, ::-1])
    return np.repeat(directed, np.abs(net), axis=0)


def compact(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Surface:
    """Drop the vertices that no face uses."""
    used, renumbered = np.unique(faces, return_inverse=True)
    return np.ascontiguousarray(vertices[used]), renumbered.reshape(-1, 3)


def find_pieces(faces: NDArray[np.int64]) -> list[NDArray[np.intp]]:
    """Vertices of each connected piece of a surface, the piece of the first vertex first."""
    labels = label_components(directed_edges(faces), int(faces.max()) + 1)
    return [np.flatnonzero(labels == piece) for piece in range(int(labels.max()) + 1)]


def tetrahedra(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Signed volumes (m,) [m^3] of the tetrahedra that the faces span with the mean vertex."""
    a, b, c = (vertices - vertices.mean(axis=0))[faces.T]
    volumes: NDArray[np.float64] = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6.0
    return volumes


def signed_volume(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> float:
    """Enclosed volume [m^3], negative inside out; of an open surface, about its mean vertex."""
    return float(tetrahedra(vertices, faces).sum())


def winding_number(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], point: NDArray[np.float64]
) -> float:
    """How often a closed surface winds around a point (3,) [m]: 1 inside, 0 outside.

    It is the solid angle over 4 pi (van Oosterom, Strackee 1983).
    """
    a, b, c = (vertices - point)[faces.T]
    la, lb, lc = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a)))
    numerator = np.einsum("ij,ij->i", a, np.cross(b, c))
    denominator = la * lb * lc + ab * lc + bc * la + ca * lb
    return float(np.arctan2(numerator, denominator).sum() / (2.0 * np.pi))


def to_manifold(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> manifold3d.Manifold | None:
    """Convert a closed mesh without unused vertices for booleans; None if it is no manifold."""
    solid = manifold3d.Manifold(manifold3d.Mesh64(vertices, faces.astype(np.uint64)))
    return solid if solid.status() == manifold3d.Error.NoError else None

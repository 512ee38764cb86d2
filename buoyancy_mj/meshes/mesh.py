"""`TriMesh`: a triangle mesh that is closed and outward, or does not exist."""

import dataclasses
from functools import cached_property

import manifold3d
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class TriMesh:
    """A closed triangle mesh whose faces wind counter-clockwise seen from outside.

    Closed means that each directed edge is met as often as its reverse, so that the area vectors
    sum to zero; several pieces, holes through the solid and inner cavities are all fine.

    Raises:
        MeshError: not finite, empty, open, or with no positive volume. `meshes.repair` repairs
            what can be repaired.
    """

    vertices: NDArray[np.float64]
    """Corners (n, 3) [m]."""
    faces: NDArray[np.int64]
    """Indices of the corners of each triangle (m, 3)."""

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        v, f = check_arrays(vertices, faces)
        if len(open_edges(f)):
            raise MeshError(
                f"a mesh of {len(f)} triangles is open along {len(open_edges(f))} edges; "
                "a hull must be closed: close it, or let buoyancy_mj.repair try"
            )
        v, f = v.copy(), f.copy()
        v.setflags(write=False)
        f.setflags(write=False)
        object.__setattr__(self, "vertices", v)
        object.__setattr__(self, "faces", f)
        if not self.volume > 0.0:
            raise MeshError(
                f"a mesh of {len(f)} triangles encloses {self.volume:.3g} m^3; a hull must enclose a positive volume: "
                "turn its faces outward, or let buoyancy_mj.repair try"
            )

    def __repr__(self) -> str:
        return f"TriMesh({len(self.vertices)} vertices, {len(self.faces)} faces, {self.volume:.6g} m^3)"

    @cached_property
    def area_vectors(self) -> NDArray[np.float64]:
        """Outward normals times areas of the triangles (m, 3) [m^2]; they sum to zero."""
        a, b, c = self.corners
        return 0.5 * np.cross(b - a, c - a)

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Areas of the triangles (m,) [m^2]."""
        return np.linalg.norm(self.area_vectors, axis=1)

    @property
    def area(self) -> float:
        """Surface area [m^2]."""
        return float(self.areas.sum())

    @property
    def corners(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """First, second and third corners of all triangles, each (m, 3) [m]."""
        a, b, c = self.vertices[self.faces.T]
        return a, b, c

    @cached_property
    def volume(self) -> float:
        """Enclosed volume [m^3]: a third of the flux of position through the surface (Gauss)."""
        return float(self._tetrahedra.sum())

    @cached_property
    def centroid(self) -> NDArray[np.float64]:
        """Centroid of the enclosed volume (3,) [m]."""
        middle = self.vertices.mean(axis=0)
        a, b, c = self.corners
        return middle + self._tetrahedra @ ((a - middle) + (b - middle) + (c - middle)) / (
            4.0 * self.volume
        )

    @cached_property
    def _tetrahedra(self) -> NDArray[np.float64]:
        """Signed volumes (m,) of the tetrahedra that the triangles span with the mean vertex."""
        middle = self.vertices.mean(axis=0)
        a, b, c = self.corners
        return np.einsum("ij,ij->i", a - middle, np.cross(b - middle, c - middle)) / 6.0

    @cached_property
    def radius(self) -> float:
        """Radius [m] of the sphere about the centroid that holds every vertex."""
        return float(np.linalg.norm(self.vertices - self.centroid, axis=1).max())

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lowest and highest corner of the axis-aligned bounding box (2, 3) [m]."""
        return np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])

    @property
    def extents(self) -> NDArray[np.float64]:
        """Sides of the axis-aligned bounding box (3,) [m]."""
        return np.ptp(self.vertices, axis=0)

    @cached_property
    def compact(self) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Vertices (n, 3) [m] that faces use, and the faces (m, 3) in their indices."""
        used, faces = np.unique(self.faces, return_inverse=True)
        return np.ascontiguousarray(self.vertices[used]), faces.reshape(-1, 3)

    def transformed(
        self, rotation: ArrayLike, translation: ArrayLike = (0.0, 0.0, 0.0)
    ) -> "TriMesh":
        """The mesh turned by a rotation matrix (3, 3), then moved by `translation` (3,) [m]."""
        moved = object.__new__(TriMesh)
        vertices = self.vertices @ np.asarray(rotation, float).T + np.asarray(translation, float)
        vertices.setflags(write=False)
        object.__setattr__(moved, "vertices", vertices)
        object.__setattr__(moved, "faces", self.faces)
        return moved


def check_arrays(
    vertices: ArrayLike, faces: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """`vertices` as finite floats (n, 3) and `faces` as indices (m, 3) into them.

    Raises:
        MeshError: wrong shapes, no triangle, a coordinate that is not finite, an index out of range.
    """
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


def open_edges(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Directed edges (k, 2) that their reverses do not cancel: the boundary of the surface."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    low, high = edges.min(axis=1), edges.max(axis=1)
    # one number for each pair of vertices; its edges forward less those backward
    count = int(faces.max()) + 1
    pairs, inverse = np.unique(low * count + high, return_inverse=True)
    net = np.bincount(inverse, np.where(edges[:, 0] == low, 1, -1), len(pairs)).astype(np.int64)
    ends = np.column_stack([pairs // count, pairs % count])
    directed = np.where((net > 0)[:, None], ends, ends[:, ::-1])
    return np.repeat(directed, np.abs(net), axis=0)


def winding(v: NDArray[np.float64], f: NDArray[np.int64], point: NDArray[np.float64]) -> float:
    """How often a closed surface winds around a point: its solid angle over 4 pi (van Oosterom, Strackee 1983)."""
    a, b, c = (v - point)[f.T]
    la, lb, lc = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    numerator = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = [np.einsum("ij,ij->i", p, q) for p, q in ((a, b), (b, c), (c, a))]
    denominator = la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb
    return float(np.arctan2(numerator, denominator).sum() / (2.0 * np.pi))


def to_manifold(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> manifold3d.Manifold | None:
    """A closed mesh without spare vertices, for booleans; None where it is no manifold."""
    solid = manifold3d.Manifold(manifold3d.Mesh64(vertices, faces.astype(np.uint64)))
    return solid if solid.status() == manifold3d.Error.NoError else None


def refine(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], edge: float
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The same surface with edges of about `edge` [m] at most, in about as few triangles as that takes.

    Well-shaped triangles are halved across their longest edge; slender ones are cut across their
    two long edges at once, where a diagonal may reach 1.4 `edge`. Neighbours may be cut at different
    places along their common edge.
    """
    v, f, done = vertices, faces, []
    while len(f):
        # turn each face so that its longest edge runs from corner 0 to corner 1
        a, b, c = v[f.T]
        lengths = np.stack(
            [np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=1
        )
        f = np.take_along_axis(f, (lengths.argmax(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
        longest, shortest = lengths.max(axis=1), lengths.min(axis=1)
        long = longest > edge
        slender = long & (shortest <= 0.7 * edge)
        done.append(f[~long])
        # slices no deeper than 0.7 edges have diagonals below one
        counts = np.ceil(longest[slender] / (0.7 * edge)).astype(np.int64)
        for count in np.unique(counts):
            v, slices = _sliced(v, f[slender][counts == count], int(count))
            done.append(slices)
        f = f[long & ~slender]
        m = len(v) + np.arange(len(f))
        v = np.vstack([v, 0.5 * (v[f[:, 0]] + v[f[:, 1]])])
        f = np.vstack(
            [np.column_stack([f[:, 0], m, f[:, 2]]), np.column_stack([m, f[:, 1], f[:, 2]])]
        )
    if len(v) == len(vertices):
        return vertices, faces
    places, inverse = np.unique(v, axis=0, return_inverse=True)
    return places, inverse.ravel()[np.vstack(done)]


def _sliced(
    v: NDArray[np.float64], f: NDArray[np.int64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Triangles cut into `count` slices parallel to their shortest edge."""
    # the tip lies opposite the shortest edge
    a, b, c = v[f.T]
    opposite = np.stack(
        [np.linalg.norm(q - p, axis=1) for p, q in ((b, c), (c, a), (a, b))], axis=1
    )
    f = np.take_along_axis(f, (opposite.argmin(axis=1)[:, None] + np.arange(3)) % 3, axis=1)
    tip, left, right = v[f.T]
    part = np.arange(1, count)[:, None, None] / count
    rungs = np.concatenate([tip + part * (left - tip), tip + part * (right - tip)]).reshape(-1, 3)
    # indices (count, n) down the left and the right side, ending at the corners themselves
    new = len(v) + np.arange(2 * (count - 1) * len(f)).reshape(2, count - 1, len(f))
    lefts, rights = np.vstack([new[0], f[None, :, 1]]), np.vstack([new[1], f[None, :, 2]])
    tips = np.column_stack([f[:, 0], lefts[0], rights[0]])
    upper = np.stack([lefts[:-1], lefts[1:], rights[1:]], axis=-1).reshape(-1, 3)
    lower = np.stack([lefts[:-1], rights[1:], rights[:-1]], axis=-1).reshape(-1, 3)
    return np.vstack([v, rungs]), np.vstack([tips, upper, lower])

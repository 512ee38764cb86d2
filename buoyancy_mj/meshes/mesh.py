"""`TriMesh`: a triangle mesh that is closed and outward, or does not exist."""

import dataclasses
from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.cache import take_checksum
from buoyancy_mj.meshes.surface import Surface, boundary_edges, check_arrays, compact, tetrahedra


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class TriMesh:
    """A closed triangle mesh whose faces wind counter-clockwise seen from outside.

    Closed means that every directed edge occurs as often as its reverse, so that the area vectors
    sum to zero. Several pieces, holes through the solid and inner cavities are all allowed.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).

    Raises:
        MeshError: the mesh is not finite, empty, open, or has no positive volume. `meshes.repair`
            repairs what can be repaired.

    Example:
        >>> TriMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        ...         [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
        TriMesh(4 vertices, 4 faces, 0.166667 m^3)
    """

    vertices: NDArray[np.float64]
    """Corners (n, 3) [m]."""
    faces: NDArray[np.int64]
    """Indices of the corners of each triangle (m, 3)."""

    def __init__(self, vertices: ArrayLike, faces: ArrayLike) -> None:
        v, f = check_arrays(vertices, faces)
        boundary = len(boundary_edges(f))
        if boundary:
            raise MeshError(
                f"a mesh of {len(f)} triangles is open along {boundary} edges; "
                "a hull must be closed: close it, or let buoyancy_mj.repair try"
            )

        # copies of its own
        self._take(v.copy(), f.copy())
        if not self.volume > 0.0:
            raise MeshError(
                f"a mesh of {len(f)} triangles encloses {self.volume:.3g} m^3; "
                "a hull must enclose a positive volume: "
                "turn its faces outward, or let buoyancy_mj.repair try"
            )

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """Its arrays, and what was measured of it, for `from_arrays`."""
        measures = np.array([self.volume, self.area, self.longest_edge, *self.centroid])
        return {"vertices": self.vertices, "faces": self.faces, "measures": measures}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> "TriMesh":
        """The mesh that `to_arrays` gave the arrays of; it is sound, and not checked again."""
        mesh = object.__new__(cls)
        mesh._take(arrays["vertices"], arrays["faces"])
        volume, area, longest = arrays["measures"][:3].tolist()
        mesh.__dict__.update(volume=volume, area=area, longest_edge=longest)
        mesh.__dict__.update(centroid=arrays["measures"][3:])
        return mesh

    def _take(self, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
        """Keep arrays, to which nobody can write from now on."""
        vertices.setflags(write=False)
        faces.setflags(write=False)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    def __repr__(self) -> str:
        counts = f"{len(self.vertices)} vertices, {len(self.faces)} faces"
        return f"TriMesh({counts}, {self.volume:.6g} m^3)"

    @property
    def corners(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """First, second and third corners of all triangles, each (m, 3) [m]."""
        a, b, c = self.vertices[self.faces.T]
        return a, b, c

    @cached_property
    def area_vectors(self) -> NDArray[np.float64]:
        """Outward normals times areas of the triangles (m, 3) [m^2]; they sum to zero."""
        a, b, c = self.corners
        return 0.5 * np.cross(b - a, c - a)

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Areas of the triangles (m,) [m^2]."""
        areas: NDArray[np.float64] = np.linalg.norm(self.area_vectors, axis=1)
        return areas

    @cached_property
    def area(self) -> float:
        """Surface area [m^2]."""
        return float(self.areas.sum())

    @cached_property
    def volume(self) -> float:
        """Enclosed volume [m^3]: a third of the flux of position through the surface (Gauss)."""
        return float(self._tetrahedra.sum())

    @cached_property
    def centroid(self) -> NDArray[np.float64]:
        """Centroid of the enclosed volume (3,) [m]."""
        middle = self.vertices.mean(axis=0)
        a, b, c = self.corners
        sums = (a - middle) + (b - middle) + (c - middle)
        centroid: NDArray[np.float64] = middle + self._tetrahedra @ sums / (4.0 * self.volume)
        centroid.setflags(write=False)
        return centroid

    @cached_property
    def _tetrahedra(self) -> NDArray[np.float64]:
        """Signed volumes (m,) [m^3] of the tetrahedra between the faces and the mean vertex."""
        return tetrahedra(self.vertices, self.faces)

    @cached_property
    def longest_edge(self) -> float:
        """Length of the longest edge [m]."""
        a, b, c = self.corners
        squares = [np.square(q - p).sum(axis=1).max() for p, q in ((a, b), (b, c), (c, a))]
        return float(np.sqrt(max(squares)))

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
        sides: NDArray[np.float64] = np.ptp(self.vertices, axis=0)
        return sides

    @cached_property
    def checksum(self) -> bytes:
        """The same for meshes with the same arrays, for results that depend on these alone."""
        return take_checksum(self.vertices, self.faces)

    @cached_property
    def compact(self) -> Surface:
        """Vertices (n, 3) [m] that faces use, and the faces (m, 3) as indices into these."""
        return compact(self.vertices, self.faces)

    def transformed(
        self, rotation: ArrayLike, translation: ArrayLike = (0.0, 0.0, 0.0)
    ) -> "TriMesh":
        """A copy turned by a rotation matrix (3, 3), then moved by `translation` (3,) [m]."""
        vertices = self.vertices @ np.asarray(rotation, float).T + np.asarray(translation, float)
        # a rigid motion of a sound mesh is sound: it needs no second check
        moved = object.__new__(TriMesh)
        moved._take(vertices, self.faces)
        return moved

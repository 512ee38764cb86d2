"""Decimation: a closed surface in fewer triangles, near to the same.

Edges are drawn together, those first whose end strays least from the planes of the triangles that
it stands for (Garland, Heckbert 1997, *Surface simplification using quadric error metrics*). What
comes out is closed, and each edge has two faces as before.
"""

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.surface import Surface, compact

SHORT_FIRST = 1e-9
"""Part of its squared length that an edge's cost has beside the squared distances from planes."""

_Point = tuple[float, float, float]
_Triangle = tuple[int, int, int]


class Decimation:
    """A closed surface in which each edge has two faces, to be decimated.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
    """

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
        self._vertices: list[_Point] = [(x, y, z) for x, y, z in vertices.tolist()]
        self._faces: dict[int, _Triangle] = {
            index: (i, j, k) for index, (i, j, k) in enumerate(faces.tolist())
        }
        self._around: list[set[int]] = [set() for _ in self._vertices]
        for index, face in self._faces.items():
            for corner in face:
                self._around[corner].add(index)
        self._quadrics = _build_quadrics(vertices, faces)
        self._versions = [0] * len(self._vertices)
        self._heap: list[tuple[float, int, int, int, int]] = []
        for i, j, k in self._faces.values():
            for start, end in ((i, j), (j, k), (k, i)):
                if start < end:
                    self._push(start, end)

    @property
    def surface(self) -> Surface:
        """Vertices (n, 3) [m] and faces (m, 3) as they are now."""
        return compact(np.array(self._vertices), np.array(list(self._faces.values()), np.int64))

    def reduce(self, count: int) -> None:
        """Draw edges together until `count` faces are left, or none can be drawn together."""
        while len(self._faces) > count and self._heap:
            _, start, end, *versions = heapq.heappop(self._heap)
            if versions == [self._versions[start], self._versions[end]]:
                self._try(start, end)

    def _try(self, start: int, end: int) -> None:
        """Draw an edge together into its start, unless the surface would fold or touch itself."""
        near, far = self._list_neighbours(start), self._list_neighbours(end)
        if end not in near or len(near & far) != 2 or len(near) + len(far) < 7:
            return
        _, place = self._place(start, end)
        if self._folds(start, end, place) or self._folds(end, start, place):
            return

        # the two faces beside the edge go, the others of its end hang on its start
        for index in self._around[start] & self._around[end]:
            for corner in self._faces.pop(index):
                self._around[corner].discard(index)
        for index in self._around[end]:
            i, j, k = (start if corner == end else corner for corner in self._faces[index])
            self._faces[index] = i, j, k
        self._around[start] |= self._around[end]
        self._around[end] = set()
        self._vertices[start] = place
        self._quadrics[start] = self._quadrics[start] + self._quadrics[end]
        self._versions[start] += 1
        self._versions[end] += 1
        for other in self._list_neighbours(start):
            self._push(min(start, other), max(start, other))

    def _list_neighbours(self, vertex: int) -> set[int]:
        """The vertices that edges connect with one."""
        return {corner for index in self._around[vertex] for corner in self._faces[index]} - {
            vertex
        }

    def _folds(self, vertex: int, other: int, place: _Point) -> bool:
        """Whether a face of a vertex, but not of another, turns over or thins to nothing there."""
        for index in self._around[vertex] - self._around[other]:
            i, j, k = self._faces[index]
            while i != vertex:
                i, j, k = j, k, i
            b, c = self._vertices[j], self._vertices[k]
            before, after = _normal(self._vertices[vertex], b, c), _normal(place, b, c)
            longest = max(math.dist(place, b), math.dist(place, c), math.dist(b, c))
            sizes = math.hypot(*before) * math.hypot(*after)
            along = before[0] * after[0] + before[1] * after[1] + before[2] * after[2]
            if along < 0.1 * sizes or math.hypot(*after) < 1e-3 * longest**2:
                return True
        return False

    def _push(self, start: int, end: int) -> None:
        """Put an edge among those that may be drawn together."""
        # costs that rounding makes differ are alike, so that any processor draws the same together
        cost = float(f"{self._place(start, end)[0]:.4g}")
        versions = self._versions[start], self._versions[end]
        heapq.heappush(self._heap, (cost, start, end, *versions))

    def _place(self, start: int, end: int) -> tuple[float, _Point]:
        """What it costs to draw an edge together, and where: its best point, middle or end."""
        quadric: NDArray[np.float64] = self._quadrics[start] + self._quadrics[end]
        xx, xy, xz, xd, yy, yz, yd, zz, zd, dd = quadric.tolist()

        def measure(place: _Point) -> float:
            x, y, z = place
            squares = xx * x * x + yy * y * y + zz * z * z + dd
            return float(
                squares + 2.0 * (xy * x * y + xz * x * z + yz * y * z + xd * x + yd * y + zd * z)
            )

        a, b = self._vertices[start], self._vertices[end]
        middle = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])
        length = math.dist(a, b)
        places = [middle, a, b]

        # the least of the quadric by Cramer's rule, where planes of three directions meet
        p, q, r = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        size, det = xx + yy + zz, xx * p + xy * q + xz * r
        if det > 1e-6 * size**3:
            s, t, u = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
            best = (
                -(p * xd + q * yd + r * zd) / det,
                -(q * xd + s * yd + t * zd) / det,
                -(r * xd + t * yd + u * zd) / det,
            )
            if math.dist(best, middle) < length:
                places.append(best)
        cost, place = min((measure(place), place) for place in places)
        return cost + SHORT_FIRST * length**2 * size, place


def _build_quadrics(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> list[NDArray[np.float64]]:
    """For each vertex the sum over its faces of area times squared distance from their planes.

    Each as the ten coefficients of 1, x, y, z by themselves: xx, xy, xz, x, yy, yz, y, zz, z, 1.
    """
    a, b, c = vertices[faces.T]
    doubled = np.cross(b - a, c - a)
    lengths = np.linalg.norm(doubled, axis=1)
    normals = doubled / np.maximum(lengths, 1e-300)[:, None]
    planes = np.column_stack([normals, -np.einsum("ij,ij->i", normals, a)])
    one, two = np.triu_indices(4)
    terms = planes[:, one] * planes[:, two] * (0.5 * lengths)[:, None]
    quadrics = np.zeros((len(vertices), 10))
    for corner in range(3):
        np.add.at(quadrics, faces[:, corner], terms)
    return list(quadrics)


def _normal(a: _Point, b: _Point, c: _Point) -> _Point:
    """Twice the vector area of a triangle."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx

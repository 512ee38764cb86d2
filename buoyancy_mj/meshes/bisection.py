"""Bisection: a closed surface in more triangles where they are needed, and in rounder ones.

The longest edge of a triangle is cut only where it is the longest of its neighbour too, which is
sought from neighbour to neighbour (Rivara 1997, Int. J. Numer. Methods Eng. 40, 3313): so no
triangle grows slender.
"""

import heapq
import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.surface import Surface

FLAT = 1e-4
"""One less the cosine between two faces up to which they count as one plane."""

_Point = tuple[float, float, float]
_Triangle = tuple[int, int, int]


class Bisection:
    """A closed surface in which each edge has two faces, to be cut and turned edge by edge.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
    """

    def __init__(self, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> None:
        self._vertices: list[_Point] = [(x, y, z) for x, y, z in vertices.tolist()]
        self._faces: list[_Triangle] = [(i, j, k) for i, j, k in faces.tolist()]
        self._sides = {
            edge: index for index, face in enumerate(self._faces) for edge in _list_edges(face)
        }

    @property
    def surface(self) -> Surface:
        """Vertices (n, 3) [m] and faces (m, 3) as they are now."""
        return np.array(self._vertices), np.array(self._faces, np.int64)

    def turn_flat_edges(self) -> None:
        """Turn edges between triangles of one plane until these are as round as they can be.

        That is when no corner lies in the circle through its neighbour's (Delaunay).
        """
        edges = [edge for edge in self._sides if edge[0] < edge[1]]
        # each turn makes the smallest angle larger; the limit only guards against rounding
        for _ in range(20 * len(self._faces)):
            if not edges:
                return
            start, end = edges.pop()
            if (start, end) in self._sides and self._is_to_turn(start, end):
                edges += self._turn(start, end)

    def refine(self, errors: NDArray[np.float64], count: int) -> None:
        """Cut the triangles of the largest errors until there are `count` triangles or one more.

        Args:
            errors: of each triangle (m,); the two halves of one have a fifth of its each.
            count: how many triangles there are to be.
        """
        # errors that rounding makes differ are alike, so that any processor cuts the same
        left = np.exp2(np.round(8.0 * np.log2(np.maximum(errors, 1e-300))) / 8.0).tolist()
        heap = [(-error, face) for face, error in enumerate(left)]
        heapq.heapify(heap)
        while len(self._faces) < count:
            negative, face = heapq.heappop(heap)
            if -negative != left[face]:
                continue
            for half, other in self._cut(*self._find_longest_around(face)):
                left[half] *= 0.2
                left.append(left[half])
                heapq.heappush(heap, (-left[half], half))
                heapq.heappush(heap, (-left[other], other))

    def _find_longest_around(self, face: int) -> tuple[int, int]:
        """From a face over its longest edge and so on, to an edge longest on both its sides."""
        while True:
            start, end = self._find_longest(face)
            face = self._sides[end, start]
            if self._find_longest(face) == (end, start):
                return start, end

    def _find_longest(self, face: int) -> tuple[int, int]:
        """The longest edge of a face; of several the one that all faces agree on."""
        edges = _list_edges(self._faces[face])
        return max(edges, key=lambda edge: (self._measure(*edge), min(edge), max(edge)))

    def _measure(self, start: int, end: int) -> float:
        """Length of an edge, the same from both sides, and of edges that rounding makes differ."""
        length = math.dist(self._vertices[min(start, end)], self._vertices[max(start, end)])
        return float(f"{length:.9g}")

    def _cut(self, start: int, end: int) -> list[tuple[int, int]]:
        """Cut an edge in the middle, and return the two halves of both its faces."""
        (x, y, z), (u, v, w) = self._vertices[start], self._vertices[end]
        middle = len(self._vertices)
        self._vertices.append((0.5 * (x + u), 0.5 * (y + v), 0.5 * (z + w)))
        halves = []
        for first, last in ((start, end), (end, start)):
            face = self._sides.pop((first, last))
            tip = self._find_tip(face, first, last)
            self._faces.append((middle, last, tip))
            halves.append((face, len(self._faces) - 1))
            self._put(face, (first, middle, tip))
            self._put(len(self._faces) - 1, (middle, last, tip))
        return halves

    def _turn(self, start: int, end: int) -> list[tuple[int, int]]:
        """Let an edge run between the two other corners, and return the edges around it."""
        one, two = self._sides.pop((start, end)), self._sides.pop((end, start))
        tip, other = self._find_tip(one, start, end), self._find_tip(two, end, start)
        self._put(one, (tip, start, other))
        self._put(two, (other, end, tip))
        around = [(tip, start), (start, other), (other, end), (end, tip)]
        return [(min(edge), max(edge)) for edge in around]

    def _is_to_turn(self, start: int, end: int) -> bool:
        """Whether an edge in a plane would be better turned, and there is no edge in its way."""
        tip = self._find_tip(self._sides[start, end], start, end)
        other = self._find_tip(self._sides[end, start], end, start)
        if tip == other or (tip, other) in self._sides or (other, tip) in self._sides:
            return False
        p, q, a, b = np.array([self._vertices[i] for i in (start, end, tip, other)])
        one, two = np.cross(q - p, a - p), np.cross(p - q, b - q)
        if one @ two < (1.0 - FLAT) * np.linalg.norm(one) * np.linalg.norm(two):
            return False

        # the two angles at the tips are more than half a turn, and the four corners are convex
        convex = np.cross(p - a, b - a) @ one > 0.0 and np.cross(q - b, a - b) @ one > 0.0
        return bool(convex and _angle(p - a, q - a) + _angle(p - b, q - b) > math.pi + 1e-9)

    def _find_tip(self, face: int, start: int, end: int) -> int:
        """The corner of a face that is not on an edge of it."""
        return next(corner for corner in self._faces[face] if corner not in (start, end))

    def _put(self, face: int, corners: _Triangle) -> None:
        """Put a face where there may be another."""
        self._faces[face] = corners
        for edge in _list_edges(corners):
            self._sides[edge] = face


def _list_edges(face: _Triangle) -> tuple[tuple[int, int], ...]:
    """The edges of a face, each in the direction in which it runs."""
    i, j, k = face
    return (i, j), (j, k), (k, i)


def _angle(one: NDArray[np.float64], two: NDArray[np.float64]) -> float:
    """Angle between two vectors [rad]."""
    return math.atan2(float(np.linalg.norm(np.cross(one, two))), float(one @ two))

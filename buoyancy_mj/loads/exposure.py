"""Which faces of hulls meet water, and which lie against or within another hull."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.welds import Place, WeldedGroup
from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.panels import ALONE, TOGETHER
from buoyancy_mj.kernels.rays import count_windings
from buoyancy_mj.meshes.cache import Form, recall

_CLOSE = (1e-5, 1e-3)
"""How far before a face another hull is looked for, over the diagonal of the smaller hull.

Two distances, so that one is found that is thinner than the farther one."""
_EXPOSED = Form("exposure", lambda parts: {"parts": parts}, lambda arrays: arrays["parts"])
_POINTS = 4
"""Points along each side of a face, at which it is looked at."""


class Exposure(NamedTuple):
    """The part of each face that meets water."""

    parts: NDArray[np.float64]
    """Of each face, alone and together (e, 2), see `kernels.panels`: in the order of the faces, and
    behind them those of hulls that share their faces with others."""
    faces: NDArray[np.int64]
    """Which face each of them is (e,)."""
    shifts: NDArray[np.int64]
    """How far behind the row of a face that of each hull stands (h,)."""


def measure_exposure(
    packed: Hulls, hulls: Sequence[Hull], groups: Sequence[WeldedGroup]
) -> Exposure:
    """Find the part of each face that meets water.

    A face is looked at in points, so the part of one that is covered in part is an estimate.

    Args:
        packed: the hulls as kernels read them.
        hulls: the same hulls.
        groups: which bodies welds hold together.
    """
    # the hulls that move together, in one frame
    exposed = [np.ones((len(packed.faces), 2))]
    faces = [np.arange(len(packed.faces))]
    shifts, end = np.zeros(len(hulls), np.int64), len(packed.faces)
    places: Mapping[int, Place] = {
        b: place for group in groups for b, place in group.places.items()
    }
    group_of = {b: i for i, group in enumerate(groups) for b in group.places}
    labels = [group_of.get(hull.body, -1 - hull.body) for hull in hulls]
    for label in dict.fromkeys(labels):
        indices = [h for h, other in enumerate(labels) if other == label]
        if len(indices) > 1:
            shapes = [_Shape(packed, h, hulls[h], places.get(hulls[h].body)) for h in indices]
            for shape in shapes:
                others = [other for other in shapes if other is not shape]
                alone = [other for other in others if other.body == shape.body]
                rows = np.empty((len(shape.faces), 2))
                rows[:, ALONE], rows[:, TOGETHER] = shape.exposure(alone), shape.exposure(others)
                # the faces may be those of others too
                if (rows != 1.0).any():
                    exposed.append(rows)
                    faces.append(shape.first_face + np.arange(len(rows)))
                    shifts[shape.index] = end - shape.first_face
                    end += len(rows)
    return Exposure(np.concatenate(exposed), np.concatenate(faces), shifts)


def gather_faces(packed: Hulls, exposure: Exposure) -> NDArray[np.float64]:
    """The faces of all hulls (8, e) as `kernels.facets` takes them, in the order of `exposure`."""
    # of what displaces in part, faces count in part
    vectors = packed.areas[exposure.faces]
    areas = np.linalg.norm(vectors, axis=1)
    middles = packed.vertices[packed.faces[exposure.faces]].mean(axis=1)
    normals = vectors / np.where(areas > 0.0, areas, 1.0)[:, None]
    return np.vstack([middles.T, normals.T, areas * exposure.parts.T])


class _Shape:
    """A hull in the frame of its group."""

    def __init__(self, packed: Hulls, index: int, hull: Hull, place: Place | None) -> None:
        node = packed.nodes[index]
        first, end = packed.spans[node, [tree.FIRST_FACE, tree.END_FACE]]
        self.index, self.first_face = index, int(first)
        self.body = hull.body
        in_body = Place(hull.body_from_geom, hull.position)
        turn, origin = place.after(in_body) if place else in_body
        used, self.faces = np.unique(packed.faces[first:end], return_inverse=True)
        self.faces = self.faces.reshape(-1, 3).astype(np.int64)
        self.vertices = packed.vertices[used] @ turn.T + origin
        self.bounds = np.stack([self.vertices.min(axis=0), self.vertices.max(axis=0)])
        self.diagonal = float(np.linalg.norm(np.ptp(self.bounds, axis=0)))

    def exposure(self, others: Sequence["_Shape"]) -> NDArray[np.float64]:
        """The part of each face (f,) that no other hull covers, found once for the same hulls."""
        shapes = (self, *others)
        parts = tuple(array for one in shapes for array in (one.vertices, one.faces))
        return recall(_EXPOSED, parts, lambda: self._uncover(others))

    def _uncover(self, others: Sequence["_Shape"]) -> NDArray[np.float64]:
        covered = np.zeros((len(self.faces), _POINTS**2), np.bool_)
        for other in others:
            for part in _CLOSE:
                self._cover(other, part * min(self.diagonal, other.diagonal), covered)
        exposed: NDArray[np.float64] = 1.0 - covered.mean(axis=1)
        return exposed

    def _cover(self, other: "_Shape", gap: float, covered: NDArray[np.bool_]) -> None:
        """Mark the points of faces (f, p) before which another hull lies within a gap [m]."""
        corners = self.vertices[self.faces]
        near = np.flatnonzero(
            (corners.min(axis=1) < other.bounds[1] + gap).all(axis=1)
            & (corners.max(axis=1) > other.bounds[0] - gap).all(axis=1)
        )
        if not len(near):
            return

        # points of the faces, a little before them
        a, b, c = corners[near].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        points = np.einsum("pk,kfc->fpc", _spread(_POINTS), np.stack([a, b, c]))
        points = (points + gap * normals[:, None]).reshape(-1, 3)
        order = np.argsort(points[:, 0], kind="stable")
        windings = np.empty(len(points), np.int64)
        count_windings(other.vertices, other.faces, points[order], windings)
        inside = np.empty(len(points), np.bool_)
        inside[order] = windings != 0
        covered[near] |= inside.reshape(len(near), -1)


def _spread(count: int) -> NDArray[np.float64]:
    """Middles of the count * count equal triangles of a triangle, by the parts of its corners."""
    middles = [
        (i + step, j + step)
        for step, rows in ((1.0 / 3.0, count), (2.0 / 3.0, count - 1))
        for i in range(rows)
        for j in range(rows - i)
    ]
    parts = np.array(middles) / count
    return np.column_stack([parts, 1.0 - parts.sum(axis=1)])

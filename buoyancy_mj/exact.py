"""`Exact`: the submersion of the meshes themselves, cut where the surface cuts them."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.kernels import clip
from buoyancy_mj.mesh import TriMesh, refined
from buoyancy_mj.tree import grown, slack
from buoyancy_mj.water import Water

WAVE_TOLERANCE = 2e-3
"""Bound, as a fraction of the hull's volume, on what flat triangles miss of a wave's curve.

Upper and lower sides miss alike and cancel in part: the tests find a quarter of it at most."""
MOST_TRIANGLES = 200_000
"""Size to which a mesh may be refined for that."""


@dataclasses.dataclass(frozen=True)
class Exact:
    """The volume and centroid of what is under the surface, exact on the mesh: the default everywhere."""

    name: ClassVar[str] = "exact"

    def packed(
        self, meshes: Sequence[TriMesh], frames: ArrayLike, bodies: ArrayLike, water: Water, turns: ArrayLike | None = None
    ) -> "PackedHulls":
        """Hulls ready to be submerged, see `PackedHulls`."""
        return PackedHulls(meshes, frames, bodies, water)


class PackedHulls:
    """Hulls in one set of arrays, ready to be submerged together without allocating.

    On still water the results are exact on the mesh. In waves the depth is linear on each triangle
    of a mesh fine enough for that, see `longest_edge`.
    """

    def __init__(self, meshes: Sequence[TriMesh], frames: ArrayLike, bodies: ArrayLike, water: Water) -> None:
        """Pack `meshes`.

        Args:
            meshes: the hulls (h).
            frames: which row of positions and rotations places each (h,).
            bodies: hulls of one number (h,) move together; errors in waves are seen against their joint volume.
            water: the sea.
        """
        self.water = water
        self.frames = np.asarray(frames, np.int64)
        self._whole = np.array([[m.volume, *m.centroid, m.area, *m.bounds.mean(axis=0), *(0.5 * m.extents)] for m in meshes])
        self.volumes = self._whole[:, 0].copy()
        """Whole volumes (h,) [m^3]."""
        edges = _longest_edges(meshes, np.asarray(bodies), water)
        fine = [refined(mesh.vertices, mesh.faces, edge) for mesh, edge in zip(meshes, edges, strict=True)]
        trees = [grown(mesh, *triangles, water) for mesh, triangles in zip(meshes, fine, strict=True)]
        starts = np.cumsum([0, *(len(tree.vertices) for tree in trees)])
        firsts = np.cumsum([0, *(len(tree.faces) for tree in trees)])
        self._nodes = np.cumsum([0, *(len(tree.spans) for tree in trees)])
        self._vertices = np.concatenate([tree.vertices for tree in trees])
        # unsigned, since Numba asks of a signed index whether it counts from the end
        self._faces = np.concatenate([t.faces + start for t, start in zip(trees, starts, strict=False)]).astype(np.uint32)
        self._spans = np.concatenate(
            [t.spans + np.array([f, f, v, v, n]) for t, f, v, n in zip(trees, firsts, starts, self._nodes, strict=False)]
        )
        self._boxes = np.concatenate([tree.boxes for tree in trees])
        self._moments = np.concatenate([tree.moments for tree in trees])
        self._slacks = np.array([slack(mesh) for mesh in meshes])
        a, b, c = self._vertices[self._faces.T]
        vectors = 0.5 * np.cross(b - a, c - a)
        self._areas = np.column_stack([vectors, np.linalg.norm(vectors, axis=1)])
        self._waves = water.rows
        self._depths, self._swell = np.empty(np.diff(starts).max()), np.empty((len(self._waves), 5))
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion (h, 6): volume, centroid, wetted area, waterplane area."""

    ARRAYS = (
        "vertices", "faces", "areas", "nodes", "spans", "boxes", "moments", "slacks", "whole", "frames", "depths", "swell",
    )  # fmt: skip
    """What describes the hulls, and what is worked in, see `kernels.clip.submerge_hulls`."""

    @property
    def arrays(self) -> Mapping[str, NDArray[Any]]:
        """The arrays of `ARRAYS`, for compiled code to submerge the hulls without Python."""
        return {name: getattr(self, "frames" if name == "frames" else f"_{name}") for name in self.ARRAYS}

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far: not counted here."""
        return {}

    def submerge(
        self, positions: NDArray[np.float64], rotations: NDArray[np.float64], time: float, run: int = 0
    ) -> NDArray[np.float64]:
        """Submersion of all hulls at a time [s], written to and returned as `results`; see `methods.Packed`."""
        clip.submerge_hulls(
            self._vertices,
            self._faces,
            self._areas,
            self._nodes,
            self._spans,
            self._boxes,
            self._moments,
            self._slacks,
            self._whole,
            self.frames,
            positions,
            rotations,
            self.water.level,
            self._waves,
            time,
            self._depths,
            self._swell,
            self.results,
        )
        return self.results


def longest_edge(volume: float, area: float, water: Water) -> float:
    """Longest edge [m] with which triangles follow the waves well enough for hulls of a volume and an area.

    A chord of length e under a curve of curvature c is off by c e^2 / 12 on average. A quarter of
    the surface faces up and a quarter down (Cauchy's mean projected area), so the volume is off by
    less than c e^2 / 12 times half the surface, and that must stay below `WAVE_TOLERANCE` of it.
    No hull is driven beyond about `MOST_TRIANGLES`.
    """
    if water.curvature == 0.0:
        return np.inf
    fine = np.sqrt(24.0 * WAVE_TOLERANCE * volume / (area * water.curvature))
    return float(max(fine, np.sqrt(4.0 * area / MOST_TRIANGLES)))


def _longest_edges(meshes: Sequence[TriMesh], bodies: NDArray[np.int64], water: Water) -> list[float]:
    """`longest_edge` of each mesh, from the volume and the area of all meshes of its body."""
    volumes, areas = np.array([mesh.volume for mesh in meshes]), np.array([mesh.area for mesh in meshes])
    return [longest_edge(volumes[bodies == body].sum(), areas[bodies == body].sum(), water) for body in bodies]

"""The submersion of hulls: one mesh by `submerge`, many at once by `PackedHulls`."""

import dataclasses
import functools
import threading
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.kernels import clip
from buoyancy_mj.mesh import TriMesh, refined
from buoyancy_mj.water import Water

WAVE_TOLERANCE = 2e-3
"""Bound, as a fraction of the hull's volume, on what flat triangles miss of a wave's curve.

Upper and lower sides miss alike and cancel in part: the tests find a quarter of it at most."""
MOST_TRIANGLES = 200_000
"""Size to which a mesh may be refined for that."""


@dataclasses.dataclass(frozen=True)
class Submersion:
    """The part of a hull under the surface."""

    volume: float
    """Submerged volume [m^3]."""
    centroid: NDArray[np.float64]
    """Its centroid, the centre of buoyancy (3,) [m], world frame; NaN when dry."""
    wetted_area: float
    """Area of the mesh under the surface [m^2]."""
    waterplane_area: float
    """Area of the hull's cut with the surface, seen from above [m^2]."""


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
        self._vertices = np.concatenate([vertices for vertices, _ in fine])
        self._vertex_starts = np.cumsum([0, *(len(vertices) for vertices, _ in fine)])
        # unsigned, since Numba asks of a signed index whether it counts from the end
        self._faces = np.concatenate(
            [faces + start for (_, faces), start in zip(fine, self._vertex_starts[:-1], strict=True)]
        ).astype(np.uint32)
        self._face_starts = np.cumsum([0, *(len(faces) for _, faces in fine)])
        a, b, c = self._vertices[self._faces.T]
        self._face_areas = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
        self._waves = water.rows
        self._points = np.empty((len(self._vertices), 4))
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion (h, 6): volume, centroid, wetted area, waterplane area."""

    def submerge(self, positions: NDArray[np.float64], rotations: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """Submersion of all hulls at a time [s], written to and returned as `results`.

        Args:
            positions: origins of the frames (n, 3) [m], world frame.
            rotations: world_from_frame of the frames, row-major (n, 9).
            time: [s].
        """
        clip.submerge_hulls(
            self._vertices,
            self._vertex_starts,
            self._faces,
            self._face_starts,
            self._face_areas,
            self._whole,
            self.frames,
            positions,
            rotations,
            self.water.level,
            self._waves,
            time,
            self._points,
            self.results,
        )
        return self.results


def submerge(
    mesh: TriMesh,
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    water: Water | None = None,
    time: float = 0.0,
) -> Submersion:
    """The submersion of one mesh, without an engine.

    Args:
        mesh: the hull, in its own frame.
        position: of the mesh's frame (3,) [m], world frame.
        rotation: world_from_mesh (3, 3); None for no rotation.
        water: fresh and still at z = 0 if None.
        time: [s], for the waves.

    Raises:
        MeshError: a position or rotation of the wrong shape, or a rotation that is none.
    """
    origin = np.asarray(position, float)
    turn = np.eye(3) if rotation is None else np.asarray(rotation, float)
    if origin.shape != (3,) or not np.isfinite([*origin, time]).all():
        raise MeshError(f"position is {position!r} and time {time}; they must be three finite numbers and one")
    if turn.shape != (3, 3) or not np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) or np.linalg.det(turn) < 0.0:
        raise MeshError(f"rotation is {turn.tolist()}; it must be a rotation matrix (3, 3)")
    with _LOCK:
        row = _packed(mesh, water or Water()).submerge(origin[None], turn.reshape(1, 9), float(time))[0].copy()
    return Submersion(
        volume=float(row[clip.VOLUME]),
        centroid=row[clip.CENTROID],
        wetted_area=float(row[clip.WETTED_AREA]),
        waterplane_area=float(row[clip.WATERPLANE_AREA]),
    )


_LOCK = threading.Lock()  # a packed mesh has one set of results


@functools.lru_cache(maxsize=16)
def _packed(mesh: TriMesh, water: Water) -> PackedHulls:
    """A mesh ready to be submerged again and again."""
    return PackedHulls([mesh], [0], [0], water)


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


def wetted_surface(
    mesh: TriMesh, position: NDArray[np.float64], rotation: NDArray[np.float64], water: Water, time: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """What an eye would see wet: triangles (n, 3, 3) and pieces of the waterline (k, 2, 3) [m], world frame.

    Each face is cut where the depth, linear on it, is zero.
    """
    points = mesh.vertices @ np.asarray(rotation, float).reshape(3, 3).T + position
    depths = water.depth(points, time)
    corners, d = points[mesh.faces], depths[mesh.faces]
    wet = d > 0.0
    count = wet.sum(axis=1)
    # turn each cut face so that the corner alone on its side comes first
    cut = (count == 1) | (count == 2)
    alone = np.argmax(wet[cut] == (count[cut] == 1)[:, None], axis=1)
    order = (alone[:, None] + np.arange(3)) % 3
    p = np.take_along_axis(corners[cut], order[:, :, None], axis=1)
    q = np.take_along_axis(d[cut], order, axis=1)
    s, t = q[:, 0] / (q[:, 0] - q[:, 1]), q[:, 0] / (q[:, 0] - q[:, 2])
    a = p[:, 0] + s[:, None] * (p[:, 1] - p[:, 0])
    b = p[:, 0] + t[:, None] * (p[:, 2] - p[:, 0])
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

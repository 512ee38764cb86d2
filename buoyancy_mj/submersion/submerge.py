"""`submerge`: the submersion of one mesh, without an engine; and what of it an eye would see."""

import dataclasses
import functools
import math
import threading

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.kernels import clip
from buoyancy_mj.kernels.vectors import is_rotation
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import Method, Packed, parse_method


@dataclasses.dataclass(frozen=True)
class Submersion:
    """The part of a hull under the surface."""

    volume: float
    """Submerged volume [m^3]."""
    centroid: NDArray[np.float64]
    """Its centroid, the centre of buoyancy (3,) [m], world frame; NaN when dry."""
    wetted_area: float
    """Area of the mesh under the surface [m^2]; NaN from a method that does not know it."""
    waterplane_area: float
    """Area of the hull's cut with the surface, seen from above [m^2]; NaN likewise."""


def submerge(
    mesh: TriMesh,
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    water: Water | None = None,
    time: float = 0.0,
    method: str | Method = "exact",
) -> Submersion:
    """The submersion of one mesh, without an engine.

    Args:
        mesh: the hull, in its own frame.
        position: of the mesh's frame (3,) [m], world frame.
        rotation: world_from_mesh (3, 3); None for no rotation.
        water: fresh and still at z = 0 if None.
        time: [s], for the waves.
        method: "exact", "convex_hull" or "sections", or one of these with options.

    Raises:
        MeshError: a position or rotation of the wrong shape, or a rotation that is none.
        MethodError: there is no such method.
    """
    origin = np.ascontiguousarray(position, float)
    turn = np.eye(3) if rotation is None else np.ascontiguousarray(rotation, float)
    if origin.shape != (3,) or not math.isfinite(sum(origin.tolist(), float(time))):
        raise MeshError(
            f"position is {position!r} and time {time}; they must be three finite numbers and one"
        )
    if turn.shape != (3, 3) or not is_rotation(turn):
        raise MeshError(f"rotation is {turn.tolist()}; it must be a rotation matrix (3, 3)")
    chosen, sea = parse_method(method), water or _STILL
    if type(chosen) is Exact:
        with _LOCK:
            row = (
                _packed(mesh, sea).submerge(origin[None], turn.reshape(1, 9), float(time))[0].copy()
            )
    else:
        # may carry something from step to step
        row = chosen.pack([mesh], [0], [0], sea).submerge(
            origin[None], turn.reshape(1, 9), float(time)
        )[0]
    volume, _, _, _, wetted_area, waterplane_area = row.tolist()
    return Submersion(volume, row[clip.CENTROID], wetted_area, waterplane_area)


_STILL = Water()
_LOCK = threading.Lock()  # a packed mesh has one set of results


@functools.lru_cache(maxsize=16)
def _packed(mesh: TriMesh, water: Water) -> Packed:
    """A mesh ready to be submerged again and again."""
    return Exact().pack([mesh], [0], [0], water)


def wetted_surface(
    mesh: TriMesh,
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
    water: Water,
    time: float,
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

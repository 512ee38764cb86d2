"""`submerge`: the submersion of one mesh, without an engine."""

import dataclasses
import functools
import threading

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError, describe
from buoyancy_mj.kernels import clip
from buoyancy_mj.kernels.vectors import is_rotation
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.methods import Method, Packed, parse_method
from buoyancy_mj.values import read_array, read_number


@dataclasses.dataclass(frozen=True)
class Submersion:
    """The part of a hull under the surface."""

    volume: float
    """Submerged volume [m^3]."""
    centroid: NDArray[np.float64]
    """Centroid of that volume, the centre of buoyancy (3,) [m], world frame; NaN when dry."""
    wetted_area: float
    """Area of the mesh under the surface [m^2]; NaN from a method that does not know it."""
    waterplane_area: float
    """Area of the hull's cut with the surface, seen from above [m^2].

    It is NaN from a method that does not know it."""


def submerge(
    mesh: TriMesh,
    position: ArrayLike = (0.0, 0.0, 0.0),
    rotation: ArrayLike | None = None,
    water: Water | None = None,
    time: float = 0.0,
    method: str | Method = "exact",
) -> Submersion:
    """Find the part of one mesh that is under the surface, without an engine.

    Args:
        mesh: the hull, in its own frame.
        position: origin of the mesh's frame (3,) [m], world frame.
        rotation: world_from_mesh (3, 3); None for no rotation.
        water: the sea; fresh water, still at z = 0, if None.
        time: time of the waves [s].
        method: "exact", "convex_hull" or "sections", or one of these with options.

    Raises:
        MeshError: a position of the wrong shape, a rotation that is no rotation matrix, or a time
            that is not finite.
        MethodError: there is no such method.
        WaterError: waves too short for so long a mesh.

    Example:
        >>> from buoyancy_mj.meshes import shapes
        >>> submerge(shapes.sphere(0.5), position=(0.0, 0.0, 0.0)).volume
        0.2617...
    """
    # the pose, of arrays of its own: kernels would be compiled again for read-only ones
    origin = read_array(MeshError, "position", position, (3,))
    turn = np.eye(3) if rotation is None else _read_rotation(rotation)
    instant = read_number(MeshError, "time", time)
    pose = origin.reshape(1, 3).copy(), turn.reshape(1, 9).copy(), instant

    # the submersion; other methods may carry something from step to step, so they are packed anew
    sea = water or _STILL
    parsed = parse_method(method)
    if type(parsed) is Exact:
        with _LOCK:
            row = _pack(mesh, sea).submerge(*pose)[0].copy()
    else:
        row = parsed.pack(HullSet([mesh]), sea).submerge(*pose)[0]
    return Submersion(
        volume=float(row[clip.VOLUME]),
        centroid=row[clip.CENTROID],
        wetted_area=float(row[clip.WETTED_AREA]),
        waterplane_area=float(row[clip.WATERPLANE_AREA]),
    )


def _read_rotation(rotation: ArrayLike) -> NDArray[np.float64]:
    """A rotation matrix (3, 3)."""
    what = "it must be a rotation matrix (3, 3)"
    try:
        turn = np.ascontiguousarray(read_array(MeshError, "rotation", rotation, (3, 3)))
    except MeshError:
        raise MeshError(f"rotation is {describe(rotation)}; {what}") from None
    if not is_rotation(turn):
        raise MeshError(f"rotation is {turn.tolist()}; {what}")
    return turn


_STILL = Water()
_LOCK = threading.Lock()
"""Held while a packed mesh is submerged, which has one array of results."""


@functools.lru_cache(maxsize=16)
def _pack(mesh: TriMesh, water: Water) -> Packed:
    """A mesh ready to be submerged exactly, again and again."""
    return Exact().pack(HullSet([mesh]), water)

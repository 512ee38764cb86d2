"""`HullSet`: hulls that are submerged together, and the pass over them for methods in Python."""

import dataclasses
from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.kernels import clip
from buoyancy_mj.meshes.mesh import TriMesh


@dataclasses.dataclass(frozen=True, eq=False)
class HullSet:
    """Hulls that are submerged together.

    Args:
        meshes: one for each hull (h), in its own frame.
        frames: the row of positions and rotations that moves each hull (h,); by default its index.
        bodies: hulls of the same number (h,) move together; by default those of one frame.
        turns: body_from_frame of each hull (h, 3, 3); by default no rotation.
        fills: part of each mesh's volume that displaces water (h,); by default all of it.

    Example:
        >>> from buoyancy_mj.meshes import shapes
        >>> from buoyancy_mj.submersion.hull_set import HullSet
        >>> hulls = HullSet([shapes.box((1.0, 0.5, 0.25)), shapes.sphere(0.5)])
        >>> packed = Exact().pack(hulls, Water())
    """

    meshes: tuple[TriMesh, ...]
    """One mesh for each hull (h), in its own frame."""
    frames: NDArray[np.int64]
    """The row of positions and rotations that moves each hull (h,)."""
    bodies: NDArray[np.int64]
    """Hulls of the same number (h,) move together."""
    turns: NDArray[np.float64]
    """body_from_frame of each hull (h, 3, 3)."""
    fills: NDArray[np.float64]
    """Part of each mesh's volume that displaces water (h,)."""

    def __init__(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike | None = None,
        bodies: ArrayLike | None = None,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> None:
        count = len(meshes)
        frames = np.arange(count) if frames is None else np.asarray(frames, np.int64)
        bodies = frames if bodies is None else np.asarray(bodies, np.int64)
        turns = np.tile(np.eye(3), (count, 1, 1)) if turns is None else np.asarray(turns, float)
        fills = np.ones(count) if fills is None else np.asarray(fills, float)
        object.__setattr__(self, "meshes", tuple(meshes))
        object.__setattr__(self, "frames", frames)
        object.__setattr__(self, "bodies", bodies)
        object.__setattr__(self, "turns", turns)
        object.__setattr__(self, "fills", fills)

    @cached_property
    def volumes(self) -> NDArray[np.float64]:
        """Volume that each hull displaces when it is under water (h,) [m^3]."""
        return self.fills * [mesh.volume for mesh in self.meshes]


Measure = Callable[
    [int, NDArray[np.float64], NDArray[np.float64]], tuple[float, NDArray[np.float64]]
]
"""Function of a hull's index, its origin (3,) [m] and its world_from_frame, row-major (9,).

It returns the submerged volume [m^3] and its centroid (3,) [m], relative to the origin, along the
world's axes; NaN when dry."""


def submerge_each(
    hulls: HullSet,
    positions: NDArray[np.float64],
    rotations: NDArray[np.float64],
    measure: Measure,
    results: NDArray[np.float64],
) -> None:
    """Measure one hull after the other, for methods written in Python that know no areas.

    Args:
        hulls: the hulls (h).
        positions: origins of the frames (n, 3) [m], world frame.
        rotations: world_from_frame of the frames, row-major (n, 9).
        measure: finds what is wet of one hull.
        results: written, see `methods.Packed.results`; NaN throughout for a pose that is not
            finite.
    """
    results[:] = np.nan
    for h, frame in enumerate(hulls.frames):
        origin, rotation = positions[frame], rotations[frame]
        if np.isfinite(origin).all() and np.isfinite(rotation).all():
            volume, centroid = measure(h, origin, rotation)
            results[h, clip.VOLUME] = hulls.fills[h] * volume
            results[h, clip.CENTROID] = centroid + origin

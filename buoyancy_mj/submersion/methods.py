"""The ways to find what is under water, by name: the exact one, and the two of the source paper."""

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MethodError, choices
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.sections import Sections


class Packed(Protocol):
    """Hulls ready to be submerged together, again and again."""

    results: NDArray[np.float64]
    """Last submersion (h, 6): volume, centroid (NaN when dry), wetted area, waterplane area (NaN if the method has none)."""
    volumes: NDArray[np.float64]
    """What the whole meshes displace (h,) [m^3]."""

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far, in the method's own units."""
        ...

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        run: int = 0,
    ) -> NDArray[np.float64]:
        """Submersion of all hulls at a time [s], written to and returned as `results`.

        Args:
            positions: origins of the frames (n, 3) [m], world frame.
            rotations: world_from_frame of the frames, row-major (n, 9).
            time: [s].
            run: whose step this is; a method that carries something from step to step does so within a run.
        """
        ...


class Method(Protocol):
    """A way to find what is under water, and its options."""

    @property
    def name(self) -> str:
        """What it is called in scenes and on the command line."""
        ...

    def pack(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        bodies: ArrayLike,
        water: Water,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> Packed:
        """Hulls ready to be submerged.

        Args:
            meshes: the hulls (h).
            frames: which row of positions and rotations places each (h,).
            bodies: hulls of one number (h,) move together.
            water: the sea.
            turns: body_from_frame, how the frame of each hull is turned in its body (h, 3, 3); None for not at all.
            fills: part of each mesh's volume that displaces water (h,); None for all of it.
        """
        ...


METHODS: Mapping[str, type[Exact] | type[ConvexHull] | type[Sections]] = {
    method.name: method for method in (Exact, ConvexHull, Sections)
}
"""The methods by name."""


def parse_method(method: str | Method) -> Method:
    """A method as it is, or the one of a name with its defaults.

    Raises:
        MethodError: there is no such method.
    """
    if isinstance(method, str):
        if method not in METHODS:
            raise MethodError(f"unknown method '{method}'; {choices(method, METHODS)}")
        return METHODS[method]()
    if isinstance(method, type) or not hasattr(method, "pack"):
        raise MethodError(
            f"{method!r} is no method; possible are {', '.join(METHODS)}, or one of them with options"
        )
    return method

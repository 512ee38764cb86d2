"""The methods that find the submerged part of hulls, by name, and the protocol that they follow.

A fourth method is a frozen dataclass of its options with a `name` and a `pack`, as `Method` asks,
in a module beside the others; `pack` returns an object as `Packed` asks. One more entry in
`METHODS` makes it known to scenes, the plugin and the command line.
"""

import functools
from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MethodError, choices, describe
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.convex_hull import ConvexHull
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.sections import Sections


class Packed(Protocol):
    """Hulls packed by a method, ready to be submerged again and again."""

    results: NDArray[np.float64]
    """Last submersion of each hull (h, 8); `kernels.clip` names the columns.

    They are the volume [m^3], its centroid (3) [m] in the world frame (NaN when dry), the wetted
    area and the waterplane area [m^2] (NaN from a method that knows no areas)."""
    volumes: NDArray[np.float64]
    """Volume that each hull displaces when it is under water (h,) [m^3]."""

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far, in the method's own units; empty from a method that does not count."""
        ...

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        run: int = 0,
        /,
    ) -> NDArray[np.float64]:
        """Submerge all hulls; return `results`, written anew.

        A method written in Python, hull by hull, may leave the loop to `hull_set.submerge_each`.

        Args:
            positions: origins of the frames (n, 3) [m], world frame.
            rotations: world_from_frame of the frames, row-major (n, 9).
            time: of the water [s].
            run: number of the simulation that takes this step. Several may share the hulls; what a
                method carries from step to step it carries within a run.
        """
        ...


class Method(Protocol):
    """A way to find the submerged part of hulls, with its options."""

    @property
    def name(self) -> str:
        """Name in scenes, in the plugin and on the command line."""
        ...

    def pack(self, hulls: HullSet, water: Water) -> Packed:
        """Prepare hulls, so that each step repeats no work that the first could do.

        Raises:
            MethodError: an option does not fit these hulls.
        """
        ...


METHODS: Mapping[str, type[Exact] | type[ConvexHull] | type[Sections]] = {
    method.name: method for method in (Exact, ConvexHull, Sections)
}
"""The methods by name."""


def parse_method(method: str | Method) -> Method:
    """Return a method as it is, or the one of a name with its defaults.

    Raises:
        MethodError: there is no such method.
    """
    if isinstance(method, str):
        if method not in METHODS:
            raise MethodError(f"unknown method {describe(method)}; {choices(method, METHODS)}")
        return _with_defaults(method)
    if isinstance(method, type) or not hasattr(method, "pack"):
        raise MethodError(
            f"{describe(method)} is no method; possible are {', '.join(METHODS)}, "
            "or one of them with options"
        )
    return method


@functools.cache
def _with_defaults(name: str) -> Method:
    """The method of a name, made once: `submerge` asks for it in each call."""
    return METHODS[name]()

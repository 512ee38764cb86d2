"""`Sections`: the source paper's cheaper method, cross-sections integrated along an axis.

After Mahbub and Shaharear (2025). The areas are those of true sections of the mesh, hollows
included. The error comes from the steps between sections, and from the surface, which is
replaced by a plane perpendicular to the axis: an axis fixed in a body that heels cuts it wrongly.
"""

import dataclasses
import functools
import math
from collections.abc import Mapping
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MethodError, choices, describe
from buoyancy_mj.kernels import clip
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.cross_sections import complete_axes, cut_sections, integrate
from buoyancy_mj.submersion.hull_set import HullSet, submerge_each
from buoyancy_mj.values import read_array, set_number

RULES = ("trapezoid", "simpson")
"""Rules of integration."""
MOST_SECTIONS = 100_000
"""Most sections across one hull."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sections:
    """Areas of cross-sections at a fixed step, integrated along an axis up to the surface.

    The surface is a plane for each hull: level, at the height of the water over the hull's middle.
    That cuts a hull wrongly that is long compared to the waves.

    Raises:
        MethodError: a step that is not positive, an axis without direction, or an unknown rule.
    """

    name: ClassVar[str] = "sections"
    """What scenes and the command line call the method."""
    step: float | None = None
    """Distance between sections [m]; None for a 100th of each hull's extent along the axis."""
    axis: tuple[float, float, float] | None = None
    """Direction (3,) of the axis in the frame of each body; None for one that stays vertical.

    Along a vertical axis the sections are cut anew at each step, since a body that turns has
    others. Along an axis of the body they are tabulated once, and the surface cuts the axis where
    it meets it through the middle of the hull: right upright, wrong by what the heel does to the
    waterline."""
    rule: str = "trapezoid"
    """Rule of integration: "trapezoid" or "simpson"."""

    def __post_init__(self) -> None:
        if self.rule not in RULES:
            raise MethodError(f"rule is {describe(self.rule)}; {choices(self.rule, RULES)}")
        if self.step is not None:
            _read_step(self)
        if self.axis is not None:
            object.__setattr__(self, "axis", _read_axis(self.axis))

    def pack(self, hulls: HullSet, water: Water) -> "PackedSections":
        """Prepare hulls; along an axis of the body, tabulate their sections."""
        return PackedSections(self, hulls, water)


class _Table(NamedTuple):
    """Sections of one hull along an axis that is fixed in it."""

    axes: NDArray[np.float64]
    """Right-handed axes (3, 3) in the hull's frame, as rows; the sections are across the third."""
    heights: NDArray[np.float64]
    """Heights of the sections along the third axis (n,) [m]."""
    rows: NDArray[np.float64]
    """Areas and moments (n, 4), see `cut_sections`."""
    integrals: NDArray[np.float64]
    """Integrals of the rows up to each height (n, 4)."""


class PackedSections:
    """Hulls whose submersion is integrated from cross-sections; see `methods.Packed`."""

    def __init__(self, method: Sections, hulls: HullSet, water: Water) -> None:
        """Pack hulls.

        Raises:
            MethodError: the step is so small that a mesh has more than `MOST_SECTIONS` sections.
        """
        self.method = method
        self.hulls = hulls
        self.water = water
        self.volumes = hulls.volumes
        """Volume that each hull displaces when it is under water (h,) [m^3]."""
        self.results = np.zeros((len(hulls.meshes), clip.COLUMNS))
        """Last submersion (h, 8): volume and centroid; the areas are not known (NaN)."""

        # meshes, and the middles of their bounding boxes
        self._meshes = [mesh.compact for mesh in hulls.meshes]
        self._check_step()
        self._middles = [
            0.5 * (vertices.min(axis=0) + vertices.max(axis=0)) for vertices, _ in self._meshes
        ]

        # work done, and tables along an axis of the body
        self._counts = dict.fromkeys(("calls", "sections", "crossings", "tabulated", "look_ups"), 0)
        self._tables = None
        if method.axis is not None:
            axis = np.array(method.axis)
            self._tables = [self._tabulate(h, axis @ turn) for h, turn in enumerate(hulls.turns)]

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far.

        `sections` is how many cross-sections were cut in all calls, `crossings` how many triangles
        these met, `tabulated` how many sections were cut before, and `look_ups` how often their
        tables were read.
        """
        return dict(self._counts)

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        _run: int = 0,
        /,
    ) -> NDArray[np.float64]:
        """Submerge all hulls at a time [s]; return `results`, see `methods.Packed`."""
        measure = functools.partial(self._measure, time)
        submerge_each(self.hulls, positions, rotations, measure, self.results)
        self._counts["calls"] += 1
        return self.results

    def _measure(
        self, time: float, h: int, origin: NDArray[np.float64], rotation: NDArray[np.float64]
    ) -> tuple[float, NDArray[np.float64]]:
        """Volume and centroid of what is wet of one hull, see `hull_set.Measure`."""
        turn = rotation.reshape(3, 3)
        x, y, z = origin + turn @ self._middles[h]
        depth = float(self.water.elevation(x, y, time)) - z
        integrate_to = self._integrate_upright if self._tables is None else self._integrate_along
        volume, *moments = integrate_to(h, turn, depth)
        if not volume > 0.0:
            return 0.0, np.full(3, np.nan)
        return volume, np.array(moments) / volume

    def _integrate_upright(
        self, h: int, turn: NDArray[np.float64], depth: float
    ) -> NDArray[np.float64]:
        """Volume and first moments (4,) about the origin, from sections parallel to still water.

        Args:
            h: index of the hull.
            turn: world_from_frame (3, 3).
            depth: of the hull's middle under the surface [m].
        """
        vertices, faces = self._meshes[h]
        top = depth + float(turn[2] @ self._middles[h])
        s, rows, crossings = cut_sections(vertices @ turn.T, faces, self.method.step, top)
        self._counts["sections"] += len(s)
        self._counts["crossings"] += crossings
        moments: NDArray[np.float64] = integrate(rows, s, self.method.rule)[-1]
        return moments

    def _integrate_along(
        self, h: int, turn: NDArray[np.float64], depth: float
    ) -> NDArray[np.float64]:
        """Volume and first moments (4,), from the table along the axis, up or down to the surface.

        The arguments are those of `_integrate_upright`.
        """
        assert self._tables is not None
        table = self._tables[h]
        axis, s = table.axes[2], table.heights
        self._counts["look_ups"] += 1

        # where the surface meets the axis; of an axis that lies level all is wet or nothing
        upward = float(turn[2] @ axis)
        above = depth / upward if upward else math.copysign(math.inf, depth)
        at = float(np.clip(axis @ self._middles[h] + above, s[0], s[-1]))

        # the integral up to there, linear between two sections
        i = int(np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(s) - 2))
        part = (at - s[i]) / (s[i + 1] - s[i])
        row = table.rows[i] + part * (table.rows[i + 1] - table.rows[i])
        moments = table.integrals[i] + 0.5 * (at - s[i]) * (table.rows[i] + row)
        if upward < 0.0:
            moments = table.integrals[-1] - moments
        return np.array([moments[0], *(turn @ table.axes.T @ moments[1:])])

    def _tabulate(self, h: int, axis: NDArray[np.float64]) -> _Table:
        """Cut and integrate all sections of a hull along an axis (3,) in its frame."""
        axes = complete_axes(axis)
        vertices, faces = self._meshes[h]
        s, rows, _ = cut_sections(vertices @ axes.T, faces, self.method.step, math.inf)
        self._counts["tabulated"] += len(s)
        return _Table(axes, s, rows, integrate(rows, s, self.method.rule))

    def _check_step(self) -> None:
        """Refuse a step that would cut a mesh into more than `MOST_SECTIONS` sections."""
        step = self.method.step
        for vertices, _ in self._meshes:
            length = float(np.linalg.norm(np.ptp(vertices, axis=0)))
            if step is not None and length / step > MOST_SECTIONS:
                raise MethodError(
                    f"step is {step:g} m on a mesh {length:.3g} m long; "
                    f"it must leave at most {MOST_SECTIONS:,} sections"
                )


def _read_step(method: Sections) -> None:
    """Keep the step as a positive length [m]."""
    try:
        set_number(method, MethodError, "step", above=0.0)
    except MethodError:
        raise MethodError(
            f"step is {describe(method.step)}; it must be a positive length [m]"
        ) from None


def _read_axis(axis: object) -> tuple[float, float, float]:
    """The direction (3,) of an axis."""
    try:
        x, y, z = read_array(MethodError, "axis", axis, (3,)).tolist()
    except MethodError:
        x = y = z = 0.0
    if not (x or y or z):
        raise MethodError(
            f"axis is {describe(axis)}; it must be three finite numbers, not all zero"
        )
    return x, y, z

"""`Sections`: the source paper's cheaper method, cross-sections integrated along an axis.

After Mahbub and Shaharear (2025). The areas are those of true sections of the mesh, hollows
included. What it costs in truth: steps between sections; the surface is a plane perpendicular to
the axis, so an axis fixed in a body that heels cuts it wrongly.
"""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import cumulative_simpson, cumulative_trapezoid

from buoyancy_mj.errors import MethodError, choices
from buoyancy_mj.kernels import clip, slices
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water

RULES = ("trapezoid", "simpson")
"""Rules of integration."""
STEPS = 100
"""Sections across a hull where no step is given."""
LEAST = 10
"""Sections across a hull at least: a step longer than that allows is shortened, else small hulls would be lost."""
MOST_SECTIONS = 100_000
"""More than these across one hull are refused."""
_INSIDE = 1e-6  # sections at the ends lie this fraction of the height inside them: flat ends count, though rounded


@dataclasses.dataclass(frozen=True, kw_only=True)
class Sections:
    """Areas of cross-sections at a fixed step, integrated along an axis up to the surface.

    The surface is a plane for each hull: level, at the height of the water over its middle. A hull
    that is long for the waves is cut wrongly by that.

    Raises:
        MethodError: a step that is not positive, an axis without direction, an unknown rule.
    """

    name: ClassVar[str] = "sections"
    step: float | None = None
    """Distance between sections [m]; None for a 100th of each hull's extent along the axis."""
    axis: tuple[float, float, float] | None = None
    """Direction (3,) of the axis in the frame of each body; None for one that stays vertical.

    Along a vertical axis the sections are cut anew at each step, since a body that turns has others.
    Along an axis of the body they are tabulated once, and the surface is taken where it meets the
    axis through the middle of the hull: right upright, wrong by what the heel does to the waterline."""
    rule: str = "trapezoid"
    """Of integration: "trapezoid" or "simpson"."""

    def __post_init__(self) -> None:
        if self.rule not in RULES:
            raise MethodError(f"rule is {self.rule!r}; {choices(str(self.rule), RULES)}")
        if self.step is not None and not (_is_number(self.step) and 0.0 < self.step < math.inf):
            raise MethodError(f"step is {self.step!r}; it must be a positive length [m]")
        if self.axis is not None:
            if (
                len(self.axis) != 3
                or not all(_is_number(x) and math.isfinite(x) for x in self.axis)
                or not any(self.axis)
            ):
                raise MethodError(
                    f"axis is {self.axis!r}; it must be three finite numbers, not all zero"
                )
            object.__setattr__(self, "axis", tuple(float(x) for x in self.axis))

    def pack(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        bodies: ArrayLike,
        water: Water,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> "PackedSections":
        """Hulls ready to be submerged, see `PackedSections`."""
        return PackedSections(self, meshes, frames, water, turns, fills)


class PackedSections:
    """Hulls whose submersion is integrated from cross-sections."""

    def __init__(
        self,
        method: Sections,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        water: Water,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> None:
        """Pack `meshes`, see `methods.Method`.

        Raises:
            MethodError: a step so small that a mesh has more than `MOST_SECTIONS` sections.
        """
        self.method = method
        self.water = water
        self.frames = np.asarray(frames, np.int64)
        self._fills = np.ones(len(meshes)) if fills is None else np.asarray(fills, float)
        self.volumes = self._fills * [mesh.volume for mesh in meshes]
        """True volumes of the meshes (h,) [m^3]."""
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion (h, 6): volume and centroid; the areas are not known (NaN)."""
        self._meshes = [mesh.compact for mesh in meshes]
        self._middles = [
            0.5 * (vertices.min(axis=0) + vertices.max(axis=0)) for vertices, _ in self._meshes
        ]
        for vertices, _ in self._meshes:
            length = float(np.linalg.norm(np.ptp(vertices, axis=0)))
            if method.step is not None and length / method.step > MOST_SECTIONS:
                most = f"{MOST_SECTIONS:,}"
                raise MethodError(
                    f"step is {method.step:g} m on a mesh {length:.3g} m long; it must leave at most {most} sections"
                )
        self._counts = dict.fromkeys(("calls", "sections", "crossings", "tabulated", "look_ups"), 0)
        self._tables = None
        if method.axis is not None:
            rotations = (
                np.tile(np.eye(3), (len(meshes), 1, 1))
                if turns is None
                else np.asarray(turns, float)
            )
            self._tables = [
                self._table(h, np.asarray(method.axis) @ turn) for h, turn in enumerate(rotations)
            ]

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far.

        `sections` is how many cross-sections were cut in all calls, `crossings` how many triangles
        these met, `tabulated` how many sections were cut before, and `look_ups` how often the tables
        of these were read.
        """
        return dict(self._counts)

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        run: int = 0,
    ) -> NDArray[np.float64]:
        """Submersion of all hulls at a time [s], written to and returned as `results`; see `methods.Packed`."""
        for h, frame in enumerate(self.frames):
            if not (np.isfinite(positions[frame]).all() and np.isfinite(rotations[frame]).all()):
                self.results[h] = np.nan
                continue
            origin, turn = positions[frame], rotations[frame].reshape(3, 3)
            x, y, z = origin + turn @ self._middles[h]
            depth = float(self.water.elevation(x, y, time)) - z
            moments = (
                self._upright(h, turn, depth)
                if self._tables is None
                else self._along(h, turn, depth)
            )
            volume = moments[0] if moments[0] > 0.0 else 0.0
            centroid = moments[1:] / volume + origin if volume else np.full(3, np.nan)
            self.results[h] = self._fills[h] * volume, *centroid, np.nan, np.nan
        self._counts["calls"] += 1
        return self.results

    def _upright(self, h: int, turn: NDArray[np.float64], depth: float) -> NDArray[np.float64]:
        """Volume and first moments (4,) about the origin of the frame, from sections parallel to the still surface."""
        vertices, faces = self._meshes[h]
        points = vertices @ turn.T
        s, rows, crossings = sections(
            points, faces, self.method.step, depth + float(turn[2] @ self._middles[h])
        )
        self._counts["sections"] += len(s)
        self._counts["crossings"] += crossings
        return integrate(rows, s, self.method.rule)[-1]

    def _along(self, h: int, turn: NDArray[np.float64], depth: float) -> NDArray[np.float64]:
        """The same from the table along the hull's own axis, up or down to where the surface meets it."""
        assert self._tables is not None
        axes, s, rows, below = self._tables[h]
        self._counts["look_ups"] += 1
        upward = float(turn[2] @ axes[2])
        # of an axis that lies level all is wet or nothing
        above = depth / upward if upward else math.copysign(math.inf, depth)
        at = float(np.clip(axes[2] @ self._middles[h] + above, s[0], s[-1]))
        i = int(np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(s) - 2))
        part = (at - s[i]) / (s[i + 1] - s[i])
        row = rows[i] + part * (rows[i + 1] - rows[i])
        under = below[i] + 0.5 * (at - s[i]) * (rows[i] + row)
        if upward < 0.0:
            under = below[-1] - under
        return np.array([under[0], *(turn @ axes.T @ under[1:])])

    def _table(self, h: int, axis: NDArray[np.float64]) -> tuple[NDArray[np.float64], ...]:
        """Axes (3, 3), heights (n,), section rows (n, 4) and their integrals up to each height (n, 4)."""
        axes = _axes(axis)
        vertices, faces = self._meshes[h]
        s, rows, _ = sections(vertices @ axes.T, faces, self.method.step, math.inf)
        self._counts["tabulated"] += len(s)
        return axes, s, rows, integrate(rows, s, self.method.rule)


def sections(
    points: NDArray[np.float64], faces: NDArray[np.int64], step: float | None, top: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], int]:
    """Cross-sections of a closed mesh perpendicular to its third coordinate, from its lowest point up to `top`.

    Args:
        points: vertices (v, 3) [m], along right-handed axes u, v, s.
        faces: of the mesh (f, 3).
        step: between sections [m], or shorter, see `LEAST`; None for a 100th of the extent along s. The last
            section, at `top` or the highest point, comes sooner.
        top: highest s [m] of interest.

    Returns:
        Heights (n,) [m] of the sections; rows (n, 4): area A [m^2] and its moments int u dA, int v dA,
        s A [m^3]; and how many triangles the sections meet. Nothing (0,) where the mesh lies above `top`.
    """
    low, high = points[:, 2].min(), points[:, 2].max()
    end, inside = min(top, high), _INSIDE * (high - low)
    if not end > low:
        return np.zeros(0), np.zeros((0, 4)), 0
    step = (high - low) / STEPS if step is None else min(step, (high - low) / LEAST)
    s = np.append(low + step * np.arange(max(1, math.ceil((end - low) / step - 1e-9))), end)
    out = np.empty((len(s), 3))
    crossings = slices.sections(points, faces, np.clip(s, low + inside, high - inside), out)
    return s, np.column_stack([out, out[:, 0] * s]), int(crossings)


def integrate(rows: NDArray[np.float64], s: NDArray[np.float64], rule: str) -> NDArray[np.float64]:
    """Integrals (n, k) of rows (n, k) over s (n,), from its first value up to each; at least one row, of zeros.

    The last interval is shorter than the others, and always a trapezoid: a parabola through three
    points, two of them close together and an area's jump between them, could lead anywhere.
    """
    if len(s) < 2:
        return np.zeros((1, rows.shape[1]))
    out = cumulative_trapezoid(rows, s, axis=0, initial=0.0)
    if rule == "simpson" and len(s) > 3:
        out[-1] -= out[-2]
        out[:-1] = cumulative_simpson(rows[:-1], dx=s[1] - s[0], axis=0, initial=0.0)
        out[-1] += out[-2]
    return out


def _axes(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Right-handed axes (3, 3), as rows, of which the third is `axis`."""
    # scaled first, so that the squares of tiny and huge numbers do not vanish or overflow
    third = axis / np.abs(axis).max()
    third = third / np.linalg.norm(third)
    first = np.cross(np.eye(3)[np.argmin(np.abs(third))], third)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(third, first), third])


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)

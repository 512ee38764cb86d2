"""`ConvexHull`: the source paper's method, the convex hull of the vertices under the surface.

After Mahbub and Shaharear (2025). It errs in three ways: a convex hull fills every hollow; without
the points where edges meet the surface it ends at the last vertex below; and the mean of its
vertices is no centroid.
"""

import dataclasses
import functools
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MethodError, choices, describe
from buoyancy_mj.kernels import clip, slices
from buoyancy_mj.meshes.surface import undirected_edges
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.hull_set import HullSet, submerge_each
from buoyancy_mj.submersion.quickhull import hull_moments
from buoyancy_mj.values import read_truth, read_whole_number

CENTROIDS = ("vertices", "hull")
"""Kinds of centre of buoyancy: the mean of the hull's vertices, or its true centroid."""
JUMP = 0.3
"""Motion within a step, in turns [rad] and hull lengths, beyond which a body was set by hand."""
NUDGE = 0.01
"""The same within one time, at which RK4 tries several poses."""
MOST_RUNS = 64
"""Most runs whose orders of vertices are kept."""
_X, _DEPTH = slice(3), 3
"""Columns of placed vertices: position relative to the origin, and depth."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class ConvexHull:
    """The convex hull, by Quickhull, of each mesh's vertices under the surface.

    Raises:
        MethodError: an unknown kind of centroid, or a negative number of steps.
    """

    name: ClassVar[str] = "convex_hull"
    """What scenes and the command line call the method."""
    cut: bool = False
    """Add the points where edges meet the surface, which the paper's set of vertices lacks."""
    centroid: str = "vertices"
    """Centre of buoyancy: "vertices" for the mean of the hull's vertices, as in the paper, or
    "hull" for the hull's centroid."""
    resort_every: int = 10
    """Steps after which the vertices are sorted by depth anew; 0 looks at all of them each step.

    A step is a call at a later time than the last; RK4 makes two of them, and poses set by hand
    sort at once. Between sorts the vertices are walked from the one that was lowest until one is
    dry, so that a body that turns meanwhile may lose some."""

    def __post_init__(self) -> None:
        if self.centroid not in CENTROIDS:
            raise MethodError(
                f"centroid is {describe(self.centroid)}; {choices(self.centroid, CENTROIDS)}"
            )
        object.__setattr__(self, "cut", read_truth(MethodError, "cut", self.cut))
        try:
            steps = read_whole_number(MethodError, "", self.resort_every, 0, 2**31)
        except MethodError:
            raise MethodError(
                f"resort_every is {describe(self.resort_every)}; "
                "it must be a number of steps, or 0 for no sorting"
            ) from None
        object.__setattr__(self, "resort_every", steps)

    def pack(self, hulls: HullSet, water: Water) -> "PackedConvexHulls":
        """Prepare hulls: drop unused vertices, list the edges."""
        return PackedConvexHulls(self, hulls, water)


class _Run:
    """The order of vertices that a run carries from step to step."""

    def __init__(self, orders: Sequence[NDArray[np.int64]]) -> None:
        self.orders = list(orders)
        """Indices of the vertices of each hull, the lowest first."""
        self.age = 0
        """Steps since they were sorted."""
        self.time = np.nan
        """Time of the last call [s]."""
        self.poses = np.empty((0, 12))
        """Poses of the hulls at the last call (h, 12): rotations, and positions in hull lengths."""

    def follow(self, poses: NDArray[np.float64], time: float, resort_every: int) -> bool:
        """Note the poses of a call; return whether the orders must be made anew.

        That is so when they are `resort_every` steps old, or when the poses were set by hand.
        """
        later = time > self.time
        reach = JUMP if later else NUDGE
        moved = not time >= self.time or not np.abs(poses - self.poses).max() <= reach
        self.age += later
        self.time = time
        self.poses = poses
        if resort_every and (moved or self.age >= resort_every):
            self.age = 0
            return True
        return False


class PackedConvexHulls:
    """Hulls whose submersion is the convex hull of their wet vertices; see `methods.Packed`."""

    def __init__(self, method: ConvexHull, hulls: HullSet, water: Water) -> None:
        self.method = method
        self.hulls = hulls
        self.water = water
        # kernels are compiled for arrays that can be written to
        self._waves = water.table.copy()
        self.volumes = hulls.volumes
        """Volume that each hull displaces when it is under water (h,) [m^3]."""
        self.results = np.zeros((len(hulls.meshes), clip.COLUMNS))
        """Last submersion (h, 8): volume and centroid; the areas are not known (NaN)."""

        # vertices, and edges where they are cut
        meshes = [mesh.compact for mesh in hulls.meshes]
        self._vertices = [vertices for vertices, _ in meshes]
        self._edges = []
        if method.cut:
            self._edges = [undirected_edges(faces) for _, faces in meshes]

        # every vertex in turn, the length of the hulls, and room for the vertices of one
        self._all = [np.arange(len(vertices)) for vertices in self._vertices]
        self._length = max(float(np.ptp(vertices, axis=0).max()) for vertices in self._vertices)
        self._points = np.empty((max(len(vertices) for vertices in self._vertices), 4))

        # memory of runs and of work
        self._runs: OrderedDict[int, _Run] = OrderedDict()
        self._counts = dict.fromkeys(
            ("calls", "vertices", "vertex_checks", "sorts", "hulls", "hull_points"), 0
        )

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far.

        `vertices` is the vertices of all meshes times the calls, `vertex_checks` how many of them
        were compared with the surface, `sorts` how often an order was made, `hulls` how often
        Quickhull ran and `hull_points` on how many points in all.
        """
        return dict(self._counts)

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        run: int = 0,
        /,
    ) -> NDArray[np.float64]:
        """Submerge all hulls at a time [s]; return `results`, see `methods.Packed`."""
        # the run, last in the line of those that are kept
        state = self._runs.pop(run, None) or _Run(self._all)
        self._runs[run] = state
        if len(self._runs) > MOST_RUNS:
            self._runs.popitem(last=False)

        # its hulls, sorted anew if need be
        frames = self.hulls.frames
        poses = np.hstack([rotations[frames], positions[frames] / self._length])
        sort = state.follow(poses, time, self.method.resort_every)
        measure = functools.partial(self._measure, state, sort, time)
        submerge_each(self.hulls, positions, rotations, measure, self.results)
        self._counts["calls"] += 1
        return self.results

    def _measure(
        self,
        run: _Run,
        sort: bool,
        time: float,
        h: int,
        origin: NDArray[np.float64],
        rotation: NDArray[np.float64],
    ) -> tuple[float, NDArray[np.float64]]:
        """Volume and centroid of what is wet of one hull, see `hull_set.Measure`."""
        # the vertices, all of them or the lowest first until one is dry
        walk = self.method.resort_every > 0 and not sort
        order = run.orders[h] if walk else self._all[h]
        place = functools.partial(self._place, h, origin, rotation, time)
        placed = place(order, walk)
        self._counts["vertices"] += len(order)
        self._counts["vertex_checks"] += len(placed)
        if sort:
            self._counts["sorts"] += 1
            run.orders[h] = np.argsort(-placed[:, _DEPTH], kind="stable")

        # those that are wet, and the cuts of the edges that leave them
        wet = placed[:, _DEPTH] > 0.0
        points = placed[wet]
        if self.method.cut:
            inner, outer, ends = self._crossing_edges(h, order[: len(placed)][wet])
            outer_points = place(ends, False)[outer]
            self._counts["vertex_checks"] += len(ends) if walk else 0
            points = np.vstack([points, _cut(points[inner], outer_points)])

        # their hull
        if len(points) > 3:
            self._counts["hulls"] += 1
            self._counts["hull_points"] += len(points)
        return hull_moments(points[:, _X], self.method.centroid)

    def _crossing_edges(
        self, h: int, wet: NDArray[np.int64]
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
        """Edges of a hull with one end among its wet vertices.

        Returns:
            Where the wet end of each stands in `wet` (n,); where its other end stands in the third
            array (n,); and those ends, as indices of vertices (k,).
        """
        row = np.full(len(self._vertices[h]), -1)
        row[wet] = np.arange(len(wet))
        edges = self._edges[h][(row[self._edges[h]] >= 0).sum(axis=1) == 1]
        inner = np.where(row[edges[:, 0]] >= 0, edges[:, 0], edges[:, 1])
        ends, outer = np.unique(edges.sum(axis=1) - inner, return_inverse=True)
        return row[inner], outer, ends

    def _place(
        self,
        h: int,
        origin: NDArray[np.float64],
        rotation: NDArray[np.float64],
        time: float,
        order: NDArray[np.int64],
        until_dry: bool,
    ) -> NDArray[np.float64]:
        """Place vertices in the world, if wished up to the first dry one.

        Returns:
            Positions relative to the origin, along the world's axes, and depths (n, 4) [m].
        """
        seen = slices.place(
            self._vertices[h],
            order,
            until_dry,
            origin,
            rotation,
            self.water.level,
            self._waves,
            time,
            self._points,
        )
        return self._points[:seen].copy()


def _cut(inside: NDArray[np.float64], outside: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points (n, 4) where edges from wet points (n, 4) to others (n, 4) meet the surface.

    An outer end that the walk did not reach may yet be wet: then the cut is that end itself.
    """
    depth = inside[:, _DEPTH, None]
    above = np.minimum(outside[:, _DEPTH, None], 0.0)
    return inside + depth / (depth - above) * (outside - inside)

"""`ConvexHull`: the source paper's method, the convex hull of the vertices under the surface.

After Mahbub and Shaharear (2025). What it costs in truth: a convex hull fills every hollow; without
the points where edges meet the surface it ends at the last vertex below it; and the mean of its
vertices is no centroid.
"""

import dataclasses
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import spatial
from trimesh.geometry import faces_to_edges

from buoyancy_mj.errors import MethodError, choices
from buoyancy_mj.kernels import clip, slices
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.sea.water import Water

CENTROIDS = ("vertices", "hull")
"""What may stand for the centre of buoyancy: the mean of the hull's vertices, or its true centroid."""
FLAT = 1e-12
"""Smallest over largest extent of a set of points that counts as flat."""
JUMP, NUDGE = 0.3, 0.01
"""How far a body may go from call to call, in turns [rad] and hull lengths, before it counts as set there by hand:
from step to step, and at one time, where RK4 tries several poses."""
MOST_RUNS = 64
"""Runs whose orders are kept."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class ConvexHull:
    """The convex hull, by Quickhull, of each mesh's vertices under the surface.

    Raises:
        MethodError: an unknown kind of centroid, or a negative number of steps.
    """

    name: ClassVar[str] = "convex_hull"
    cut: bool = False
    """Add the points where edges meet the surface, which the paper's set of vertices lacks."""
    centroid: str = "vertices"
    """The mean of the hull's vertices, as the paper has it, or the centroid of the "hull"."""
    resort_every: int = 10
    """Steps after which the vertices are sorted by height above the surface anew; 0 looks at all of them each step.

    A step is a call at a later time than the last; RK4 makes two of them, and poses set by hand sort
    at once. Between sorts the vertices are walked from the one that was lowest until one is dry, so
    that a body that turns meanwhile may lose some."""

    def __post_init__(self) -> None:
        if self.centroid not in CENTROIDS:
            raise MethodError(
                f"centroid is {self.centroid!r}; {choices(str(self.centroid), CENTROIDS)}"
            )
        if not isinstance(self.cut, bool):
            raise MethodError(f"cut is {self.cut!r}; it must be True or False")
        if (
            isinstance(self.resort_every, bool)
            or not isinstance(self.resort_every, int | np.integer)
            or self.resort_every < 0
        ):
            raise MethodError(
                f"resort_every is {self.resort_every!r}; it must be a number of steps, or 0 for no sorting"
            )

    def pack(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        bodies: ArrayLike,
        water: Water,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> "PackedConvexHulls":
        """Hulls ready to be submerged, see `PackedConvexHulls`."""
        return PackedConvexHulls(self, meshes, frames, water, fills)


class _Run:
    """The order of vertices that a run carries from step to step."""

    def __init__(self, orders: Sequence[NDArray[np.int64]]) -> None:
        self.orders = list(orders)
        """Indices of the vertices of each hull, the lowest first."""
        self.age = 0
        """Steps since they were sorted."""
        self.time = np.nan
        """Of the last call [s]."""
        self.poses = np.empty((0, 12))
        """Of the hulls then."""


class PackedConvexHulls:
    """Hulls whose submersion is that of the convex hulls of their wet vertices."""

    def __init__(
        self,
        method: ConvexHull,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        water: Water,
        fills: ArrayLike | None = None,
    ) -> None:
        """Pack `meshes`, see `methods.Method`."""
        self.method = method
        self.water = water
        self.frames = np.asarray(frames, np.int64)
        self._fills = np.ones(len(meshes)) if fills is None else np.asarray(fills, float)
        self.volumes = self._fills * [mesh.volume for mesh in meshes]
        """True volumes of the meshes (h,) [m^3]."""
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion (h, 6): volume and centroid; the areas are not known (NaN)."""
        self._vertices = [mesh.compact[0] for mesh in meshes]
        self._edges = []
        if method.cut:
            self._edges = [
                np.unique(np.sort(faces_to_edges(mesh.compact[1])), axis=0) for mesh in meshes
            ]
        self._all = [np.arange(len(vertices)) for vertices in self._vertices]
        self._length = max(float(np.ptp(vertices, axis=0).max()) for vertices in self._vertices)
        self._runs: OrderedDict[int, _Run] = OrderedDict()
        self._points = np.empty((max(len(vertices) for vertices in self._vertices), 4))
        self._counts = dict.fromkeys(
            ("calls", "vertices", "vertex_checks", "sorts", "hulls", "hull_points"), 0
        )

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far.

        `vertices` is the vertices of all meshes times the calls, `vertex_checks` how many of them were
        compared with the surface, `sorts` how often an order was made, `hulls` how often
        Quickhull ran and `hull_points` on how many points in all.
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
        state = self._runs.pop(run, None) or _Run(self._all)
        # those that were not heard of for long have ended
        self._runs[run] = state
        if len(self._runs) > MOST_RUNS:
            self._runs.popitem(last=False)
        sort = self._ages(state, positions, rotations, time)
        for h, frame in enumerate(self.frames):
            if not (np.isfinite(positions[frame]).all() and np.isfinite(rotations[frame]).all()):
                self.results[h] = np.nan
                continue
            points = self._wet(h, state, positions[frame], rotations[frame], time, sort)
            if len(points) > 3:
                self._counts["hulls"] += 1
                self._counts["hull_points"] += len(points)
            volume, centroid = hull_moments(points, self.method.centroid)
            self.results[h] = (
                self._fills[h] * volume,
                *(centroid + positions[frame]),
                np.nan,
                np.nan,
            )
        self._counts["calls"] += 1
        return self.results

    def _ages(
        self, run: _Run, positions: NDArray[np.float64], rotations: NDArray[np.float64], time: float
    ) -> bool:
        """Whether the orders must be made anew: they are as many steps old, or the bodies were set elsewhere by hand."""
        poses = np.hstack([rotations[self.frames], positions[self.frames] / self._length])
        later = time > run.time
        moved = not time >= run.time or not np.abs(poses - run.poses).max() <= (
            JUMP if later else NUDGE
        )
        run.age += later
        run.time, run.poses = time, poses
        if self.method.resort_every and (moved or run.age >= self.method.resort_every):
            run.age = 0
            return True
        return False

    def _wet(
        self,
        h: int,
        run: _Run,
        origin: NDArray[np.float64],
        rotation: NDArray[np.float64],
        time: float,
        sort: bool,
    ) -> NDArray[np.float64]:
        """Points (n, 3) [m] of a hull that span what is wet of it, relative to the origin of its frame."""
        walk = self.method.resort_every > 0 and not sort
        order = run.orders[h] if walk else self._all[h]
        placed = self._placed(h, order, walk, origin, rotation, time)
        self._counts["vertices"] += len(order)
        self._counts["vertex_checks"] += len(placed)
        if sort:
            self._counts["sorts"] += 1
            run.orders[h] = np.argsort(-placed[:, 3], kind="stable")
        wet = placed[:, 3] > 0.0
        points = placed[wet]
        if self.method.cut:
            # edges between wet vertices and others
            row = np.full(len(order), -1)
            row[order[: len(placed)][wet]] = np.arange(len(points))
            edges = self._edges[h][(row[self._edges[h]] >= 0).sum(axis=1) == 1]
            inner = np.where(row[edges[:, 0]] >= 0, edges[:, 0], edges[:, 1])
            ends, of = np.unique(edges.sum(axis=1) - inner, return_inverse=True)
            outer = self._placed(h, ends, False, origin, rotation, time)[of]
            self._counts["vertex_checks"] += len(ends) if walk else 0
            # an end that the walk did not reach may yet be wet: then the end itself
            above = np.minimum(outer[:, 3:], 0.0)
            inside = points[row[inner]]
            points = np.vstack(
                [points, inside + inside[:, 3:] / (inside[:, 3:] - above) * (outer - inside)]
            )
        return points[:, :3]

    def _placed(
        self,
        h: int,
        order: NDArray[np.int64],
        until_dry: bool,
        origin: NDArray[np.float64],
        rotation: NDArray[np.float64],
        time: float,
    ) -> NDArray[np.float64]:
        """Vertices (n, 4), relative to the origin, and their depths; up to the first dry one if so wished."""
        seen = slices.place(
            self._vertices[h],
            order,
            until_dry,
            origin,
            rotation,
            self.water.level,
            self.water.rows,
            time,
            self._points,
        )
        return self._points[:seen].copy()


def hull_moments(
    points: NDArray[np.float64], centroid: str = "hull"
) -> tuple[float, NDArray[np.float64]]:
    """Volume [m^3] of the convex hull of points (n, 3) [m], and its centroid (3,) [m] as `ConvexHull` says.

    The volume is the sum of the signed tetrahedra that the hull's triangles span with a point of
    it. Fewer than four points, flat sets and coincident points enclose nothing: 0 and NaN.
    """
    nothing = 0.0, np.full(3, np.nan)
    if len(points) < 4 or not np.isfinite(points).all():
        return nothing
    try:
        hull = spatial.ConvexHull(points)
    except spatial.QhullError:
        extents = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        if extents[2] <= FLAT * extents[0]:
            return nothing
        # facets that cannot be told apart: Qhull shakes the points a little
        try:
            hull = spatial.ConvexHull(points, qhull_options="QJ")
        except spatial.QhullError:
            return nothing
    middle = points[hull.vertices].mean(axis=0)
    a, b, c = (points - middle)[hull.simplices.T]
    # Qhull gives the outward normals, but not the order of the corners
    normals = np.cross(b - a, c - a)
    outward = np.sign(np.einsum("ij,ij->i", normals, hull.equations[:, :3]))
    tetrahedra = outward * np.einsum("ij,ij->i", a, normals) / 6.0
    volume = float(tetrahedra.sum())
    if not volume > 0.0:
        return nothing
    return volume, middle if centroid == "vertices" else middle + tetrahedra @ (a + b + c) / (
        4.0 * volume
    )

"""`Exact`: the submersion of the meshes themselves, cut where the surface cuts them."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import ClassVar
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MethodError
from buoyancy_mj.kernels import clip, local, pressure, tree, waterplane
from buoyancy_mj.kernels.arrays import conform
from buoyancy_mj.kernels.hulls import WHOLE_VOLUME, Hulls
from buoyancy_mj.kernels.multibody import Geoms
from buoyancy_mj.kernels.scratch import Scratch, new_scratch
from buoyancy_mj.kernels.sea import PressureModel, Sea
from buoyancy_mj.meshes.mesh import TriMesh, refine
from buoyancy_mj.meshes.tree import Tree, grow_tree
from buoyancy_mj.sea.water import Water

MOST_TRIANGLES = 200_000
"""Size to which a mesh may be refined for the waves."""
_TREES: WeakKeyDictionary[TriMesh, dict[float, Tree]] = WeakKeyDictionary()


@dataclasses.dataclass(frozen=True)
class Exact:
    """The volume and centroid of what is under the surface, exact on the mesh: the default
    everywhere.

    Raises:
        MethodError: a tolerance that is not positive.
    """

    name: ClassVar[str] = "exact"
    tolerance: float = 2e-3
    """In waves, the part of a body's volume that straight cuts of its triangles may miss at worst,
    see `longest_edge`.

    That is where a side lies flat in the surface. Elsewhere they miss of second order, a hundredth
    of that and less; and on still water nothing."""

    def __post_init__(self) -> None:
        if (
            isinstance(self.tolerance, bool)
            or not isinstance(self.tolerance, int | float)
            or not 0.0 < self.tolerance <= 1.0
        ):
            raise MethodError(
                f"tolerance is {self.tolerance!r}; it must be a part of the volume, "
                "above 0 and at most 1"
            )

    def pack(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        bodies: ArrayLike,
        water: Water,
        turns: ArrayLike | None = None,
        fills: ArrayLike | None = None,
    ) -> "PackedHulls":
        """Hulls ready to be submerged, see `PackedHulls`."""
        return PackedHulls(meshes, frames, bodies, water, self.tolerance, fills)


class PackedHulls:
    """Hulls in one set of arrays, ready to be submerged together without allocating.

    On still water the results are exact on the mesh. In waves they are but for what straight cuts
    miss, see `Exact.tolerance`.
    """

    def __init__(
        self,
        meshes: Sequence[TriMesh],
        frames: ArrayLike,
        bodies: ArrayLike,
        water: Water,
        tolerance: float = 2e-3,
        fills: ArrayLike | None = None,
    ) -> None:
        """Pack `meshes`.

        Args:
            meshes: the hulls (h).
            frames: which row of positions and rotations places each (h,).
            bodies: hulls of one number (h,) move together; errors in waves are seen against their
                joint volume.
            water: the sea.
            tolerance: see `Exact`.
            fills: part of each mesh's volume that displaces water (h,); None for all of it.
        """
        fills = np.ones(len(meshes)) if fills is None else np.asarray(fills, float)
        edges = _longest_edges(meshes, np.asarray(bodies), water, tolerance)
        trees = [_tree(mesh, edge) for mesh, edge in zip(meshes, edges, strict=True)]
        self.hulls: Hulls = conform(_hulls(meshes, trees, fills, np.asarray(frames), water))
        """The hulls as kernels read them."""
        self._sea = sea_arrays(water)
        spans = self.hulls.spans
        leaves = spans[:, tree.BEHIND] == np.arange(len(spans)) + 1
        vertices = spans[:, tree.END_VERTEX] - spans[:, tree.FIRST_VERTEX]
        self._most = int(vertices[leaves].max())
        self.scratch = self.new_scratch()
        """Where `submerge` and `press` work."""
        self.volumes = self.hulls.whole[:, WHOLE_VOLUME].copy()
        """Volume that the whole meshes displace (h,) [m^3]."""
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion (h, 6): volume, centroid, wetted area, waterplane area."""

    def new_scratch(self) -> Scratch:
        """Arrays for kernels to work in."""
        return new_scratch(self._most, len(self._sea.waves))

    @property
    def counts(self) -> Mapping[str, int]:
        """Work done so far: not counted here."""
        return {}

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        run: int = 0,
    ) -> NDArray[np.float64]:
        """Submersion of all hulls at a time [s], written to and returned as `results`; see
        `methods.Packed`.
        """
        geoms = Geoms(positions, rotations)
        sea, scratch = self._sea, self.scratch.cut
        clip.submerge_hulls(self.hulls, geoms, sea.level, sea.waves, time, scratch, self.results)
        return self.results

    def press(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        *,
        dynamic: bool,
    ) -> NDArray[np.float64]:
        """Pressure on all hulls (h, 6), see `kernels.pressure.press_hulls`."""
        rows = np.empty((len(self.volumes), 6))
        model = PressureModel.froude_krylov if dynamic else PressureModel.hydrostatic
        pressure.press_hulls(
            self.hulls,
            Geoms(positions, rotations),
            self._sea._replace(pressure=int(model)),
            time,
            self.scratch.pressure,
            rows,
        )
        return rows

    def waterplanes(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        about: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Waterplanes of all hulls on the still level about a point (h, 10), see
        `kernels.waterplane.waterplanes`.
        """
        rows = np.empty((len(self.volumes), waterplane.COLUMNS))
        waterplane.waterplanes(
            self.hulls,
            Geoms(positions, rotations),
            about,
            self._sea.level,
            self.scratch.cut.depths[0],
            rows,
        )
        return rows


def sea_arrays(water: Water, pressure_model: PressureModel = PressureModel.archimedes) -> Sea:
    """A sea as kernels read it."""
    return conform(
        Sea(water.rows, water.current_rows, water.density, water.level, int(pressure_model))
    )


def _hulls(
    meshes: Sequence[TriMesh],
    trees: Sequence[Tree],
    fills: NDArray[np.float64],
    frames: NDArray[np.int64],
    water: Water,
) -> Hulls:
    """Meshes and their trees, joined; see `PackedHulls` for the arguments."""
    first_vertex = np.cumsum([0, *(len(t.vertices) for t in trees)])
    first_face = np.cumsum([0, *(len(t.faces) for t in trees)])
    first_node = np.cumsum([0, *(len(t.spans) for t in trees)])
    starts = list(zip(first_face, first_vertex, first_node, strict=True))[:-1]
    vertices = np.concatenate([t.vertices for t in trees])
    faces = np.concatenate([t.faces + v for t, (_, v, _) in zip(trees, starts, strict=True)])
    spans = [
        t.spans + np.array([f, f, v, v, n]) for t, (f, v, n) in zip(trees, starts, strict=True)
    ]

    # volumes are linear in the vector areas, so what displaces in part has smaller ones; the area
    # itself stays
    moments = np.concatenate([t.moments for t in trees])
    moments[:, : tree.AREA] *= np.repeat(fills, np.diff(first_node))[:, None]
    a, b, c = vertices[faces.T]
    vectors = 0.5 * np.cross(b - a, c - a)
    shares = np.repeat(fills, np.diff(first_face))[:, None]

    return Hulls(
        vertices,
        faces,
        np.column_stack([shares * vectors, np.linalg.norm(vectors, axis=1)]),
        first_node,
        np.concatenate(spans),
        np.concatenate([t.boxes for t in trees]),
        moments,
        np.array([_whole(mesh, fill, water) for mesh, fill in zip(meshes, fills, strict=True)]),
        pressure.typical(water.rows),
        frames,
    )


def _whole(mesh: TriMesh, fill: float, water: Water) -> list[float]:
    """One row of `Hulls.whole`."""
    half = 0.5 * mesh.extents
    plan = local.plan(water.rows, float(np.linalg.norm(half)))
    middle = mesh.bounds.mean(axis=0)
    return [fill * mesh.volume, *mesh.centroid, mesh.area, *middle, *half, fill, *plan]


def _tree(mesh: TriMesh, edge: float) -> Tree:
    """The tree of a mesh with edges no longer than `edge`; once for as long as the mesh lives."""
    trees = _TREES.setdefault(mesh, {})
    if edge not in trees:
        trees[edge] = grow_tree(*refine(mesh.vertices, mesh.faces, edge))
    return trees[edge]


def longest_edge(volume: float, area: float, water: Water, tolerance: float) -> float:
    """Longest edge [m] of triangles that follow the waves well enough, for hulls of a volume and an
    area.

    A chord of length e under a curve of curvature c is off by c e^2 / 12 on average. That matters
    where the surface cuts triangles alone: no more than half the hull's surface faces up or down
    (Cauchy's mean projected area), so if all of that lay in the water's surface the volume would be
    off by less than c e^2 / 12 times half the hull's, which must stay below the tolerance of it. No
    hull is driven beyond about `MOST_TRIANGLES`.
    """
    if water.curvature == 0.0:
        return np.inf
    fine = np.sqrt(24.0 * tolerance * volume / (area * water.curvature))
    return float(max(fine, np.sqrt(4.0 * area / MOST_TRIANGLES)))


def _longest_edges(
    meshes: Sequence[TriMesh], bodies: NDArray[np.int64], water: Water, tolerance: float
) -> list[float]:
    """`longest_edge` of each mesh, from the volume and the area of all meshes of its body."""
    volumes, areas = (
        np.array([mesh.volume for mesh in meshes]),
        np.array([mesh.area for mesh in meshes]),
    )
    joint = [(volumes[bodies == body].sum(), areas[bodies == body].sum()) for body in bodies]
    return [longest_edge(volume, area, water, tolerance) for volume, area in joint]

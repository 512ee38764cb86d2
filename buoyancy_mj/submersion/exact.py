"""`Exact`: the default method, the meshes themselves, cut where the surface cuts them."""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MethodError
from buoyancy_mj.kernels import clip, local, pressure, waterplane
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.meshes.tree import Tree, build_tree
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.hull_set import HullSet

MOST_TRIANGLES = 200_000
"""Most triangles to which a mesh is refined for the waves."""
_TREES: WeakKeyDictionary[TriMesh, dict[float, Tree]] = WeakKeyDictionary()


@dataclasses.dataclass(frozen=True)
class Exact:
    """The volume and centroid under the surface, exact on the mesh: the default everywhere.

    Raises:
        MethodError: a tolerance that is not positive.
    """

    name: ClassVar[str] = "exact"
    tolerance: float = 2e-3
    """Part of the volume by which straight cuts of triangles may be off in waves, at worst.

    The worst case is a side that lies flat in the surface, see `longest_edge`. Elsewhere the error
    is of second order, a hundredth of that and less, and on still water there is none."""

    def __post_init__(self) -> None:
        if (
            isinstance(self.tolerance, bool)
            or not isinstance(self.tolerance, int | float)
            or not 0.0 < self.tolerance <= 1.0
        ):
            raise MethodError(
                f"tolerance is {self.tolerance!r}; "
                "it must be a part of the volume, above 0 and at most 1"
            )

    def pack(self, hulls: HullSet, water: Water) -> "PackedHulls":
        """Prepare hulls: refine their meshes for the waves, build their trees."""
        return PackedHulls(hulls, water, self.tolerance)


class PackedHulls:
    """Hulls in one set of arrays, ready to be submerged together without allocating.

    On still water the results are exact on the mesh. In waves they are so but for the error of
    straight cuts, see `Exact.tolerance`.
    """

    def __init__(self, hulls: HullSet, water: Water, tolerance: float = Exact.tolerance) -> None:
        """Pack hulls.

        Args:
            hulls: the hulls; errors in waves are compared with the joint volume of a body's hulls.
            water: the sea.
            tolerance: see `Exact.tolerance`.
        """
        meshes, fills = hulls.meshes, hulls.fills
        self.water = water
        self.frames = hulls.frames
        self._waves, self._typical = water.rows, pressure.typical(water.rows)
        self._whole = np.array(
            [
                [
                    *(
                        fill * m.volume,
                        *m.centroid,
                        m.area,
                        *m.bounds.mean(axis=0),
                        *(0.5 * m.extents),
                        fill,
                    ),
                    *local.plan(water.rows, 0.5 * float(np.linalg.norm(m.extents))),
                ]
                for m, fill in zip(meshes, fills, strict=True)
            ]
        )
        self.volumes = self._whole[:, 0].copy()
        """Volume that each hull displaces when it is under water (h,) [m^3]."""
        edges = _longest_edges(meshes, hulls.bodies, water, tolerance)
        trees = [_tree(mesh, edge) for mesh, edge in zip(meshes, edges, strict=True)]
        starts = np.cumsum([0, *(len(tree.vertices) for tree in trees)])
        firsts = np.cumsum([0, *(len(tree.faces) for tree in trees)])
        self._nodes = np.cumsum([0, *(len(tree.spans) for tree in trees)])
        self._vertices = np.concatenate([tree.vertices for tree in trees])
        # unsigned, since Numba asks of a signed index whether it counts from the end
        self._faces = np.concatenate(
            [t.faces + start for t, start in zip(trees, starts, strict=False)]
        ).astype(np.uint32)
        self._spans = np.concatenate(
            [
                t.spans + np.array([f, f, v, v, n])
                for t, f, v, n in zip(trees, firsts, starts, self._nodes, strict=False)
            ]
        )
        self._boxes = np.concatenate([tree.boxes for tree in trees])
        self._moments = np.concatenate([tree.moments for tree in trees])
        # volumes are linear in the vector areas, so a hull that displaces in part has smaller
        # ones; the area itself stays
        self._moments[:, :-1] *= np.repeat(fills, np.diff(self._nodes))[:, None]
        a, b, c = self._vertices[self._faces.T]
        vectors = 0.5 * np.cross(b - a, c - a)
        shares = np.repeat(fills, np.diff(firsts))[:, None]
        self._areas = np.column_stack([shares * vectors, np.linalg.norm(vectors, axis=1)])
        leaves = self._spans[:, 4] == np.arange(len(self._spans)) + 1
        most = int(np.diff(self._spans[leaves, 2:4]).max())
        self._depths, self._swell = np.empty((5, most)), np.empty((len(self._waves), 7))
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion of each hull (h, 6), see `methods.Packed.results`."""

    ARRAYS = (
        "vertices", "faces", "areas", "nodes", "spans", "boxes", "moments", "whole", "typical", "frames", "depths",
        "swell",
    )  # fmt: skip
    """What describes the hulls, and what is worked in, see `kernels.clip.submerge_hulls`."""

    @property
    def arrays(self) -> Mapping[str, NDArray[Any]]:
        """The arrays of `ARRAYS`, for compiled code to submerge the hulls without Python."""
        return {
            name: getattr(self, "frames" if name == "frames" else f"_{name}")
            for name in self.ARRAYS
        }

    @property
    def triangles(self) -> tuple[NDArray[Any], ...]:
        """What `kernels.panels` reads of the hulls."""
        return (
            self._vertices,
            self._faces,
            self._areas,
            self._nodes,
            self._spans,
            self._whole,
            self.frames,
        )

    @property
    def counts(self) -> Mapping[str, int]:
        """Nothing: the work is not counted here."""
        return {}

    def submerge(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        time: float,
        _run: int = 0,
        /,
    ) -> NDArray[np.float64]:
        """Submerge all hulls at a time [s]; return `results`, see `methods.Packed`."""
        clip.submerge_hulls(
            self._vertices,
            self._faces,
            self._areas,
            self._nodes,
            self._spans,
            self._boxes,
            self._moments,
            self._whole,
            self.frames,
            positions,
            rotations,
            self.water.level,
            self._waves,
            time,
            self._depths,
            self._swell,
            self.results,
        )
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
        rows = np.empty((len(self._whole), 6))
        pressure.press_hulls(
            self._vertices,
            self._faces,
            self._areas,
            self._nodes,
            self._spans,
            self._boxes,
            self._moments,
            self._whole,
            self._typical,
            self.frames,
            positions,
            rotations,
            self.water.level,
            self._waves,
            time,
            dynamic,
            self._depths[0],
            rows,
        )
        return rows

    def waterplanes(
        self,
        positions: NDArray[np.float64],
        rotations: NDArray[np.float64],
        about: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Waterplanes of all hulls on the still level about a point (3,) [m].

        Returns:
            Rows (h, 10), see `kernels.waterplane.waterplanes`.
        """
        rows = np.empty((len(self._whole), waterplane.COLUMNS))
        waterplane.waterplanes(
            self._vertices,
            self._faces,
            self._nodes,
            self._spans,
            self._boxes,
            self._whole,
            self.frames,
            positions,
            rotations,
            about,
            self.water.level,
            self._depths[0],
            rows,
        )
        return rows


def _tree(mesh: TriMesh, edge: float) -> Tree:
    """The tree of a mesh with edges no longer than `edge` [m], built once while the mesh lives."""
    trees = _TREES.setdefault(mesh, {})
    if edge not in trees:
        trees[edge] = build_tree(*refine(mesh.vertices, mesh.faces, edge))
    return trees[edge]


def longest_edge(volume: float, area: float, water: Water, tolerance: float) -> float:
    """Longest edge [m] of triangles that follow the waves well enough.

    A chord of length e under a curve of curvature c is off by c e^2 / 12 on average. That matters
    only where the surface cuts triangles. No more than half the hull's area faces up or down
    (Cauchy's mean projected area). If all of that lay in the water's surface, the volume would be
    off by less than c e^2 / 12 times half the area, which must stay below the tolerance times the
    volume. No hull is refined beyond about `MOST_TRIANGLES`.

    Args:
        volume: volume of the body's hulls [m^3].
        area: surface area of the body's hulls [m^2].
        water: the sea.
        tolerance: see `Exact.tolerance`.
    """
    if water.curvature == 0.0:
        return math.inf
    fine = np.sqrt(24.0 * tolerance * volume / (area * water.curvature))
    return float(max(fine, np.sqrt(4.0 * area / MOST_TRIANGLES)))


def _longest_edges(
    meshes: Sequence[TriMesh], bodies: NDArray[np.int64], water: Water, tolerance: float
) -> list[float]:
    """`longest_edge` of each mesh, from the volume and the area of all meshes of its body."""
    volumes = np.array([mesh.volume for mesh in meshes])
    areas = np.array([mesh.area for mesh in meshes])
    together = [bodies == body for body in bodies]
    return [
        longest_edge(volumes[which].sum(), areas[which].sum(), water, tolerance)
        for which in together
    ]

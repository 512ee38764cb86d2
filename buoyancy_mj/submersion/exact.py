"""`Exact`: the default method, the meshes themselves, cut where the surface cuts them."""

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MethodError, describe
from buoyancy_mj.kernels import clip, pressure, rules, tree, waterplane
from buoyancy_mj.kernels.arrays import conform
from buoyancy_mj.kernels.hulls import WHOLE_VOLUME, Hulls
from buoyancy_mj.kernels.multibody import Geoms
from buoyancy_mj.kernels.scratch import Scratch, new_scratches
from buoyancy_mj.kernels.sea import PressureModel, Sea
from buoyancy_mj.meshes import tree as meshes_tree
from buoyancy_mj.meshes.cache import Form, recall
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.refinement import refine
from buoyancy_mj.meshes.tree import Tree, build_tree, find_rules
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.hull_set import HullSet
from buoyancy_mj.submersion.sea_tiles import lay_blocks, lay_tiles
from buoyancy_mj.submersion.wave_limits import check_waves, find_longest_edges
from buoyancy_mj.values import set_number

FINEST = 1e-8
"""Least tolerance; sums over that many triangles round off about so much."""
_TREES = Form("tree", Tree._asdict, lambda arrays: Tree(**arrays))
_RULES = Form("rules", lambda rules: {"rules": rules}, lambda arrays: arrays["rules"])


@dataclasses.dataclass(frozen=True)
class Exact:
    """The volume and centroid under the surface, exact on the mesh: the default everywhere.

    Raises:
        MethodError: a tolerance that is not between `FINEST` and 1.
    """

    name: ClassVar[str] = "exact"
    """What scenes and the command line call the method."""
    tolerance: float = 2e-3
    """Part of the volume by which straight cuts of triangles may be off in waves, at worst.

    The worst case is a side that lies flat in the surface, see `wave_limits`. Elsewhere the error
    is of second order, a hundredth of that and less, and on still water there is none."""

    def __post_init__(self) -> None:
        try:
            set_number(self, MethodError, "tolerance", least=FINEST, most=1.0)
        except MethodError:
            raise MethodError(
                f"tolerance is {describe(self.tolerance)}; "
                f"it must be a part of the volume, at least {FINEST:g} and at most 1"
            ) from None

    def pack(self, hulls: HullSet, water: Water) -> "PackedHulls":
        """Prepare hulls: refine their meshes for the waves, build their trees.

        Raises:
            WaterError: waves that are too short for so long a hull, or too many.
        """
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

        Raises:
            WaterError: waves that are too short for so long a hull, or too many.
        """
        meshes, fills = hulls.meshes, hulls.fills
        self._sea, waves = sea_arrays(water), water.rows
        check_waves(max(0.5 * float(np.linalg.norm(m.extents)) for m in meshes), waves)
        edges, allowed = find_longest_edges(meshes, hulls.bodies, water, tolerance)
        parts = list(zip(meshes, edges, strict=True))
        trees = [_tree(*each) for each in parts]
        self._distinct = [(*parts[h], float(fills[h])) for h in _tell_apart(trees, fills)[0]]
        self.hulls: Hulls = conform(_hulls(meshes, trees, fills, hulls.frames, waves, allowed))
        """The hulls as kernels read them."""
        spans = self.hulls.spans
        leaves = spans[spans[:, tree.BEHIND] == np.arange(len(spans)) + 1]
        faces = leaves[:, tree.END_FACE] - leaves[:, tree.FIRST_FACE]
        vertices = leaves[:, tree.END_VERTEX] - leaves[:, tree.FIRST_VERTEX]
        self._most = int(max(faces.max(), vertices.max()))
        (self.scratch,) = self.new_scratches(1)
        """Where `submerge` and `press` work."""
        self.volumes = self.hulls.whole[:, WHOLE_VOLUME].copy()
        """Volume that the whole meshes displace (h,) [m^3]."""
        self.results = np.zeros((len(meshes), clip.COLUMNS))
        """Last submersion of each hull (h, 8), see `methods.Packed.results`."""

    def find_rules(self) -> None:
        """Find by which rules pressures are summed over the nodes of `hulls`, if not known yet."""
        if not len(self.hulls.rules):
            found = [fill * _rules(mesh, edge) for mesh, edge, fill in self._distinct]
            self.hulls = self.hulls._replace(rules=np.concatenate(found))

    def new_scratches(self, count: int) -> list[Scratch]:
        """Arrays for kernels to work in, for so many threads."""
        return new_scratches(count, self._most, self._sea.waves.shape[1])

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
        geoms = Geoms(positions, rotations)
        sea, scratch = self._sea, self.scratch.cut
        clip.submerge_hulls(
            self.hulls, geoms, sea.level, time, scratch, self.results, 0, len(self.results)
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
        self.find_rules()
        rows = np.empty((len(self.volumes), 6))
        model = PressureModel.froude_krylov if dynamic else PressureModel.hydrostatic
        pressure.press_hulls(
            self.hulls,
            Geoms(positions, rotations),
            self._sea._replace(pressure=int(model)),
            time,
            self.scratch,
            rows,
            0,
            len(rows),
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
        rows = np.empty((len(self.volumes), waterplane.COLUMNS))
        waterplane.waterplanes(
            self.hulls,
            Geoms(positions, rotations),
            about,
            self._sea.level,
            self.scratch.cut.seen[0],
            rows,
        )
        return rows


def sea_arrays(water: Water, pressure_model: PressureModel = PressureModel.archimedes) -> Sea:
    """A sea as kernels read it."""
    return conform(
        Sea(water.table, water.current_rows, water.density, water.level, int(pressure_model))
    )


def _hulls(
    meshes: Sequence[TriMesh],
    trees: Sequence[Tree],
    fills: NDArray[np.float64],
    frames: NDArray[np.int64],
    waves: NDArray[np.float64],
    allowed: Sequence[float],
) -> Hulls:
    """Meshes and their trees, joined, for waves (w, 7); see `PackedHulls` for the arguments.

    Straight edges that lie in the surface may be off by so much [m], as is allowed for each hull.
    """
    kept, places = _tell_apart(trees, fills)
    trees, parts = [trees[h] for h in kept], fills[kept]

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
    moments[:, : tree.AREA] *= np.repeat(parts, np.diff(first_node))[:, None]
    vectors = np.concatenate([t.vectors for t in trees])
    shares = np.repeat(parts, np.diff(first_face))[:, None]

    radii = [0.5 * float(np.linalg.norm(mesh.extents)) for mesh in meshes]
    return Hulls(
        vertices,
        faces,
        shares * vectors,
        np.linalg.norm(vectors, axis=1),
        first_node[places],
        np.concatenate(spans),
        np.concatenate([t.boxes for t in trees]),
        moments,
        np.zeros((0, 3 * rules.POINTS)),
        np.concatenate([_measure_leaves(t) for t in trees]),
        np.array([_whole(*each) for each in zip(meshes, fills, allowed, strict=True)]),
        pressure.typical(waves),
        lay_tiles(waves, radii),
        lay_blocks(waves, radii),
        frames,
    )


def _tell_apart(trees: Sequence[Tree], fills: NDArray[np.float64]) -> tuple[list[int], list[int]]:
    """The first hull of each tree that displaces in one part, and which of these each hull is."""
    keys = [(id(tree), fill) for tree, fill in zip(trees, fills, strict=True)]
    first_of = {key: h for h, key in reversed(list(enumerate(keys)))}
    kept = sorted(first_of.values())
    place_of = {keys[h]: place for place, h in enumerate(kept)}
    return kept, [place_of[key] for key in keys]


def _whole(mesh: TriMesh, fill: float, allowed: float) -> list[float]:
    """One row of `Hulls.whole`."""
    half, middle = 0.5 * mesh.extents, mesh.bounds.mean(axis=0)
    return [fill * mesh.volume, *mesh.centroid, mesh.area, *middle, *half, fill, allowed]


def _measure_leaves(of: Tree) -> NDArray[np.float64]:
    """The longest edge of the faces of each leaf (n,), 0 for other nodes [m]."""
    corners = of.vertices[of.faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    leaves = of.spans[:, tree.BEHIND] == np.arange(len(of.spans)) + 1
    edges = np.zeros(len(of.spans))
    edges[leaves] = np.maximum.reduceat(longest, of.spans[leaves, tree.FIRST_FACE])
    return edges


def _tree(mesh: TriMesh, edge: float) -> Tree:
    """The tree of a mesh with edges no longer than `edge` [m], built once for each."""
    return recall(
        _TREES, _parts(mesh, edge), lambda: build_tree(*refine(mesh.vertices, mesh.faces, edge))
    )


def _rules(mesh: TriMesh, edge: float) -> NDArray[np.float64]:
    """The rules of its nodes."""
    return recall(_RULES, _parts(mesh, edge), lambda: find_rules(_tree(mesh, edge)))


def _parts(mesh: TriMesh, edge: float) -> tuple[object, ...]:
    """What a tree depends on."""
    if math.isfinite(edge) and edge >= mesh.longest_edge:
        edge = math.inf
    return mesh.checksum, edge, meshes_tree.FEW, meshes_tree.LEAF

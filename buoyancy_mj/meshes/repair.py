"""Meshes as people have them, made into hulls: what can be mended safely is, the rest is named."""

import dataclasses

import manifold3d
import numpy as np
import scipy.spatial
import trimesh
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.kernels.rays import misenclosed
from buoyancy_mj.meshes.mesh import TriMesh, check_arrays, open_edges, to_manifold, winding

IN_DOUBT = 0.01
"""Fraction of a mesh's volume that may be in doubt before it is refused."""
WORTH_TELLING = 1e-3
"""Fraction of a mesh's volume enclosed wrongly that is worth a notice; below it is the rays' own error."""
SMALLEST, SUSPICIOUS, LARGEST = 1e-4, 50.0, 1e3
"""Longest side [m] of anything that could float; what is longer than the middle one was often drawn in millimetres."""
RAYS = 160
"""Rays along each side of the grid that looks for space enclosed twice."""


@dataclasses.dataclass(frozen=True)
class Hole:
    """A loop of edges that bounds the surface, and what closing it puts in doubt."""

    edges: int
    """Number of edges of the loop."""
    length: float
    """Of the loop [m]."""
    doubt: float
    """Volume of a dome over it [m^3]."""


@dataclasses.dataclass(eq=False)
class Diagnosis:
    """What was found of a mesh, and what was made of it."""

    name: str
    """What messages call the mesh."""
    triangles: int = 0
    """As it came."""
    extents: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Sides of its bounding box [m]."""
    volume_as_is: float = 0.0
    """That its faces enclose as they came [m^3]; about the mean vertex, where it is open."""
    degenerate: int = 0
    """Triangles without area, which went."""
    duplicates: int = 0
    """Triangles that stood there twice, which went."""
    backwards: int = 0
    """Triangles wound backwards, which were turned."""
    holes: tuple[Hole, ...] = ()
    """What was open."""
    inverted: str = ""
    """What was inside out and was turned; '' if nothing."""
    pieces: int = 0
    """Closed surfaces that do not touch."""
    shells: int = 0
    """Pieces inside others that bound sealed cavities."""
    sealed: float = 0.0
    """Volume of those cavities [m^3], which displace like solid."""
    joined: float = 0.0
    """Volume that pieces of it enclosed together and counted twice [m^3], until they were joined."""
    doubled: float = 0.0
    """Volume that it encloses more than once [m^3], by rays."""
    inside_out: float = 0.0
    """Volume that it encloses inside out [m^3], by rays."""
    notices: list[str] = dataclasses.field(default_factory=list)
    """A sentence for each thing that was mended or is in doubt."""
    refusal: str = ""
    """Why it is no hull, and the mend; '' if it is one."""
    mesh: TriMesh | None = None
    """The hull; None if it was refused."""

    @property
    def repaired(self) -> bool:
        """Whether it came otherwise than it is now."""
        return bool(
            self.degenerate
            or self.duplicates
            or self.backwards
            or self.holes
            or self.inverted
            or self.shells
            or self.joined
        )

    @property
    def doubt(self) -> float:
        """Volume that its holes put in doubt [m^3]."""
        return sum(hole.doubt for hole in self.holes)


def repair(vertices: ArrayLike, faces: ArrayLike, name: str = "mesh") -> tuple[TriMesh, list[str]]:
    """A hull from vertices (n, 3) [m] and faces (m, 3), and a sentence for each thing that was mended.

    Vertices at one place become one, faces without area go, faces are wound alike and outward, small
    holes get a lid, and pieces that overlap are joined by boolean union; the volume a hole puts in
    doubt is that of a dome over it.

    Raises:
        MeshError: empty, flat, absurdly scaled, open by more than 1 % of the volume, or crossing
            itself by as much; the message names `name` and the mend.
    """
    found = diagnose(vertices, faces, name)
    if found.mesh is None:
        raise MeshError(found.refusal)
    return found.mesh, found.notices


def diagnose(vertices: ArrayLike, faces: ArrayLike, name: str = "mesh") -> Diagnosis:
    """What is wrong with a mesh, mended as far as that is safe; see `repair`."""
    found = Diagnosis(name)
    try:
        found.mesh = _treated(found, vertices, faces)
    except MeshError as error:
        found.refusal = f"{name}: {error}"
    found.notices = [f"{name}: {notice}" for notice in found.notices]
    return found


def _treated(found: Diagnosis, vertices: ArrayLike, faces: ArrayLike) -> TriMesh:
    """The hull; each step leaves its finding."""
    v, f = check_arrays(vertices, faces)
    used = v[np.unique(f)]
    found.triangles, found.volume_as_is = len(f), _volume(v, f)
    found.extents = tuple(np.ptp(used, axis=0).tolist())
    _check_scale(found)
    v, f, found.degenerate, found.duplicates = _merged(v, f)
    if not len(f):
        raise MeshError(f"all {found.triangles} triangles are degenerate; export the mesh again")
    if len(open_edges(f)):
        mesh = trimesh.Trimesh(v, f, process=False)
        trimesh.repair.fix_winding(mesh)
        wound = np.asarray(mesh.faces, np.int64)
        if len(open_edges(wound)) < len(open_edges(f)):
            found.backwards = int((wound != f).any(axis=1).sum())
            found.notices.append(
                f"{found.backwards} triangles were wound backwards and were turned"
            )
            f = wound
    if len(open_edges(f)):
        v, f, found.holes = _closed(v, f)
    pieces = _outward(found, v, f)
    f = np.vstack(pieces)
    volume = _volume(v, f)
    if volume <= 1e-9 * float(np.prod(np.maximum(np.ptp(v, axis=0), 1e-300))):
        raise MeshError(
            "it is flat and encloses no volume; give it thickness, or leave the geom out"
        )
    if found.holes:
        edges = sum(hole.edges for hole in found.holes)
        told = (
            f"{len(found.holes)} hole(s) with {edges} edges put {found.doubt:.3g} m^3 ({found.doubt / volume:.2%} of its "
            "volume) in doubt"
        )
        if found.doubt > IN_DOUBT * volume:
            raise MeshError(
                f"it is open: {told}; close the mesh, take its convex hull (--hull convex), or leave the geom out (--geoms)"
            )
        found.notices.append(f"{told}; they were closed")
    found.doubled, found.inside_out = misenclosed(v, f, RAYS)
    if found.doubled > WORTH_TELLING * volume and len(pieces) > 1:
        v, f = _united(found, v, pieces)
        volume = _volume(v, f)
    crossing = found.doubled + found.inside_out
    if crossing > IN_DOUBT * volume:
        raise MeshError(
            f"it crosses itself: about {found.doubled:.3g} m^3 is enclosed twice and {found.inside_out:.3g} m^3 inside out, "
            f"of {volume:.3g} m^3; join its parts by a boolean union, or take its convex hull (--hull convex)"
        )
    if crossing > WORTH_TELLING * volume:
        found.notices.append(
            f"it crosses itself; about {crossing / volume:.2%} of its volume is in doubt"
        )
    return TriMesh(v, f)


def wrap_convex(vertices: NDArray[np.float64], name: str = "mesh") -> TriMesh:
    """The convex hull of vertices (n, 3) [m]: a stated approximation, for meshes that bound no volume.

    Raises:
        MeshError: they lie in a plane.
    """
    try:
        solid = trimesh.convex.convex_hull(vertices)
    except scipy.spatial.QhullError as error:
        raise MeshError(
            f"{name}: it is flat and has no convex hull; give it thickness, or leave the geom out"
        ) from error
    return TriMesh(np.asarray(solid.vertices), np.asarray(solid.faces))


def _check_scale(found: Diagnosis) -> None:
    """Refuse what no unit of length explains, and tell what looks like millimetres."""
    longest = max(found.extents)
    if SUSPICIOUS < longest <= LARGEST:
        found.notices.append(
            f"it is {longest:.3g} m long; if it was drawn in millimetres, set scale='0.001 0.001 0.001'"
        )
    elif not SMALLEST <= longest <= LARGEST:
        raise MeshError(
            f"its longest side is {longest:.3g} m, possible are {SMALLEST:g} to {LARGEST:g} m; "
            "scale the mesh (a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )


def _merged(
    v: NDArray[np.float64], f: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], int, int]:
    """One vertex at each place; no triangle that has lost a corner, none that stands there twice, and how many did."""
    places = np.round((v - v.min(axis=0)) / (1e-7 * np.ptp(v, axis=0).max()))
    _, first, inverse = np.unique(places, axis=0, return_index=True, return_inverse=True)
    f = inverse.ravel()[f]
    proper = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
    if not len(proper):
        return v[first], proper, len(f), 0
    # turned so that the smallest index leads, a repeated triangle is a repeated row
    lead = proper.argmin(axis=1)[:, None]
    turned = np.take_along_axis(proper, (lead + np.arange(3)) % 3, axis=1)
    _, keep = np.unique(turned, axis=0, return_index=True)
    return v[first], proper[np.sort(keep)], len(f) - len(proper), len(proper) - len(keep)


def _closed(
    v: NDArray[np.float64], f: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], tuple[Hole, ...]]:
    """Lids over all holes, fans about their middles."""
    # the boundary as loops, each step a directed edge that is used once
    onward: dict[int, list[int]] = {}
    for a, b in open_edges(f).tolist():
        onward.setdefault(a, []).append(b)
    holes: list[Hole] = []
    lids, middles = [f], [v]
    count = len(v)
    while onward:
        start = next(iter(onward))
        loop = [start]
        while True:
            nexts = onward.get(loop[-1])
            if not nexts:
                raise MeshError(
                    "it is open and its boundary forms no loops; export it as one closed solid"
                )
            step = nexts.pop()
            if not nexts:
                del onward[loop[-1]]
            if step == start:
                break
            loop.append(step)
        ring = v[loop]
        middle = ring.mean(axis=0)
        # the lid runs against the boundary, so that every open edge meets its reverse
        following = np.roll(ring, -1, axis=0)
        lids.append(np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), count)]))
        middles.append(middle[None])
        count += 1
        area = float(np.linalg.norm(0.5 * np.cross(ring - middle, following - middle).sum(axis=0)))
        length = float(np.linalg.norm(following - ring, axis=1).sum())
        holes.append(Hole(len(loop), length, 2.0 / 3.0 * area * np.sqrt(area / np.pi)))
    return np.vstack(middles), np.vstack(lids), tuple(holes)


def _outward(
    found: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]
) -> list[NDArray[np.int64]]:
    """Faces of every piece turned outward, without the walls of sealed cavities."""
    if _volume(v, f) < 0.0:
        f, found.inverted = f[:, ::-1].copy(), "it"
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    labels = trimesh.graph.connected_component_labels(edges, len(v))[f[:, 0]]
    order = np.argsort(labels, kind="stable")
    pieces = np.split(f[order], np.flatnonzero(np.diff(labels[order])) + 1)
    found.pieces = len(pieces)
    inward = [_volume(v, piece) < 0.0 for piece in pieces]
    solid = [piece for piece, hollow in zip(pieces, inward, strict=True) if not hollow]
    turned = 0
    for piece, hollow in zip(pieces, inward, strict=True):
        if not hollow:
            continue
        # an inward piece inside a solid one bounds a cavity, anywhere else it is a mistake
        if any(winding(v, other, v[piece[0, 0]]) > 0.5 for other in solid):
            found.sealed -= _volume(v, piece)
            found.shells += 1
        else:
            solid.append(piece[:, ::-1])
            turned += 1
    if turned and not found.inverted:
        found.inverted = f"{turned} of its {len(pieces)} pieces"
    if found.inverted:
        found.notices.append(f"{found.inverted} was inside out; its faces were turned outward")
    if found.sealed:
        found.notices.append(
            f"water cannot reach the {found.sealed:.3g} m^3 sealed inside it, which displace like solid"
        )
    return solid


def _united(
    found: Diagnosis, v: NDArray[np.float64], pieces: list[NDArray[np.int64]]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Pieces that overlap as one, unless one of them is no manifold."""
    solids = [to_manifold(*_compact(v, piece)) for piece in pieces]
    manifolds = [solid for solid in solids if solid is not None]
    before = _volume(v, np.vstack(pieces))
    if len(manifolds) == len(pieces):
        whole = manifold3d.Manifold.batch_boolean(manifolds, manifold3d.OpType.Add).to_mesh64()
        vertices = np.asarray(whole.vert_properties)[:, :3].copy()
        faces = np.asarray(whole.tri_verts).astype(np.int64)
        left = misenclosed(vertices, faces, RAYS)
        if sum(left) < found.doubled + found.inside_out:
            found.doubled, found.inside_out = left
            found.joined = before - _volume(vertices, faces)
            found.notices.append(
                f"its {len(pieces)} pieces overlap; they were joined, and {found.joined:.3g} m^3 no longer count twice"
            )
            return vertices, faces
    return v, np.vstack(pieces)


def _compact(
    v: NDArray[np.float64], f: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Vertices that faces use, and the faces in their indices."""
    used, faces = np.unique(f, return_inverse=True)
    return np.ascontiguousarray(v[used]), faces.reshape(-1, 3)


def _volume(v: NDArray[np.float64], f: NDArray[np.int64]) -> float:
    """Signed volume [m^3], open or not, about the mean vertex."""
    a, b, c = (v - v.mean(axis=0))[f.T]
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

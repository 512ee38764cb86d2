"""Meshes as people have them, made into hulls: what can be mended safely is, the rest is named."""

import numpy as np
import scipy.spatial
import trimesh
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.kernels.rays import misenclosed
from buoyancy_mj.mesh import TriMesh, checked_arrays, open_edges, winding

IN_DOUBT = 0.01
"""Fraction of a mesh's volume that may be in doubt before it is refused."""
WORTH_TELLING = 1e-3
"""Fraction of a mesh's volume enclosed wrongly that is worth a notice; below it is the rays' own error."""
SMALLEST, SUSPICIOUS, LARGEST = 1e-4, 50.0, 1e3
"""Longest side [m] of anything that could float; what is longer than the middle one was often drawn in millimetres."""
RAYS = 160
"""Rays along each side of the grid that looks for space enclosed twice."""


def mended(vertices: ArrayLike, faces: ArrayLike, name: str = "mesh") -> tuple[TriMesh, list[str]]:
    """A hull from vertices (n, 3) [m] and faces (m, 3), and a sentence for each thing that was mended.

    Vertices at one place become one, faces without area go, faces are wound alike and outward, and
    small holes get a lid; the volume a hole puts in doubt is that of a dome over it.

    Raises:
        MeshError: empty, flat, absurdly scaled, open by more than 1 % of the volume, or crossing
            itself by as much; the message names `name` and the mend.
    """
    notices: list[str] = []
    try:
        v, f = checked_arrays(vertices, faces)
    except MeshError as error:
        raise MeshError(f"{name}: {error}") from None
    notices += _check_scale(v[np.unique(f)], name)
    v, f = _merged(v, f)
    if not len(f):
        raise MeshError(f"{name}: all {len(np.asarray(faces))} triangles are degenerate; export the mesh again")
    if len(open_edges(f)):
        mesh = trimesh.Trimesh(v, f, process=False)
        trimesh.repair.fix_winding(mesh)
        wound = np.asarray(mesh.faces, np.int64)
        if len(open_edges(wound)) < len(open_edges(f)):
            notices.append(f"{name}: {int((wound != f).any(axis=1).sum())} triangles were wound backwards and were turned")
            f = wound
    lids: list[tuple[int, float]] = []
    if len(open_edges(f)):
        v, f, lids = _closed(v, f, name)
    f, inverted, sealed = _outward(v, f)
    if inverted:
        notices.append(f"{name}: {inverted} was inside out; its faces were turned outward")
    if sealed:
        notices.append(f"{name}: water cannot reach the {sealed:.3g} m^3 sealed inside it, which displace like solid")
    volume = _volume(v, f)
    if volume <= 1e-9 * float(np.prod(np.maximum(np.ptp(v, axis=0), 1e-300))):
        raise MeshError(f"{name}: it is flat and encloses no volume; give it thickness, or leave the geom out")
    if lids:
        doubt = sum(dome for _, dome in lids)
        edges = sum(count for count, _ in lids)
        told = f"{len(lids)} hole(s) with {edges} edges put {doubt:.3g} m^3 ({doubt / volume:.2%} of its volume) in doubt"
        if doubt > IN_DOUBT * volume:
            raise MeshError(f"{name}: it is open: {told}; close the mesh, or leave the geom out (--geoms)")
        notices.append(f"{name}: {told}; they were closed")
    doubled, inside_out = misenclosed(v, f, RAYS)
    if doubled + inside_out > IN_DOUBT * volume:
        raise MeshError(
            f"{name}: it crosses itself: about {doubled:.3g} m^3 is enclosed twice and {inside_out:.3g} m^3 inside out, "
            f"of {volume:.3g} m^3; join its pieces by a boolean union"
        )
    if doubled + inside_out > WORTH_TELLING * volume:
        notices.append(f"{name}: it crosses itself; about {(doubled + inside_out) / volume:.2%} of its volume is in doubt")
    return TriMesh(v, f), notices


def convex_of(vertices: NDArray[np.float64], name: str = "mesh") -> TriMesh:
    """The convex hull of vertices (n, 3) [m]: a stated approximation, for meshes that bound no volume.

    Raises:
        MeshError: they lie in a plane.
    """
    try:
        solid = trimesh.convex.convex_hull(vertices)
    except scipy.spatial.QhullError as error:
        raise MeshError(f"{name}: it is flat and has no convex hull; give it thickness, or leave the geom out") from error
    return TriMesh(np.asarray(solid.vertices), np.asarray(solid.faces))


def _check_scale(v: NDArray[np.float64], name: str) -> list[str]:
    """Refuse what no unit of length explains, and tell what looks like millimetres."""
    longest = float(np.ptp(v, axis=0).max())
    if SUSPICIOUS < longest <= LARGEST:
        return [f"{name}: it is {longest:.3g} m long; if it was drawn in millimetres, set scale='0.001 0.001 0.001'"]
    if not SMALLEST <= longest <= LARGEST:
        raise MeshError(
            f"{name}: its longest side is {longest:.3g} m, possible are {SMALLEST:g} to {LARGEST:g} m; "
            "scale the mesh (a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )
    return []


def _merged(v: NDArray[np.float64], f: NDArray[np.int64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """One vertex at each place, no triangle that has lost a corner, none that stands there twice."""
    places = np.round((v - v.min(axis=0)) / (1e-7 * np.ptp(v, axis=0).max()))
    _, first, inverse = np.unique(places, axis=0, return_index=True, return_inverse=True)
    f = inverse.ravel()[f]
    f = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
    # turned so that the smallest index leads, a repeated triangle is a repeated row
    lead = f.argmin(axis=1)[:, None]
    turned = np.take_along_axis(f, (lead + np.arange(3)) % 3, axis=1)
    _, keep = np.unique(turned, axis=0, return_index=True)
    return v[first], f[np.sort(keep)]


def _closed(
    v: NDArray[np.float64], f: NDArray[np.int64], name: str
) -> tuple[NDArray[np.float64], NDArray[np.int64], list[tuple[int, float]]]:
    """Lids over all holes, fans about their middles; with the edge count and dome volume [m^3] of each."""
    # the boundary as loops, each step a directed edge that is used once
    onward: dict[int, list[int]] = {}
    for a, b in open_edges(f).tolist():
        onward.setdefault(a, []).append(b)
    lids: list[tuple[int, float]] = []
    while onward:
        start = next(iter(onward))
        loop = [start]
        while True:
            nexts = onward.get(loop[-1])
            if not nexts:
                raise MeshError(f"{name}: it is open and its boundary forms no loops; export it as one closed solid")
            step = nexts.pop()
            if not nexts:
                del onward[loop[-1]]
            if step == start:
                break
            loop.append(step)
        ring = v[loop]
        middle = ring.mean(axis=0)
        # the lid runs against the boundary, so that every open edge meets its reverse
        following = loop[1:] + loop[:1]
        fan = np.array([[b, a, len(v)] for a, b in zip(loop, following, strict=True)], np.int64)
        v, f = np.vstack([v, middle]), np.vstack([f, fan])
        area = float(np.linalg.norm(0.5 * np.cross(ring - middle, np.roll(ring, -1, axis=0) - middle).sum(axis=0)))
        lids.append((len(loop), 2.0 / 3.0 * area * np.sqrt(area / np.pi)))
    return v, f, lids


def _outward(v: NDArray[np.float64], f: NDArray[np.int64]) -> tuple[NDArray[np.int64], str, float]:
    """Faces of every piece turned outward, without the walls of sealed cavities.

    Returns:
        The faces, what was inside out ('' if nothing), and the volume of the cavities [m^3].
    """
    if _volume(v, f) < 0.0:
        f, told = f[:, ::-1].copy(), "it"
    else:
        f, told = f.copy(), ""
    edges = np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]])
    labels = trimesh.graph.connected_component_labels(edges, len(v))[f[:, 0]]
    pieces = [f[labels == label] for label in np.unique(labels)]
    inward = [_volume(v, piece) < 0.0 for piece in pieces]
    solid = [piece for piece, hollow in zip(pieces, inward, strict=True) if not hollow]
    turned, sealed = 0, 0.0
    for piece, hollow in zip(pieces, inward, strict=True):
        if not hollow:
            continue
        # an inward piece inside a solid one bounds a cavity, anywhere else it is a mistake
        if any(winding(v, other, v[piece[0, 0]]) > 0.5 for other in solid):
            sealed -= _volume(v, piece)
        else:
            solid.append(piece[:, ::-1])
            turned += 1
    return np.vstack(solid), told or (f"{turned} of its {len(pieces)} pieces" if turned else ""), sealed


def _volume(v: NDArray[np.float64], f: NDArray[np.int64]) -> float:
    """Signed volume [m^3], open or not, about the mean vertex."""
    a, b, c = (v - v.mean(axis=0))[f.T]
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)

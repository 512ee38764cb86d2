"""Cleaning: one vertex at each place, no useless triangle, closed seams, all wound alike."""

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.components import label_components
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.surface import Surface, boundary_edges, compact, directed_edges

MERGED = 1e-7
"""Distance below which vertices become one, over the longest side of the bounding box."""

SEAMS = 1e-7, 1e-6, 1e-5
"""Distances, over the same side, below which vertices of open edges become one, the first first.

Coordinates in single precision are rounded by 6e-8 of themselves, and by more of a mesh that was
drawn far from its origin."""


def merge_vertices(report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]) -> Surface:
    """Merge vertices at the same place; drop triangles that lose a corner or are repeated.

    Raises:
        MeshError: no triangle remains.
    """
    # one vertex at each place
    places = np.round((v - v.min(axis=0)) / (MERGED * np.ptp(v, axis=0).max()))
    _, first, inverse = np.unique(places, axis=0, return_index=True, return_inverse=True)
    f = inverse.ravel()[f]

    # triangles with three corners
    proper = _drop_degenerate(f)
    report.degenerate = len(f) - len(proper)
    if not len(proper):
        raise MeshError(f"all {report.triangles} triangles are degenerate; export the mesh again")

    # turned so that the smallest index leads, a repeated triangle is a repeated row
    lead = proper.argmin(axis=1)[:, None]
    turned = np.take_along_axis(proper, (lead + np.arange(3)) % 3, axis=1)
    _, keep = np.unique(turned, axis=0, return_index=True)
    report.duplicates = len(proper) - len(keep)
    return v[first], proper[np.sort(keep)]


def close_seams(report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]) -> Surface:
    """Merge vertices of open edges that rounding has set apart, where that closes edges.

    Faces that an exporter wrote one by one may differ in the last digit where they meet.
    """
    longest = float(np.ptp(v, axis=0).max())
    for distance in SEAMS:
        open_edges = _find_open_edges(f)
        if not len(open_edges):
            break

        # vertices that lie together become the first of them
        rim = np.unique(open_edges)
        pairs = scipy.spatial.KDTree(v[rim]).query_pairs(distance * longest, output_type="ndarray")
        labels = label_components(pairs, len(rim))
        _, first, group = np.unique(labels, return_index=True, return_inverse=True)
        renumbered = np.arange(len(v))
        renumbered[rim] = rim[first[group]]
        merged = _drop_degenerate(renumbered[f])
        if len(merged) and len(_find_open_edges(merged)) < len(open_edges):
            report.stitched += len(rim) - len(first)
            f = merged
    if not report.stitched:
        return v, f
    report.notices.append(
        f"{report.stitched} vertices of its seams, which lay up to {SEAMS[-1]:g} of its length "
        "apart, were joined"
    )
    return compact(v, f)


def wind_alike(
    report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Turn triangles that run against their neighbours, where that closes edges."""
    before = len(boundary_edges(f))
    if not before:
        return f

    import trimesh

    mesh = trimesh.Trimesh(v, f, process=False)
    trimesh.repair.fix_winding(mesh)
    wound = np.asarray(mesh.faces, np.int64)
    if len(boundary_edges(wound)) >= before:
        return f
    report.backwards = int((wound != f).any(axis=1).sum())
    report.notices.append(f"{report.backwards} triangles were wound backwards and were turned")
    return wound


def _drop_degenerate(f: NDArray[np.int64]) -> NDArray[np.int64]:
    """Triangles (m, 3) with three corners."""
    proper = (f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])
    return np.asarray(f[proper], np.int64)


def _find_open_edges(f: NDArray[np.int64]) -> NDArray[np.int64]:
    """Edges (k, 2) that one triangle has alone, in whatever direction it runs."""
    edges, count = np.unique(np.sort(directed_edges(f), axis=1), axis=0, return_counts=True)
    return np.asarray(edges[count == 1], np.int64)

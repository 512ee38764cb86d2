"""Cleaning: one vertex at each place, no useless triangle, all wound alike."""

import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.surface import Surface, boundary_edges

MERGED = 1e-7
"""Distance below which vertices become one, over the longest side of the bounding box."""


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
    proper = f[(f[:, 0] != f[:, 1]) & (f[:, 1] != f[:, 2]) & (f[:, 2] != f[:, 0])]
    report.degenerate = len(f) - len(proper)
    if not len(proper):
        raise MeshError(f"all {report.triangles} triangles are degenerate; export the mesh again")

    # turned so that the smallest index leads, a repeated triangle is a repeated row
    lead = proper.argmin(axis=1)[:, None]
    turned = np.take_along_axis(proper, (lead + np.arange(3)) % 3, axis=1)
    _, keep = np.unique(turned, axis=0, return_index=True)
    report.duplicates = len(proper) - len(keep)
    return v[first], proper[np.sort(keep)]


def wind_alike(
    report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]
) -> NDArray[np.int64]:
    """Turn triangles that run against their neighbours, where that closes edges."""
    before = len(boundary_edges(f))
    if not before:
        return f
    mesh = trimesh.Trimesh(v, f, process=False)
    trimesh.repair.fix_winding(mesh)
    wound = np.asarray(mesh.faces, np.int64)
    if len(boundary_edges(wound)) >= before:
        return f
    report.backwards = int((wound != f).any(axis=1).sum())
    report.notices.append(f"{report.backwards} triangles were wound backwards and were turned")
    return wound

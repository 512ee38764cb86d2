"""Holes: the loops of edges that bound an open surface, and lids over them."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError
from buoyancy_mj.meshes.diagnosis import Diagnosis, Hole
from buoyancy_mj.meshes.surface import Surface, boundary_edges


def close_holes(report: Diagnosis, v: NDArray[np.float64], f: NDArray[np.int64]) -> Surface:
    """Close every hole by a lid: a fan of triangles about the middle of its rim.

    Raises:
        MeshError: the boundary forms no loops.
    """
    loops = boundary_loops(f)
    report.holes = tuple(_measure_hole(v[loop]) for loop in loops)

    # a lid runs against the boundary, so that every open edge meets its reverse
    middles = [v[loop].mean(axis=0)[None] for loop in loops]
    lids = [
        np.column_stack([np.roll(loop, -1), loop, np.full(len(loop), middle)])
        for middle, loop in enumerate(loops, len(v))
    ]
    return np.vstack([v, *middles]), np.vstack([f, *lids])


def boundary_loops(f: NDArray[np.int64]) -> list[list[int]]:
    """The boundary of a surface as loops of vertices, along its directed edges.

    Raises:
        MeshError: an edge leads to a vertex that no edge leaves.
    """
    onward: dict[int, list[int]] = {}
    for a, b in boundary_edges(f).tolist():
        onward.setdefault(a, []).append(b)

    # follow unused edges from any vertex until they come back to it
    loops: list[list[int]] = []
    while onward:
        loop = [next(iter(onward))]
        while True:
            ends = onward.get(loop[-1])
            if not ends:
                raise MeshError(
                    "it is open and its boundary forms no loops; export it as one closed solid"
                )
            end = ends.pop()
            if not ends:
                del onward[loop[-1]]
            if end == loop[0]:
                break
            loop.append(end)
        loops.append(loop)
    return loops


def _measure_hole(rim: NDArray[np.float64]) -> Hole:
    """Measure a hole from the vertices (n, 3) [m] of its rim.

    Its uncertain volume is that of half a ball over a disk of the same area A: 2/3 A sqrt(A / pi).
    """
    middle = rim.mean(axis=0)
    following = np.roll(rim, -1, axis=0)
    area = float(np.linalg.norm(0.5 * np.cross(rim - middle, following - middle).sum(axis=0)))
    perimeter = float(np.linalg.norm(following - rim, axis=1).sum())
    return Hole(len(rim), perimeter, 2.0 / 3.0 * area * float(np.sqrt(area / np.pi)))

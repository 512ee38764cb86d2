"""Submersion with the tree of moments, against visiting all triangles."""

import time
from collections.abc import Iterator, Sequence
from unittest import mock

import numpy as np
import trimesh
from numpy.typing import NDArray
from rich.table import Table

from benchmarks.timing import ATTITUDES, least_duration, spent_since
from buoyancy_mj import RegularWave, TriMesh, Water
from buoyancy_mj.meshes import tree
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

Results = dict[str, dict[str, float]]
"""Ratios of times by number of triangles, and by body and surface."""


def measure(quick: bool) -> Results:
    """Measure balls and plates with growing numbers of triangles."""
    levels = (4,) if quick else (2, 3, 4, 5, 6)
    rows = [_measure_size(20 * 4**level, least_duration(quick)) for level in levels]
    return {f"{row['triangles']:.0f}": row for row in rows}


def _measure_size(triangles: int, least: float) -> dict[str, float]:
    """Measure a ball, and a plate that lies in the surface, which is the tree's worst case."""
    ball = trimesh.creation.icosphere(subdivisions=round(np.log2(triangles / 20) / 2), radius=0.5)
    plate = trimesh.creation.box([0.8, 0.6, 0.01])
    while len(plate.faces) < triangles / 2:
        plate = plate.subdivide()

    # the wave passes through the level in the middle
    wave = RegularWave(0.05, wavelength=5.0)
    seas = {"still": Water(), "waves": Water(waves=wave)}
    moment = 0.25 * wave.period
    row = {"triangles": float(len(ball.faces))}
    bodies = (("ball", ball, ATTITUDES), ("plate", plate, [np.eye(3)] * len(ATTITUDES)))
    for name, solid, rotations in bodies:
        for surface, water in seas.items():
            row[f"{name}, {surface}"] = _measure_ratio(solid, rotations, water, moment, least)
    return row


def _measure_ratio(
    solid: trimesh.Trimesh,
    rotations: Sequence[NDArray[np.float64]],
    water: Water,
    moment: float,
    least: float,
) -> float:
    """Time with the tree, where it is chosen, over that without, each the least in a pose."""
    # a mesh keeps its tree, so each has its own
    with_tree = _pack(solid, water)
    with mock.patch.object(tree, "FEW", 10**9):
        without_tree = _pack(solid, water)

    # in turns, so that both see the same machine
    best = np.full((2, len(rotations)), np.inf)
    started = time.perf_counter()
    while np.isinf(best).any() or time.perf_counter() - started < 2.0 * least:
        for i, rotation in enumerate(rotations):
            for row, hulls in zip(best, (with_tree, without_tree), strict=True):
                before = time.thread_time()
                hulls.submerge(np.zeros((1, 3)), rotation.reshape(1, 9), moment)
                row[i] = min(row[i], spent_since(before))
    return float(best[0].mean() / best[1].mean())


def _pack(solid: trimesh.Trimesh, water: Water) -> PackedHulls:
    return PackedHulls(HullSet([TriMesh(solid.vertices, solid.faces)]), water)


def describe(results: Results) -> Iterator[Table | str]:
    """Describe the ratios in a table."""
    table = Table(
        title="time by the tree where it is chosen, over time without, same mesh and poses"
    )
    rows = list(results.values())
    for column in rows[0]:
        table.add_column(column, justify="right")
    for row in rows:
        ratios = (f"{row[column]:.2f}" for column in row if column != "triangles")
        table.add_row(f"{row['triangles']:,.0f}", *ratios)
    yield table

"""A submersion with its mesh in the processor's caches, and after others have had those.

A walk over a large mesh waits for memory more than it computes: where others share the caches, or
where these are small, it takes longer. A ratio to another package, which computes more, falls then.
"""

import time
from collections.abc import Iterator

import numpy as np
import trimesh

from benchmarks.rows import Row, describe_time
from benchmarks.timing import ATTITUDES, spent_since
from buoyancy_mj import TriMesh, Water
from buoyancy_mj.submersion.exact import PackedHulls
from buoyancy_mj.submersion.hull_set import HullSet

WARM, FLUSHED = "warm", "flushed"
"""How a submersion is measured: right after another one, and after much other memory was used."""
OTHERS = 96 << 20
"""Memory that is used in between [B], more than the caches hold."""

Results = dict[str, dict[str, float]]
"""Times [s] by number of triangles and by the state of the caches."""


def measure(quick: bool) -> Results:
    """Measure balls on still water."""
    others = np.zeros(OTHERS // 8)
    return {
        f"{20 * 4**level}": _measure_ball(level, others, rounds=3 if quick else 10)
        for level in (4, 6)
    }


def _measure_ball(level: int, others: np.ndarray, rounds: int) -> dict[str, float]:
    """Least times of a ball of 20 * 4**level triangles, mean over attitudes."""
    solid = trimesh.creation.icosphere(level)
    hulls = PackedHulls(HullSet([TriMesh(solid.vertices, solid.faces)]), Water())
    best = {state: np.full(len(ATTITUDES), np.inf) for state in (WARM, FLUSHED)}
    for _ in range(rounds):
        for i, rotation in enumerate(ATTITUDES):
            position = np.array([[0.0, 0.0, 0.2 * np.sin(i)]])
            for state in (FLUSHED, WARM):
                if state == FLUSHED:
                    others += 1.0
                started = time.thread_time()
                hulls.submerge(position, rotation.reshape(1, 9), 0.0)
                best[state][i] = min(best[state][i], spent_since(started))
    return {state: float(times.mean()) for state, times in best.items()}


def describe(results: Results) -> Iterator[str]:
    """Describe each ball in a line."""
    for triangles, row in results.items():
        yield (
            f"a ball of {int(triangles):,} triangles: {row[WARM] * 1e6:.1f} us right after another "
            f"submersion, {row[FLUSHED] * 1e6:.1f} us after other work, "
            f"{row[FLUSHED] / row[WARM]:.1f} x"
        )


def rows(results: Results) -> Iterator[Row]:
    """What it costs that others had the caches."""
    for triangles, row in results.items():
        yield Row(
            f"submersion of {int(triangles):,} triangles that are in no cache",
            describe_time(row[FLUSHED]),
            row[FLUSHED] / row[WARM],
            "as long as right after another",
        )

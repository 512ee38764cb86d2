"""How much memory water takes: of a model, of each of its data, and of steps, which take none."""

import gc
import os
from collections.abc import Iterator
from pathlib import Path

import mujoco

from benchmarks.rows import Row
from buoyancy_mj import read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

COPIES, STEPS = 200, 20_000
"""Data that are made, and steps of one of them."""
_STATM = Path("/proc/self/statm")

Results = dict[str, float]
"""Resident memory [B] by what takes it; empty where the system does not tell."""


def measure(quick: bool) -> Results:
    """Measure the SAUVC vehicle in waves."""
    if not _STATM.is_file():
        return {}
    scene = read_scene(catalog.scenes()["auv_waves"])
    # what the process needs anyway, and what the first water compiles
    first, data, _ = assemble(scene, with_water=True)
    mujoco.mj_step(first, data, 100)

    before = _read_resident()
    model, data, _ = assemble(scene, with_water=True)
    mujoco.mj_step(model, data, 100)
    built = _read_resident() - before
    bare, _, _ = assemble(scene)
    sizes, kept = {}, []
    for label, one in (("bare", bare), ("wet", model)):
        before = _read_resident()
        for _ in range(COPIES):
            kept.append(mujoco.MjData(one))
            mujoco.mj_step(one, kept[-1])
        sizes[label] = (_read_resident() - before) / COPIES
    before = _read_resident()
    mujoco.mj_step(model, data, STEPS // 10 if quick else STEPS)
    return {
        "model": built,
        "data, bare": sizes["bare"],
        "data": sizes["wet"],
        "steps": _read_resident() - before,
    }


def _read_resident() -> float:
    """Resident memory of this process [B]."""
    gc.collect()
    return float(_STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def describe(results: Results) -> Iterator[str]:
    """Describe it in a line."""
    if results:
        yield (
            f"memory of auv_waves: {results['model'] / 1e6:.1f} MB for model and water, "
            f"{results['data'] / 1e3:.0f} kB for each data, {results['data, bare'] / 1e3:.0f} kB "
            f"without water, {results['steps'] / 1e3:.0f} kB for {STEPS:,} steps"
        )


def rows(results: Results) -> Iterator[Row]:
    """What a data takes."""
    if results:
        yield Row(
            "memory of each data of `auv_waves`",
            f"{results['data'] / 1e3:,.0f} kB",
            results["data"] / results["data, bare"],
            "as much as without water",
        )

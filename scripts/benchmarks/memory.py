"""How much memory water takes: for each data, and for steps, which should take none."""

import gc
import os
from collections.abc import Iterator
from pathlib import Path

import mujoco

from benchmarks.rows import Row
from buoyancy_mj import read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

COPIES = 200
"""How many data are made."""
STEPS = 20_000
"""Steps after which memory should be as before."""
_STATM = Path("/proc/self/statm")

Results = dict[str, float]
"""Resident memory [B] by what takes it; empty where the system does not tell."""


def measure(quick: bool) -> Results:
    """Measure the SAUVC vehicle in waves."""
    if not _STATM.is_file():
        return {}
    scene = read_scene(catalog.scenes()["auv_waves"])
    model, data, _ = assemble(scene, with_water=True)
    bare, _, _ = assemble(scene)
    kept: list[mujoco.MjData] = []
    results = {}
    for label, one in (("bare", bare), ("wet", model)):
        # what was freed before is used first
        _make(one, kept, COPIES // 2)
        before = _read_resident()
        _make(one, kept, COPIES)
        results[label] = (_read_resident() - before) / COPIES
    mujoco.mj_step(model, data, 100)
    before = _read_resident()
    mujoco.mj_step(model, data, STEPS // 10 if quick else STEPS)
    return results | {"steps": _read_resident() - before}


def _make(model: mujoco.MjModel, kept: list[mujoco.MjData], count: int) -> None:
    """Make data, and step each."""
    for _ in range(count):
        kept.append(mujoco.MjData(model))
        mujoco.mj_step(model, kept[-1])


def _read_resident() -> float:
    """Resident memory of this process [B]."""
    gc.collect()
    return float(_STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def describe(results: Results) -> Iterator[str]:
    """Describe it in a line."""
    if results:
        added = results["wet"] - results["bare"]
        yield (
            f"memory of auv_waves: {results['bare'] / 1e3:.0f} kB for each data, "
            f"{added / 1e3:.0f} kB more with water; {results['steps'] / 1e3:.0f} kB for many steps"
        )


def rows(results: Results) -> Iterator[Row]:
    """What a data takes."""
    if results:
        yield Row(
            "memory of each data of `auv_waves`",
            f"{results['wet'] / 1e3:,.0f} kB",
            results["wet"] / results["bare"],
            "as much as without water",
        )

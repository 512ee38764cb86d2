"""Building the water of models whose meshes are new, or were seen before."""

import os
import tempfile
import time
from collections.abc import Iterator

import mujoco
import numpy as np

from benchmarks.rows import Row, describe_time
from buoyancy_mj import Buoyancy
from buoyancy_mj.meshes import cache
from buoyancy_mj.scenes import catalog

BUILT = ("sauvc_auv", "bluerov2_heavy", "catamaran", "hourglass")
"""Models whose water is built."""

Results = dict[str, dict[str, float]]
"""Times [s] by model and by who has seen its meshes."""


def measure(quick: bool) -> Results:
    """Measure processor time [s] to build `Buoyancy` of meshes that are new, or were seen before.

    By another process, or by this one. Everything is imported and compiled.
    """
    before = os.environ.get("BUOYANCY_MJ_CACHE")
    try:
        return {name: _build_times(name, 1 if quick else 5) for name in BUILT}
    finally:
        os.environ.pop("BUOYANCY_MJ_CACHE")
        if before is not None:
            os.environ["BUOYANCY_MJ_CACHE"] = before


def _build_times(name: str, repeats: int) -> dict[str, float]:
    """Least time to build a model that ships, by who has seen its meshes before."""
    model = mujoco.MjModel.from_xml_path(str(catalog.models()[name]))
    times = {"new": np.inf, "on disk": np.inf, "in memory": np.inf}
    Buoyancy(model)
    for _ in range(repeats):
        with tempfile.TemporaryDirectory() as folder:
            os.environ["BUOYANCY_MJ_CACHE"] = folder
            for kind in times:
                if kind != "in memory":
                    cache.forget()
                started = time.process_time()
                Buoyancy(model)
                times[kind] = min(times[kind], time.process_time() - started)
    return times


def describe(results: Results) -> Iterator[str]:
    """Describe each model in a line."""
    for name, times in results.items():
        yield (
            f"building the water of {name}: {times['new'] * 1e3:.0f} ms of new meshes, "
            f"{times['on disk'] * 1e3:.1f} ms of those that another process has seen, "
            f"{times['in memory'] * 1e3:.1f} ms of those that this one has"
        )


def rows(results: Results) -> Iterator[Row]:
    """Each model, its meshes kept on disk by another process."""
    for name, times in results.items():
        what = f"building the water of `{name}`, meshes seen before"
        factor = times["on disk"] / times["new"]
        yield Row(what, describe_time(times["on disk"]), factor, "as long as of new meshes")

"""Whole runs of scenes against real time: headless, recorded, and stepped by the engine alone."""

import functools
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco
import numpy as np

from benchmarks.rows import Row
from buoyancy_mj import Scene, Simulation, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.viz.recording import Recording

Results = dict[str, dict[str, float]]
"""Simulated over processor time by scene and by how it is run."""


def measure(_quick: bool) -> Results:
    """Measure simulated over processor time of scenes, headless, bare and recorded.

    Bare is one `mj_step` over the whole scene, with its water.
    """
    results = {name: _headless_factors(name) for name in ("auv_waves", "hourglass_drop_waves")}
    with tempfile.TemporaryDirectory() as folder:
        results["auv_waves"]["recorded"] = _recorded_factor("auv_waves", Path(folder) / "run.rrd")
    return results


def _headless_factors(name: str) -> dict[str, float]:
    """Run a scene, and step the same model and data without anybody who watches."""
    least = {"headless": np.inf, "bare": np.inf}
    for _ in range(3):
        simulation = Simulation(_load(name))
        least["headless"] = min(least["headless"], _measure_processor(simulation.run))
        bare = Simulation(_load(name))
        step = functools.partial(mujoco.mj_step, bare.model, bare.data, bare.steps)
        least["bare"] = min(least["bare"], _measure_processor(step))
    return {label: simulation.scene.duration / seconds for label, seconds in least.items()}


def _recorded_factor(name: str, path: Path) -> float:
    """Run a scene, and record it at its rate."""
    simulation = Simulation(_load(name))
    recording = Recording(simulation, path)

    def record() -> None:
        for frame in simulation.frames():
            recording.add(frame)
        recording.close(simulation.summary())

    return simulation.scene.duration / _measure_processor(record)


def _measure_processor(call: Callable[[], object]) -> float:
    """Processor time of a call [s], of all threads of this process."""
    started = time.process_time()
    call()
    return time.process_time() - started


def describe(results: Results) -> Iterator[str]:
    """Describe each scene in a line."""
    for name, factors in results.items():
        recorded = factors.get("recorded")
        rest = "" if recorded is None else f", {recorded:.1f} x recorded at 60 Hz"
        yield (
            f"{name}: {factors['headless']:.0f} x real time headless, "
            f"{factors['bare'] / factors['headless']:.2f} times as long as mj_step alone{rest}"
        )


def _load(name: str) -> Scene:
    return read_scene(catalog.scenes()[name])


def rows(results: Results) -> Iterator[Row]:
    """Each scene, headless and recorded."""
    for name, factors in results.items():
        first = name == "auv_waves"
        yield Row(f"`run {name}`, headless", "", factors["headless"], "of real time", first)
        if "bare" in factors:
            part = factors["bare"] / factors["headless"]
            yield Row(f"`run {name}`, headless", "", part, "as long as `mj_step` alone")
        if "recorded" in factors:
            yield Row(f"`run {name}`, recorded", "", factors["recorded"], "of real time")

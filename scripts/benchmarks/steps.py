"""Steps of scenes: with water and without, in seas, in batches, as whole runs, and the first."""

import dataclasses
import os
import functools
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import mujoco
import numpy as np
from mujoco import batch

from buoyancy_mj import Buoyancy, JonswapSea, RegularWave, Scene, Simulation, read_scene
from buoyancy_mj.meshes import cache
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.viz.recording import Recording

Results = dict[str, dict[str, float]]
"""Values by scene or model of pressure, and by what differs."""
COMPONENTS = 64
"""Waves of the sea."""
COPIES = 64
"""Simulations of a batch."""
BUILT = ("sauvc_auv", "bluerov2_heavy", "catamaran", "hourglass")
"""Models whose water is built."""


def _load_scene(name: str, *settings: str) -> Scene:
    return read_scene(catalog.scenes()[name], settings)


# a step with water and without


def measure_step(quick: bool) -> Results:
    """Measure steps of scenes, and of one of them by each model of pressure."""
    results = {
        name: _mean_step(_load_scene(name), quick)
        for name in ("auv_drop_still", "auv_pool", "auv_waves")
    }
    for pressure in ("hydrostatic", "froude-krylov"):
        scene = _load_scene("auv_waves", f'pressure="{pressure}"')
        results[f"auv_waves, {pressure}"] = _mean_step(scene, quick)
    return results


def _mean_step(scene: Scene, quick: bool) -> dict[str, float]:
    """Mean time of one step [s] over the whole of a scene, with compiled water and without."""
    times = {}
    for label, with_water in (("with", True), ("without", False)):
        best = np.inf
        for _ in range(1 if quick else 3):
            model, data, _ = assemble(scene, with_water=with_water)
            mujoco.mj_forward(model, data)
            steps = round(scene.duration / scene.timestep)
            started = time.perf_counter()
            mujoco.mj_step(model, data, steps)
            best = min(best, (time.perf_counter() - started) / steps)
        times[label] = best
    return times


def describe_step(results: Results) -> Iterator[str]:
    """Describe each scene in a line."""
    for name, step in results.items():
        yield (
            f"mean step of {name}: {step['with'] * 1e6:.1f} us with water, "
            f"{step['without'] * 1e6:.1f} us without, {step['with'] / step['without']:.1f} x"
        )


# a sea of many waves


def measure_sea(quick: bool) -> Results:
    """Measure the water's part of a step [s] in one wave and in a sea of the same energy."""
    scene = _load_scene("auv_sea_state_2", f"duration={1 if quick else 10}")
    waves = {
        "one wave": RegularWave(0.3 / np.sqrt(8.0), period=3.5),
        "sea": JonswapSea(0.3, 3.5, components=COMPONENTS, spreading=10.0),
    }
    results: Results = {}
    for pressure in ("archimedes", "froude-krylov"):
        results[pressure] = {}
        for label, wave in waves.items():
            water = dataclasses.replace(scene.water, waves=wave)
            sea = dataclasses.replace(scene, water=water, pressure=pressure)
            step = _mean_step(sea, quick)
            results[pressure][label] = step["with"] - step["without"]
    return results


def describe_sea(results: Results) -> Iterator[str]:
    """Describe each model of pressure in a line."""
    for pressure, row in results.items():
        yield (
            f"water's part of a step of auv_sea_state_2, {pressure}: "
            f"{row['one wave'] * 1e6:.1f} us in one wave, {row['sea'] * 1e6:.1f} us in "
            f"{COMPONENTS}, {row['sea'] / row['one wave']:.1f} x"
        )


# batches


def measure_batch(_quick: bool) -> Results:
    """Measure simulated over wall time of batches, on one thread and on two."""
    return {name: _batch_factors(_load_scene(name)) for name in ("auv_drop_still", "auv_waves")}


def _batch_factors(scene: Scene) -> dict[str, float]:
    """Simulated over wall time of copies of a scene's model, by number of threads."""
    model, data, _ = assemble(scene, with_water=True)
    factors = {}
    for threads in (1, 2):
        copies = batch.Batch(model, COPIES, nthread=threads)
        copies.bind("qpos")[:] = data.qpos
        copies.step(nstep=10)
        best = np.inf
        for _ in range(3):
            copies.bind("qpos")[:] = data.qpos
            copies.bind("qvel")[:] = 0.0
            started = time.perf_counter()
            copies.step(nstep=100)
            best = min(best, time.perf_counter() - started)
        factors[f"{threads} threads"] = COPIES * 100 * scene.timestep / best
    return factors


def describe_batch(results: Results) -> Iterator[str]:
    """Describe each scene in a line."""
    for name, factors in results.items():
        one = factors["1 threads"]
        two = factors["2 threads"]
        yield (
            f"{COPIES} of {name} in a batch: {one:,.0f} x real time on one thread, "
            f"{two:,.0f} x on two, {two / one:.2f} x"
        )


# whole runs


def measure_real_time(_quick: bool) -> Results:
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
        simulation = Simulation(_load_scene(name))
        least["headless"] = min(least["headless"], _measure_processor(simulation.run))
        bare = Simulation(_load_scene(name))
        step = functools.partial(mujoco.mj_step, bare.model, bare.data, bare.steps)
        least["bare"] = min(least["bare"], _measure_processor(step))
    return {label: simulation.scene.duration / seconds for label, seconds in least.items()}


def _recorded_factor(name: str, path: Path) -> float:
    """Run a scene, and record it at its rate."""
    simulation = Simulation(_load_scene(name))
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


def describe_real_time(results: Results) -> Iterator[str]:
    """Describe each scene in a line."""
    for name, factors in results.items():
        recorded = factors.get("recorded")
        rest = "" if recorded is None else f", {recorded:.1f} x recorded at 60 Hz"
        yield (
            f"{name}: {factors['headless']:.0f} x real time headless, "
            f"{factors['bare'] / factors['headless']:.2f} times as long as mj_step alone{rest}"
        )


# building the water of a model


def measure_build(quick: bool) -> Results:
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


def describe_build(results: Results) -> Iterator[str]:
    """Describe each model in a line."""
    for name, times in results.items():
        yield (
            f"building the water of {name}: {times['new'] * 1e3:.0f} ms of new meshes, "
            f"{times['on disk'] * 1e3:.1f} ms of those that another process has seen, "
            f"{times['in memory'] * 1e3:.1f} ms of those that this one has"
        )


# the first step


def measure_first_step(_quick: bool) -> float:
    """Measure the time [s] from a fresh interpreter, kernels compiled, through a first step."""
    code = (
        "from buoyancy_mj import *; from buoyancy_mj.scenes import catalog; "
        "Simulation(read_scene(catalog.scenes()['auv_waves'])).step()"
    )
    times = []
    for _ in range(3):
        started = time.perf_counter()
        subprocess.run([sys.executable, "-P", "-c", code], check=True)
        times.append(time.perf_counter() - started)
    return statistics.median(times)


def describe_first_step(seconds: float) -> Iterator[str]:
    """Describe it in a line."""
    yield f"from a fresh interpreter through the first step of auv_waves: {seconds:.2f} s"

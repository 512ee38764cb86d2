"""Steps of scenes: with water and without, in batches, as whole runs, and the first."""

import dataclasses
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
from mujoco import batch

from benchmarks.rows import Row, describe_time
from benchmarks.stretches import Course, Plan, find_starts, time_steps
from buoyancy_mj import Scene, Simulation, Start, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.viz.recording import Recording

Results = dict[str, dict[str, float]]
"""Values by scene or model of pressure, and by what differs."""
STRETCH = 20
"""Steps that are timed at once."""
COPIES = 64
"""Simulations of a batch."""


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
    """Mean time of one step [s] over the whole of a scene, with compiled water and without.

    The steps without start from the same states, lest they go on the ground.
    """
    model, data, _ = assemble(scene, with_water=True)
    mujoco.mj_forward(model, data)
    bare, _, _ = assemble(dataclasses.replace(scene, start=Start()))
    count = round(scene.duration / scene.timestep / STRETCH)
    plan = Plan(count, apart=STRETCH, steps=STRETCH, rounds=2 if quick else 10)
    starts = find_starts(model, data, plan)
    return time_steps({"with": Course(model, starts), "without": Course(bare, starts)}, plan)


def describe_step(results: Results) -> Iterator[str]:
    """Describe each scene in a line."""
    for name, step in results.items():
        yield (
            f"mean step of {name}: {step['with'] * 1e6:.1f} us with water, "
            f"{step['without'] * 1e6:.1f} us without, {step['with'] / step['without']:.1f} x"
        )


def step_rows(results: Results) -> Iterator[Row]:
    """A step of each scene, against the engine alone."""
    for name, step in results.items():
        scene, _, pressure = name.partition(", ")
        what = f"step of `{scene}`" + (f", {pressure}" if pressure else "")
        factor = step["with"] / step["without"]
        first = not pressure
        yield Row(what, describe_time(step["with"]), factor, "as long as the engine alone", first)


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


def batch_rows(results: Results) -> Iterator[Row]:
    """Each scene on two threads."""
    for name, factors in results.items():
        what = f"{COPIES} of `{name}` in a batch on two threads"
        yield Row(what, "", factors["2 threads"], "of real time", name == "auv_waves")


# whole runs


def measure_real_time(_quick: bool) -> dict[str, float]:
    """Measure simulated over wall time of a scene, without and with a recording at its rate."""
    with tempfile.TemporaryDirectory() as folder:
        headless = _real_time_factor(None)
        recorded = _real_time_factor(Path(folder) / "run.rrd")
    return {"headless": headless, "recorded": recorded}


def _real_time_factor(record: Path | None) -> float:
    """Run a scene, and record it into a file if there is one."""
    simulation = Simulation(_load_scene("auv_waves"))
    recording = Recording(simulation, record) if record else None
    for frame in simulation.frames():
        if recording:
            recording.add(frame)
    summary = simulation.summary()
    if recording:
        recording.close(summary)
    return summary.real_time_factor


def describe_real_time(results: dict[str, float]) -> Iterator[str]:
    """Describe both in a line."""
    yield (
        f"auv_waves: {results['headless']:.1f} x real time headless, "
        f"{results['recorded']:.1f} x recorded at 60 Hz"
    )


def real_time_rows(results: dict[str, float]) -> Iterator[Row]:
    """A run without and with a recording."""
    yield Row("`run auv_waves`, headless", "", results["headless"], "of real time", first=True)
    yield Row("`run auv_waves`, recorded at 60 Hz", "", results["recorded"], "of real time")


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


def first_step_rows(seconds: float) -> Iterator[Row]:
    """What it takes."""
    yield Row("fresh interpreter through the first step of `auv_waves`", describe_time(seconds))

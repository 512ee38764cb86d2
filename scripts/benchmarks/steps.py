"""Steps of scenes: with water and without, and in batches."""

import dataclasses
import time
from collections.abc import Iterator

import mujoco
import numpy as np
from mujoco import batch

from benchmarks.rows import Row, describe_time
from benchmarks.stretches import Course, Plan, find_starts, time_steps
from buoyancy_mj import Scene, Start, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

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
        first = name == "auv_waves"
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
        yield Row(what, "", factors["2 threads"], "of real time")

"""What the equipment of a vehicle adds to a step."""

import time
from collections.abc import Iterator

import mujoco
import numpy as np

from buoyancy_mj import add_water, read_scene
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import INTEGRATORS
from buoyancy_mj.scenes.vehicles import read_vehicle

COMMANDS = (10.0, -10.0, -10.0, 10.0, 10.0, 10.0, -10.0, -10.0)
"""Of the thrusters [N]: together they do nothing, so that the vehicle goes as it does without."""
STEPS, STRETCHES = 20, 50
"""Steps of a stretch that is timed, and how many of them make the ten seconds of the scene."""
PLUGINS = ("buoyancy_mj.thruster",)
"""Plugins of the equipment that is taken off."""


def measure(quick: bool) -> dict[str, float]:
    """Measure a mean step of `auv_waves` [s], with the equipment of its vehicle and without."""
    models = {"with": _build(equipped=True), "without": _build(equipped=False)}
    starts = _run(models["without"])
    times = {label: np.full(STRETCHES, np.inf) for label in models}
    # from the same states, time of the thread, in turns, the best of each: others may be at work
    for _ in range(3 if quick else 10):
        for label, model in models.items():
            data = mujoco.MjData(model)
            data.ctrl[:] = COMMANDS[: model.nu]
            for stretch, (clock, qpos, qvel) in enumerate(starts):
                data.time, data.qpos[:], data.qvel[:] = clock, qpos, qvel
                started = time.thread_time()
                mujoco.mj_step(model, data, STEPS)
                spent = (time.thread_time() - started) / STEPS
                times[label][stretch] = min(times[label][stretch], spent)
    return {label: float(best.mean()) for label, best in times.items()}


def _run(model: mujoco.MjModel) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Time [s], positions and velocities at the beginning of each stretch of a run."""
    data, starts = mujoco.MjData(model), []
    for _ in range(STRETCHES):
        starts.append((data.time, data.qpos.copy(), data.qvel.copy()))
        mujoco.mj_step(model, data, STEPS)
    return starts


def _build(*, equipped: bool) -> mujoco.MjModel:
    """The vehicle of the scene in its waves."""
    scene = read_scene(catalog.scenes()["auv_waves"])
    spec = read_vehicle(catalog.model_path(scene.entries[0].model, scene.folder))
    spec.option.timestep = scene.timestep
    spec.option.integrator = INTEGRATORS[scene.integrator.lower()]
    if not equipped:
        elements = [*spec.actuators, *spec.sensors]
        taken = [e for e in elements if e.plugin.active and e.plugin.plugin_name in PLUGINS]
        for element in (*taken, *spec.keys):
            spec.delete(element)
    add_water(spec, scene)
    model = spec.compile()
    model.qpos0[:3] = scene.entries[0].start.position
    return model


def describe(results: dict[str, float]) -> Iterator[str]:
    """Describe it in a line."""
    yield (
        f"a step of auv_waves: {results['with'] * 1e6:.1f} us with eight thrusters, "
        f"{results['without'] * 1e6:.1f} us without, {results['with'] / results['without']:.3f} x"
    )

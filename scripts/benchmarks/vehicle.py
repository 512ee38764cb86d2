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
STEPS = 50
"""Of a stretch that is timed."""
PLUGINS = ("buoyancy_mj.thruster",)
"""Plugins of the equipment that is taken off."""


def measure(quick: bool) -> dict[str, float]:
    """Measure a step of `auv_waves` [s], with the equipment of its vehicle and without."""
    models = {"with": _build(equipped=True), "without": _build(equipped=False)}
    times = dict.fromkeys(models, np.inf)
    # in turns and in short stretches, for the machine may be busy
    for _ in range(20 if quick else 200):
        for label, model in models.items():
            data = mujoco.MjData(model)
            data.ctrl[:] = COMMANDS[: model.nu]
            mujoco.mj_step(model, data, 50)
            started = time.perf_counter()
            mujoco.mj_step(model, data, STEPS)
            times[label] = min(times[label], (time.perf_counter() - started) / STEPS)
    return times


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

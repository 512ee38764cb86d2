"""What the equipment of a vehicle adds to a step: its eight thrusters, and ten sensors."""

from collections.abc import Iterator, Sequence

import mujoco
import numpy as np

from benchmarks.rows import Row, describe_time
from benchmarks.stretches import Course, Plan, find_starts, time_steps
from buoyancy_mj import (
    Altimeter,
    Depth,
    Dvl,
    Elevation,
    Hydrophone,
    Pressure,
    SpeedThroughWater,
    WaterVelocity,
    Wet,
    add_sensor,
    add_water,
    read_scene,
)
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import INTEGRATORS
from buoyancy_mj.scenes.vehicles import read_vehicle

TEN = {
    "pressure": Pressure(noise=50.0),
    "depth": Depth(noise=0.01),
    "still depth": Depth(still=True),
    "elevation": Elevation(noise=0.01),
    "water velocity": WaterVelocity(noise=0.01),
    "speed through water": SpeedThroughWater(noise=0.01),
    "wet": Wet(radius=0.05),
    "dvl": Dvl(noise=0.005, water_lock=2.0),
    "altimeter": Altimeter(surface=True),
    "hydrophone": Hydrophone(noise=0.1),
}
"""One of each kind, and depth twice; each reads in each step."""
COMMANDS = (10.0, -10.0, -10.0, 10.0, 10.0, 10.0, -10.0, -10.0)
"""Of the thrusters [N]: together they do nothing, so that the vehicle goes as it does without."""


def measure(quick: bool) -> dict[str, float]:
    """Measure a mean step of `auv_waves` [s]: bare, with each piece of equipment, with all."""
    models = {
        "none": build([], thrusters=False),
        "thrusters": build([], thrusters=True),
        "all": build(list(TEN), thrusters=True),
    }
    if not quick:
        models |= {name: build([name], thrusters=False) for name in TEN}
    plan = Plan(starts=50, apart=20, steps=20, rounds=3 if quick else 10)
    starts = find_starts(models["none"], mujoco.MjData(models["none"]), plan)
    commanded = [start._replace(ctrl=np.array(COMMANDS)) for start in starts]
    return time_steps({name: Course(one, commanded) for name, one in models.items()}, plan)


def build(names: Sequence[str], *, thrusters: bool) -> mujoco.MjModel:
    """The vehicle of the scene in its waves over a floor, with some of the ten sensors alone."""
    scene = read_scene(catalog.scenes()["auv_waves"])
    spec = read_vehicle(catalog.model_path(scene.entries[0].model, scene.folder))
    spec.option.timestep = scene.timestep
    spec.option.integrator = INTEGRATORS[scene.integrator.lower()]
    spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], pos=[0, 0, -8])
    spec.worldbody.add_site(name="pinger", pos=[8, 3, -2])
    taken = [sensor for sensor in spec.sensors if sensor.plugin.active]
    if not thrusters:
        taken += [*spec.actuators, *spec.keys]
    for element in taken:
        spec.delete(element)
    add_water(spec, scene)
    for name in names:
        add_sensor(spec, "imu", TEN[name], name=name)
    model = spec.compile()
    model.qpos0[:3] = scene.entries[0].start.position
    return model


def describe(results: dict[str, float]) -> Iterator[str]:
    """Describe each, and all together, in a line."""
    bare = results["none"]
    for name in (*TEN, "thrusters"):
        if name in results:
            yield f"{name}: {(results[name] - bare) * 1e6:+.2f} us on a step of auv_waves"
    yield (
        f"a step of auv_waves: {results['all'] * 1e6:.1f} us with eight thrusters and ten sensors, "
        f"{bare * 1e6:.1f} us without, {results['all'] / bare:.3f} x"
    )


def rows(results: dict[str, float]) -> Iterator[Row]:
    """All equipment together, against none."""
    yield Row(
        "step of `auv_waves` with eight thrusters and ten sensors",
        describe_time(results["all"]),
        results["all"] / results["none"],
        "as long as without them",
    )

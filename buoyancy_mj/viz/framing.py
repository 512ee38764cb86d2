"""What a camera has to show: the middle of all vehicles, and how far they reach."""

from collections.abc import Iterable

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.simulation import Simulation


def find_middle(centres: Iterable[NDArray[np.float64]]) -> NDArray[np.float64]:
    """The middle (3,) [m] of the box around points, each (3,) [m]."""
    points = np.array(list(centres))
    return np.asarray(0.5 * (points.min(axis=0) + points.max(axis=0)))


def measure_extent(vehicles: Iterable[Vehicle], data: mujoco.MjData) -> float:
    """Length [m] of what holds all vehicles; of one it is its own."""
    vehicles = list(vehicles)
    roots = [data.xpos[vehicle.root] for vehicle in vehicles]
    middle = find_middle(roots)
    return max(
        vehicle.length + 2.0 * float(np.linalg.norm(root - middle))
        for vehicle, root in zip(vehicles, roots, strict=True)
    )


def place_at_start(simulation: Simulation) -> mujoco.MjData:
    """Data with the poses of a simulation as it stands, without a step of its own."""
    data = mujoco.MjData(simulation.model)
    data.qpos[:] = simulation.data.qpos
    mujoco.mj_kinematics(simulation.model, data)
    return data

"""What a camera has to show: the middle of all vehicles, and how far they reach."""

from collections.abc import Iterable

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle


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


def arrow_scale(vehicles: Iterable[Vehicle], body: int) -> float:
    """Length of an arrow over its force [m/N], for a force on a body.

    The weight of a vehicle is half as long as the vehicle. On what is no part of a vehicle, the
    arrow is on the scale of the first vehicle that weighs something.
    """
    weighing = [vehicle for vehicle in vehicles if vehicle.weight > 0.0]
    for vehicle in sorted(weighing, key=lambda one: body not in one.bodies):
        return 0.5 * vehicle.length / vehicle.weight
    return 0.0

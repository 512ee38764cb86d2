"""`Subject`: what a camera has to show, all vehicles whole."""

from collections.abc import Iterable

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle

CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2 & 1] for i in range(8)]) * 2.0 - 1.0


class Subject:
    """All vehicles, each in a ball about its centre of mass that turns with it.

    Args:
        model: the model.
        vehicles: what floats.
        data: poses at the start.
    """

    def __init__(
        self, model: mujoco.MjModel, vehicles: Iterable[Vehicle], data: mujoco.MjData
    ) -> None:
        self._vehicles = list(vehicles)
        self._reaches = np.array([_reach(model, one, data) for one in self._vehicles])
        self.count = len(self._vehicles)
        """How many vehicles there are."""
        root = self._vehicles[0].root
        self.heading = float(np.arctan2(data.xmat[root][3], data.xmat[root][0]))
        """Where the first vehicle points at the start, from x towards y [rad]."""

    def locate(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The middle of the box around all centres of mass (3,) [m]."""
        centres = self._centres(data)
        middle: NDArray[np.float64] = 0.5 * (centres.min(axis=0) + centres.max(axis=0))
        return middle

    def measure(self, data: mujoco.MjData) -> tuple[float, float]:
        """How far the vehicles reach from the middle, along the ground and up and down [m]."""
        arms = self._centres(data) - self.locate(data)
        along = np.hypot(arms[:, 0], arms[:, 1]) + self._reaches
        up = np.abs(arms[:, 2]) + self._reaches
        return float(along.max()), float(up.max())

    def _centres(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The centre of mass of each vehicle (n, 3) [m]."""
        return np.array([one.centre_of_mass(data) for one in self._vehicles])


def _reach(model: mujoco.MjModel, vehicle: Vehicle, data: mujoco.MjData) -> float:
    """How far a vehicle's geoms reach from its centre of mass [m]."""
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, vehicle.bodies) & (model.geom_rbound > 0.0))
    boxes = model.geom_aabb[geoms]
    corners = boxes[:, None, :3] + CORNERS * boxes[:, None, 3:]
    turns = data.geom_xmat[geoms].reshape(-1, 3, 3)
    points = np.einsum("gij,gcj->gci", turns, corners) + data.geom_xpos[geoms, None]
    centre = vehicle.centre_of_mass(data)
    far = np.linalg.norm(points - centre, axis=2).max(axis=1)
    # a ball reaches less far than the corners of its box
    balls = np.linalg.norm(data.geom_xpos[geoms] - centre, axis=1) + model.geom_rbound[geoms]
    return float(np.minimum(far, balls).max())

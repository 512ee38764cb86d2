"""`Monitor`: what the summary of a run keeps of its steps."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.summary import VehicleSummary
from buoyancy_mj.scenes.trajectory import Poses
from buoyancy_mj.sea.water import Water


class Monitor:
    """The draft of a vehicle, the height of its centre of gravity and its contacts, over a run.

    Args:
        model: the model in which the vehicle moves.
        vehicle: the vehicle.
        water: the sea.
    """

    def __init__(self, model: mujoco.MjModel, vehicle: Vehicle, water: Water) -> None:
        self.draft = math.nan
        """Depth of the lowest point of the hulls in the last poses [m]; negative above water."""
        self.peak_draft = -math.inf
        """Greatest draft so far [m]."""
        self.contact_steps = 0
        """Steps so far in which the vehicle touched something fixed."""
        self.first_contact: float | None = None
        """Time of the first of them [s]."""
        self._water = water
        amplitude, kx, ky, *_ = water.rows.T
        self._curvature = float(np.abs(amplitude) @ (kx * kx + ky * ky))
        self._vehicle = vehicle
        self._heights: list[tuple[float, float]] = []

        # the deepest point of a body is a corner of one of its convex hulls
        hulls = vehicle.hulls
        self._corners = [
            (body, _convex_corners(hulls, body)) for body in sorted({hull.body for hull in hulls})
        ]

        # pairs of geoms of which one is the vehicle's and the other is fixed
        fixed = ~find_moving_bodies(model)[model.geom_bodyid]
        own = np.isin(model.geom_bodyid, vehicle.bodies)
        self._touches = fixed[:, None] & own[None, :]
        self._touches |= self._touches.T

    def add_poses(self, poses: Poses, time: float) -> None:
        """Keep the draft and the height of the centre of gravity in poses at a time [s]."""
        corners = np.concatenate([_move(points, poses, body) for body, points in self._corners])
        self.draft = float(self._water.depth(self._choose_deep(corners, time), time).max())
        self.peak_draft = max(self.peak_draft, self.draft)
        vehicle = self._vehicle
        height = vehicle.masses @ poses.xipos[vehicle.bodies, 2] / vehicle.mass
        self._heights.append((time, float(height)))

    def _choose_deep(self, points: NDArray[np.float64], time: float) -> NDArray[np.float64]:
        """Those of points (n, 3) [m] that can be deepest at a time [s].

        Seen from the lowest point, the surface rises by its slope there, and by no more than its
        greatest curvature beyond that. What lies higher than this is less deep.
        """
        lowest = points[np.argmin(points[:, 2])]
        apart = points - lowest
        x, y, z = apart.T
        along, across = self._water.slope(lowest[0], lowest[1], time)
        rise = along * x + across * y + 0.5 * self._curvature * (x * x + y * y)
        return np.asarray(points[z <= rise + 1e-9])

    def add_contacts(self, data: mujoco.MjData, time: float) -> None:
        """Count the step that ended at a time [s] if the vehicle touched something fixed in it."""
        pairs = data.contact.geom
        if len(pairs) and self._touches[pairs[:, 0], pairs[:, 1]].any():
            self.contact_steps += 1
            if self.first_contact is None:
                self.first_contact = time

    def summary(self, start: float) -> VehicleSummary:
        """The run so far; the range of heights is taken from a time [s] on."""
        vehicle = self._vehicle
        return VehicleSummary(
            mass=vehicle.mass,
            displacement=vehicle.displacement,
            net_weight=vehicle.weight - vehicle.displacement * vehicle.gravity,
            peak_draft=self.peak_draft,
            final_draft=self.draft,
            cog_z_range=self.height_range(start),
            contact_steps=self.contact_steps,
            first_contact=self.first_contact,
        )

    def height_range(self, start: float) -> float:
        """Highest less lowest centre of gravity [m] from a time [s] on; NaN without poses."""
        heights = [height for time, height in self._heights if time >= start - 1e-9]
        return max(heights) - min(heights) if heights else math.nan


def _convex_corners(hulls: Sequence[Hull], body: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the convex hulls of a body's hulls, in its frame."""
    meshes = [hull.mesh_in_body for hull in hulls if hull.body == body]
    return np.vstack([mesh.vertices[ConvexHull(mesh.vertices).vertices] for mesh in meshes])


def _move(points: NDArray[np.float64], poses: Poses, body: int) -> NDArray[np.float64]:
    """Points (n, 3) [m] of a body's frame, in the world frame."""
    moved: NDArray[np.float64] = points @ poses.xmat[body].reshape(3, 3).T + poses.xpos[body]
    return moved

"""`Monitor`: what the summary of a run keeps of its steps."""

import math
from array import array
from collections.abc import Sequence

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

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
        self._times = array("d")
        self._heights = array("d")

        # the deepest point of a body is a corner of one of its convex hulls
        hulls = vehicle.hulls
        self._corners = []
        for body in sorted({hull.body for hull in hulls}):
            corners = _convex_corners(hulls, body)
            radius = float(np.linalg.norm(corners, axis=1).max())
            self._corners.append((body, corners, radius))

        # pairs of geoms of which one is the vehicle's and the other is fixed
        fixed = ~find_moving_bodies(model)[model.geom_bodyid]
        own = np.isin(model.geom_bodyid, vehicle.bodies)
        self._touches = fixed[:, None] & own[None, :]
        self._touches |= self._touches.T

    def add_poses(self, poses: Poses, time: float) -> None:
        """Keep the draft and the height of the centre of gravity in poses at a time [s]."""
        points = self._find_deep_corners(poses, time)
        self.draft = float(self._water.depth(points, time).max())
        self.peak_draft = max(self.peak_draft, self.draft)
        vehicle = self._vehicle
        height = vehicle.masses @ poses.xipos[vehicle.bodies, 2] / vehicle.mass
        self._times.append(time)
        self._heights.append(float(height))

    def _find_deep_corners(self, poses: Poses, time: float) -> NDArray[np.float64]:
        """Corners (n, 3) [m] in the world frame that can be deepest at a time [s], few of all.

        Within a radius the surface leaves its tangent plane by no more than half its greatest
        curvature times the square of the radius.
        """
        origin = poses.xpos[self._vehicle.root]
        down = np.array([0.0, 0.0, -1.0])
        if self._curvature > 0.0:
            down[:2] = self._water.slope(origin[0], origin[1], time)

        # depths under the tangent plane, up to a constant
        depths, reach = [], 0.0
        for body, corners, radius in self._corners:
            arm = poses.xpos[body] - origin
            depths.append(corners @ (down @ poses.xmat[body].reshape(3, 3)) + down @ arm)
            reach = max(reach, radius + math.hypot(*arm))

        # those that may lie under the surface as deep as the deepest
        least = max(float(depth.max()) for depth in depths) - self._curvature * reach**2 - 1e-9
        return np.concatenate(
            [
                _move(corners[depth >= least], poses, body)
                for (body, corners, _), depth in zip(self._corners, depths, strict=True)
            ]
        )

    def add_contacts(self, data: mujoco.MjData, time: float) -> None:
        """Count the step that ended at a time [s] if the vehicle touched something fixed in it."""
        pairs = data.contact.geom
        if len(pairs) and self._touches[pairs[:, 0], pairs[:, 1]].any():
            self.contact_steps += 1
            if self.first_contact is None:
                self.first_contact = time

    def summary(self, start: float, updates_at_limits: int | None = None) -> VehicleSummary:
        """The run so far.

        Args:
            start: time from which the range of heights is taken [s].
            updates_at_limits: what the controller knows, see `VehicleSummary`.
        """
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
            updates_at_limits=updates_at_limits,
        )

    def height_range(self, start: float) -> float:
        """Highest less lowest centre of gravity [m] from a time [s] on; NaN without poses."""
        late = np.frombuffer(self._times) >= start - 1e-9
        heights = np.frombuffer(self._heights)[late]
        return float(np.ptp(heights)) if len(heights) else math.nan


def _convex_corners(hulls: Sequence[Hull], body: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the convex hulls of a body's hulls, in its frame."""
    corners = []
    for vertices in (hull.mesh_in_body.vertices for hull in hulls if hull.body == body):
        try:
            corners.append(vertices[scipy.spatial.ConvexHull(vertices).vertices])
        except scipy.spatial.QhullError:
            # so thin that it has no convex hull
            corners.append(vertices)
    return np.vstack(corners)


def _move(points: NDArray[np.float64], poses: Poses, body: int) -> NDArray[np.float64]:
    """Points (n, 3) [m] of a body's frame, in the world frame."""
    moved: NDArray[np.float64] = points @ poses.xmat[body].reshape(3, 3).T + poses.xpos[body]
    return moved

"""`Monitor`: what the summary of a run keeps of its steps."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.scenes.trajectory import Poses
from buoyancy_mj.sea.water import Water


class Monitor:
    """The draft of a vehicle, the height of its centre of gravity and its contacts, over a run.

    Args:
        model: the model in which the vehicle moves.
        bodies: indices of the vehicle's bodies.
        hulls: the vehicle's hulls.
        water: the sea.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        bodies: NDArray[np.int64],
        hulls: Sequence[Hull],
        water: Water,
    ) -> None:
        self.draft = math.nan
        """Depth of the lowest point of the hulls in the last poses [m]; negative above water."""
        self.peak_draft = -math.inf
        """Greatest draft so far [m]."""
        self.contact_steps = 0
        """Steps so far in which the vehicle touched something fixed."""
        self.first_contact: float | None = None
        """Time of the first of them [s]."""
        self._water = water
        self._bodies = bodies
        self._masses = model.body_mass[bodies]
        self._heights: list[tuple[float, float]] = []

        # the deepest point of a body is a corner of one of its convex hulls
        self._corners = [
            (body, _convex_corners(hulls, body)) for body in sorted({hull.body for hull in hulls})
        ]

        # pairs of geoms of which one is the vehicle's and the other is fixed
        fixed = ~find_moving_bodies(model)[model.geom_bodyid]
        vehicle = np.isin(model.geom_bodyid, bodies)
        self._touches = fixed[:, None] & vehicle[None, :]
        self._touches |= self._touches.T

    def add_poses(self, poses: Poses, time: float) -> None:
        """Keep the draft and the height of the centre of gravity in poses at a time [s]."""
        self.draft = max(
            float(self._water.depth(_move(corners, poses, body), time).max())
            for body, corners in self._corners
        )
        self.peak_draft = max(self.peak_draft, self.draft)
        height = self._masses @ poses.xipos[self._bodies, 2] / self._masses.sum()
        self._heights.append((time, float(height)))

    def add_contacts(self, data: mujoco.MjData, time: float) -> None:
        """Count the step that ended at a time [s] if the vehicle touched something fixed in it."""
        pairs = data.contact.geom
        if len(pairs) and self._touches[pairs[:, 0], pairs[:, 1]].any():
            self.contact_steps += 1
            if self.first_contact is None:
                self.first_contact = time

    def height_range(self, start: float) -> float:
        """Highest less lowest centre of gravity [m] from a time [s] on; NaN without poses."""
        heights = [height for time, height in self._heights if time >= start - 1e-9]
        return max(heights) - min(heights) if heights else math.nan


def _convex_corners(hulls: Sequence[Hull], body: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the convex hulls of a body's hulls, in its frame."""
    corners = []
    for vertices in (hull.mesh_in_body.vertices for hull in hulls if hull.body == body):
        try:
            corners.append(vertices[ConvexHull(vertices).vertices])
        except QhullError:
            # so thin that it has no convex hull
            corners.append(vertices)
    return np.vstack(corners)


def _move(points: NDArray[np.float64], poses: Poses, body: int) -> NDArray[np.float64]:
    """Points (n, 3) [m] of a body's frame, in the world frame."""
    moved: NDArray[np.float64] = points @ poses.xmat[body].reshape(3, 3).T + poses.xpos[body]
    return moved

"""`Outline`: the corners of a vehicle, wherever its bodies are."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.geoms import read_geom_mesh
from buoyancy_mj.hulls.names import body_name


class Poses(NamedTuple):
    """Where the bodies of a vehicle are at one instant."""

    places: NDArray[np.float64]
    """Origins of the bodies (n, 3) [m], world frame."""
    axes: NDArray[np.float64]
    """Rotations from each body to the world (n, 3, 3)."""


class Outline:
    """The corners of what holds each body of a vehicle: the convex hull of its geoms.

    Geoms that can be touched count; those that are only drawn do where a vehicle has no others.
    What is on one side of a plane with all its corners is there as a whole.

    Args:
        model: any model.
        bodies: indices of the vehicle's bodies, the root body first.

    Raises:
        ModelError: none of the bodies has a geom that bounds a volume.
    """

    def __init__(self, model: mujoco.MjModel, bodies: Sequence[int]) -> None:
        self._root = int(bodies[0])
        data = mujoco.MjData(model)
        mujoco.mj_kinematics(model, data)

        # what can be touched, or all that is drawn where nothing can
        solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
        own = np.isin(model.geom_bodyid, bodies)
        counted = own & solid if (own & solid).any() else own

        # the geoms of bodies that move as one are held by one hull
        carriers = model.body_weldid[model.geom_bodyid]
        self._bodies, self._corners = [], []
        for body in sorted({int(model.body_weldid[body]) for body in bodies}):
            points = [
                _read_corners(model, data, geom, body)
                for geom in np.flatnonzero(counted & (carriers == body)).tolist()
            ]
            corners = np.concatenate([np.zeros((0, 3)), *points])
            if len(corners):
                self._bodies.append(body)
                self._corners.append(_keep_outermost(corners))
        if not self._corners:
            raise ModelError(
                f"vehicle '{body_name(model, self._root)}' has no geom that bounds a volume, so "
                "nobody can say where it ends; give it one"
            )
        self._reach = [float(np.linalg.norm(each, axis=1).max()) for each in self._corners]

    def read_poses(self, data: mujoco.MjData) -> Poses:
        """Where the bodies are now."""
        return Poses(data.xpos[self._bodies], data.xmat[self._bodies].reshape(-1, 3, 3))

    def bound(self, data: mujoco.MjData) -> tuple[NDArray[np.float64], float]:
        """A ball that holds the vehicle: the root body's origin (3,) [m], and a radius [m]."""
        origin = data.xpos[self._root].copy()
        arms = data.xpos[self._bodies] - origin
        return origin, float((np.sqrt((arms * arms).sum(axis=1)) + self._reach).max())

    def find_corners(self, poses: Poses) -> NDArray[np.float64]:
        """All corners (n, 3) [m] in the world frame, in an order that stays."""
        return np.concatenate(
            [
                corners @ axes.T + place
                for place, axes, corners in zip(*poses, self._corners, strict=True)
            ]
        )

    def measure(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """Length, width and height (3,) [m] of the vehicle along the axes of its root body."""
        corners = self.find_corners(self.read_poses(data)) @ data.xmat[self._root].reshape(3, 3)
        return np.asarray(np.ptp(corners, axis=0))


def _read_corners(
    model: mujoco.MjModel, data: mujoco.MjData, geom: int, body: int
) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of a geom in the frame of a body; none of what bounds no volume."""
    arrays = read_geom_mesh(model, geom)
    if arrays is None:
        return np.zeros((0, 3))
    places = arrays[0] @ data.geom_xmat[geom].reshape(3, 3).T + data.geom_xpos[geom]
    own: NDArray[np.float64] = (places - data.xpos[body]) @ data.xmat[body].reshape(3, 3)
    return own


def _keep_outermost(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of some points (n, 3) [m] that are corners of their convex hull."""
    try:
        return np.asarray(points[scipy.spatial.ConvexHull(points).vertices])
    except scipy.spatial.QhullError:
        # so thin that it has none
        return points

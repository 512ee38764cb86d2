"""`Floors`: the bottoms of a scene, and who has fallen through them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import (
    find_mocap_bodies,
    find_moving_bodies,
    group_floating_bodies,
)

_PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)
_LEVEL_COSINE = 0.95
"""Cosine of the slope up to which a plane counts as level ground."""


class Floors:
    """What a scene has under its bodies: level planes, and all that is fixed and can be touched.

    Bodies that float together have fallen through if something lay under one of them at the start,
    and now they lie as a whole below the lowest point of all floors while one of them is over them.
    Who went over an edge has not.

    Args:
        model: the model of the scene.
        data: its poses at the start, after mj_kinematics.
        bodies: indices of the bodies to watch (n,), all that can move.
    """

    def __init__(
        self, model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64]
    ) -> None:
        self._low, self._high = _find_boxes(model, data)
        bottom = float(np.min(self._low[:, 2], initial=np.inf))
        self._ceiling = bottom - _reach(model, data, bodies)
        groups = [np.flatnonzero(np.isin(bodies, each)) for each in group_floating_bodies(model)]
        centres = data.xipos[bodies]
        self._watched = [
            group for group in groups if any(self._is_above(centre) for centre in centres[group])
        ]
        self.lowest = np.array(self._ceiling)
        """Height [m] of each body's centre of mass (n,) under which it may have fallen through.

        It is minus infinity for all when nobody is watched any more."""
        self._give_up()

    def find_fallen(self, centres: NDArray[np.float64]) -> int | None:
        """The first of bodies that have fallen through, by its place among those watched, or None.

        Args:
            centres: centres of mass of the bodies (n, 3) [m].
        """
        is_low = centres[:, 2] < self._ceiling
        for group in [group for group in self._watched if is_low[group].all()]:
            if any(self._is_over(centre).any() for centre in centres[group]):
                return int(group[0])
            # they went over an edge, and may go on
            self._watched = [other for other in self._watched if other is not group]
            self._give_up()
        return None

    def _give_up(self) -> None:
        """Let nobody be low where nobody is watched."""
        if not self._watched:
            self.lowest[:] = -np.inf

    def _is_above(self, point: NDArray[np.float64]) -> bool:
        """Whether a floor lies under a point (3,) [m]."""
        return bool((self._is_over(point) & (self._low[:, 2] < point[2])).any())

    def _is_over(self, point: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether each floor lies over or under a point (3,) [m], seen from above."""
        inside = (self._low[:, :2] <= point[:2]) & (point[:2] <= self._high[:, :2])
        return np.asarray(inside.all(axis=1))


def _find_boxes(
    model: mujoco.MjModel, data: mujoco.MjData
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest corners (m, 3) [m] of what bounds each floor, along the world's axes."""
    fixed = ~(find_moving_bodies(model) | find_mocap_bodies(model))[model.geom_bodyid]
    solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    lows, highs = [np.zeros((0, 3))], [np.zeros((0, 3))]
    for geom in np.flatnonzero(fixed & solid).tolist():
        world_from_geom = data.geom_xmat[geom].reshape(3, 3)
        if model.geom_type[geom] == _PLANE:
            if world_from_geom[2, 2] < _LEVEL_COSINE:
                continue
            middle = data.geom_xpos[geom]
            half = np.array([np.inf, np.inf, 0.0])
        else:
            middle = data.geom_xpos[geom] + world_from_geom @ model.geom_aabb[geom, :3]
            half = np.abs(world_from_geom) @ model.geom_aabb[geom, 3:]
        lows.append((middle - half)[None])
        highs.append((middle + half)[None])
    return np.concatenate(lows), np.concatenate(highs)


def _reach(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Distance (n,) [m] of the farthest point of each body from its centre of mass, at most."""
    reach = np.zeros(model.nbody)
    arms = np.linalg.norm(data.geom_xpos - data.xipos[model.geom_bodyid], axis=1)
    np.maximum.at(reach, model.geom_bodyid, arms + model.geom_rbound)
    return np.asarray(reach[bodies])

"""`Kinematics`: poses of the bodies at coordinates, where a step does not leave them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.trajectory import Poses


class Kinematics:
    """Finds the poses of the bodies of a model at coordinates, on data of its own.

    Args:
        model: the model.
        data: where bodies of motion capture are.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        self._model = model
        self._data = mujoco.MjData(model)
        if model.nmocap:
            self._data.mocap_pos[:] = data.mocap_pos
            self._data.mocap_quat[:] = data.mocap_quat

    def find_poses(self, qpos: NDArray[np.float64]) -> Poses:
        """The poses (n, nbody, ...) at coordinates (n, nq)."""
        bodies = self._model.nbody
        poses = Poses(*(np.empty((len(qpos), bodies, size)) for size in (3, 9, 3)))
        for i, coordinates in enumerate(qpos):
            self._data.qpos[:] = coordinates
            mujoco.mj_kinematics(self._model, self._data)
            poses.xpos[i] = self._data.xpos
            poses.xmat[i] = self._data.xmat
            poses.xipos[i] = self._data.xipos
        return poses


def leaves_poses(model: mujoco.MjModel) -> bool:
    """Whether a step leaves the poses of its beginning: RK4 leaves those of its last stage."""
    return bool(model.opt.integrator != mujoco.mjtIntegrator.mjINT_RK4)

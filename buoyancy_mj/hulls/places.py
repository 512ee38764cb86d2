"""Where a geom stands in a body that it is fixed to: by the model alone, whatever the pose."""

import mujoco
import numpy as np
from numpy.typing import NDArray


def locate_geom(
    model: mujoco.MjModel, geom: int, body: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rotation (3, 3) and origin (3,) [m] of a geom's frame in that of a body it is fixed to."""
    rotation, position = _read_matrix(model.geom_quat[geom]), model.geom_pos[geom].copy()
    link = int(model.geom_bodyid[geom])
    while link != body:
        turn = _read_matrix(model.body_quat[link])
        rotation, position = turn @ rotation, turn @ position + model.body_pos[link]
        link = int(model.body_parentid[link])
    return rotation, position


def _read_matrix(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation (3, 3) of a quaternion (4,)."""
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, quaternion / np.linalg.norm(quaternion))
    return matrix.reshape(3, 3)

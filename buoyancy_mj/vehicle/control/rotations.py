"""Rotations by the engine's own functions, which cost a microsecond each."""

import math

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray


def rotate_quaternion(quaternion: ArrayLike) -> NDArray[np.float64]:
    """The rotation (3, 3) of a quaternion (4,), scalar first."""
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, np.asarray(quaternion, float))
    return rotation.reshape(3, 3)


def rotate_heading(heading: float) -> NDArray[np.float64]:
    """The rotation (3, 3) about the vertical by an angle [rad]."""
    sine, cosine = math.sin(heading), math.cos(heading)
    return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def find_rotation_vector(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """The axis times the angle (3,) [rad] of a rotation (3, 3), the short way round."""
    quaternion, vector = np.empty(4), np.empty(3)
    mujoco.mju_mat2Quat(quaternion, rotation.ravel())
    mujoco.mju_quat2Vel(vector, quaternion, 1.0)
    return vector

"""Waterline, mass and stiffness of a vessel in the horizontal axes along its heading."""

import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.weights import steiner

HEAVE_ROLL_PITCH = slice(2, 5)
"""Motions that still water restores, of surge, sway, heave, roll, pitch, yaw."""
_ROLL_PITCH = slice(3, 5)
_YAW = 5


def rotate_to_heading(heading: float) -> NDArray[np.float64]:
    """Rotation (3, 3) from the world's axes to x along a heading [rad], y to port, z up."""
    c, s = math.cos(heading), math.sin(heading)
    return np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def measure_waterline(pose: FloatingPose, axes: NDArray[np.float64]) -> tuple[float, float]:
    """Measure length and beam of the waterline [m], along axes (3, 3)."""
    turned = pose_vessel(pose.vessel, pose.position, axes @ pose.rotation).waterplane
    length, beam = turned.high - turned.low
    return float(length), float(beam)


def compute_mass_matrix(pose: FloatingPose, axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute mass and inertia about the centre of gravity (6, 6), in axes (3, 3)."""
    vessel, rotation = pose.vessel, axes @ pose.rotation
    mass, arm = vessel.whole_mass, rotation @ vessel.centre_of_mass

    # the cross product with the arm of the centre of mass, which gravity compensation sets apart
    x, y, z = mass * arm
    lever = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = mass * np.eye(3)
    matrix[:3, 3:], matrix[3:, :3] = -lever, lever
    matrix[3:, 3:] = rotation @ vessel.inertia @ rotation.T + mass * steiner(arm)
    return matrix


def compute_stiffness(pose: FloatingPose, axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the hydrostatic stiffness about the centre of gravity (6, 6), in axes (3, 3)."""
    matrix = np.zeros((6, 6))

    # heave, roll and pitch
    turn = np.eye(3)
    turn[1:, 1:] = axes[:2, :2]
    matrix[HEAVE_ROLL_PITCH, HEAVE_ROLL_PITCH] = turn @ pose.stiffness @ turn.T

    # the moments of buoyancy and of water in tanks turn with the heading
    x, y = pose.torque
    matrix[_ROLL_PITCH, _YAW] = axes[:2, :2] @ [y, -x]
    return matrix

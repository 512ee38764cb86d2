"""Which rest poses of a vessel are one: it turns from one to the other, and nothing resists."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.statics.balance import tilt, tilt_stiffness
from buoyancy_mj.statics.floating_pose import FloatingPose

FREE = 5e-4
"""Stiffness over weight times radius below which a turn counts as free.

A cylinder with 24 sides resists with 2e-4, a ball of 5120 facets with 5e-5."""
_NEARBY = 0.5 * math.pi
"""Angle between two poses up to which a way from one to the other is sought [rad]."""
_MOST_TRIES = 6
"""Ways from a pose that end at a rise, after which it counts as by itself."""
_STRIDE = 0.04
"""Stride on that way [rad]."""


def group_poses(poses: Sequence[FloatingPose]) -> NDArray[np.int64]:
    """Group rest poses that differ by heading alone, or by a roll that nothing resists.

    Two poses are one if the energy on the way from the higher to the lower stays below that of a
    turn with a stiffness of `FREE`, or if they are so with others between them that lie no higher:
    round a log, or all over a ball. A pose that nothing holds counts with that to which it falls.

    Args:
        poses: rest poses of one vessel (n).

    Returns:
        The number of the group of each (n,).
    """
    ups = np.array([pose.rotation[2] for pose in poses])
    groups = np.arange(len(poses))
    lowest = np.array([pose.energy for pose in poses])
    tries = np.zeros(len(poses), int)

    # the nearest first, whose way is the shortest
    ones, others = np.triu_indices(len(poses), 1)
    cosines = (ups @ ups.T)[ones, others]
    for k in np.argsort(-cosines, kind="stable"):
        if cosines[k] < math.cos(_NEARBY):
            break
        i, j = ones[k], others[k]
        if groups[i] == groups[j] or max(tries[i], tries[j]) >= _MOST_TRIES:
            continue
        floor = max(lowest[groups[i]], lowest[groups[j]])
        if _turns_freely(poses[i], poses[j], floor):
            lowest[groups[i]] = min(lowest[groups[i]], lowest[groups[j]])
            groups[groups == groups[j]] = groups[i]
        else:
            tries[[i, j]] += 1
    return groups


def _turns_freely(one: FloatingPose, two: FloatingPose, floor: float) -> bool:
    """Whether nothing resists a turn from the higher of two poses to the lower.

    Args:
        one: a rest pose.
        two: another.
        floor: energy of the poses that they stand for [J]; the higher of them lies no higher.
    """
    start, goal = (one, two) if one.energy >= two.energy else (two, one)
    angle = _angle_between(start, goal)
    free = 0.5 * FREE * start.vessel.weight * start.vessel.radius
    pose = start
    for _ in range(math.ceil(2.0 * angle / _STRIDE) + 1):
        if _angle_between(pose, goal) <= _STRIDE:
            return True
        rise = free * _angle_between(start, pose) ** 2
        if pose.energy > min(start.energy + rise, floor + free * angle**2):
            return False

        # on towards the goal, whose vertical leans that way, and down square to that
        lean = (pose.rotation @ goal.rotation[2])[:2]
        lean /= np.linalg.norm(lean)
        pose = _descend(tilt(pose, _STRIDE * np.array([lean[1], -lean[0]])), lean)
    return False


def _descend(pose: FloatingPose, axis: NDArray[np.float64]) -> FloatingPose:
    """Turn about a horizontal axis (2,) alone, by Newton steps, to the bottom of a valley."""
    for _ in range(3):
        stiffness = axis @ tilt_stiffness(pose) @ axis
        if stiffness <= 0.0:
            break
        turn = float(np.clip(axis @ pose.torque / stiffness, -_STRIDE, _STRIDE))
        pose = tilt(pose, turn * axis)
        if abs(turn) < 0.01 * _STRIDE:
            break
    return pose


def _angle_between(one: FloatingPose, two: FloatingPose) -> float:
    """Angle between the verticals of two poses, each seen from the vessel [rad]."""
    chord = float(np.linalg.norm(one.rotation[2] - two.rotation[2]))
    return 2.0 * math.asin(min(1.0, 0.5 * chord))

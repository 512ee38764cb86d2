"""Which rest poses of a vessel are one: a ball that rolls from one to the other climbs nothing."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.statics.balance import find_heave_balance, tilt, tilt_stiffness
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.lows import turn_upright

LEAST_RISE = 1e-5
"""Rise of energy, over weight times radius, that parts two rest poses.

Facets of a ball are 7e-6 high, those of a cylinder with 24 sides 2e-6."""
_SAME = 1e-4
"""Angle between two poses below which they are one [rad]."""
_NEARBY = math.pi / 4.0
"""Angle between two poses up to which a way between them is sought [rad]."""
_STRIDE = 0.03
"""Stride of the look at that way [rad]."""


def group_poses(poses: Sequence[FloatingPose]) -> NDArray[np.int64]:
    """Group rest poses that differ by heading alone, or by a roll that nothing resists.

    Two poses are one if the way from the higher to the lower rises by less than `LEAST_RISE`, or if
    they are so with others between them: round a log, or all over a ball.

    Args:
        poses: rest poses of one vessel (n).

    Returns:
        The number of the group of each (n,).
    """
    ups = np.array([pose.rotation[2] for pose in poses])
    crosses = np.linalg.norm(np.cross(ups[:, None], ups), axis=2)
    angles = np.arctan2(crosses, ups @ ups.T)

    # the nearest first, whose way is the shortest
    groups = np.arange(len(poses))
    ones, others = np.triu_indices(len(poses), 1)
    order = np.argsort(angles[ones, others], kind="stable")
    for i, j in zip(ones[order], others[order], strict=True):
        if angles[i, j] > _NEARBY:
            break
        if groups[i] == groups[j]:
            continue
        if angles[i, j] <= _SAME or _is_level_between(poses[i], poses[j], angles[i, j]):
            groups[groups == groups[j]] = groups[i]
    return groups


def _is_level_between(one: FloatingPose, two: FloatingPose, angle: float) -> bool:
    """Whether the way between two poses, `angle` apart [rad], rises over neither of them."""
    vessel = one.vessel
    highest = max(one.energy, two.energy) + LEAST_RISE * vessel.weight * vessel.radius
    start, end = one.rotation[2], two.rotation[2]
    towards = (end - start * math.cos(angle)) / math.sin(angle)

    # along the great circle from one vertical to the other, the middle first
    parts = np.linspace(0.0, angle, math.ceil(angle / _STRIDE) + 2)[1:-1]
    for part in parts[np.argsort(np.abs(parts - 0.5 * angle), kind="stable")]:
        up = start * math.cos(part) + towards * math.sin(part)
        along = towards * math.cos(part) - start * math.sin(part)
        pose = find_heave_balance(vessel, turn_upright(up, along), float(one.position[2]))
        if _descend_across(pose, highest).energy > highest:
            return False
    return True


def _descend_across(pose: FloatingPose, highest: float) -> FloatingPose:
    """Descend square to a way along x, by Newton steps, until the energy is below `highest` [J]."""
    for _ in range(3):
        stiffness = tilt_stiffness(pose)[0, 0]
        if pose.energy <= highest or stiffness <= 0.0:
            break
        turn = np.clip(pose.torque[0] / stiffness, -_STRIDE, _STRIDE)
        pose = tilt(pose, np.array([turn, 0.0]))
    return pose

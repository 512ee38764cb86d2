"""Whether two rest poses of a vessel are one: they differ by heading, or by a free roll alone."""

import math
from collections.abc import Iterator

import numpy as np

from buoyancy_mj.statics.balance import SEARCH_ANGLE, tilt, tilt_stiffness
from buoyancy_mj.statics.floating_pose import FloatingPose

_SAME_ENERGY = 1e-6
"""Difference of energy over weight times radius of poses that count as level with each other."""
_SOFT = 1e-2
"""Stiffness, over that of the other axis or over weight times radius, that resists no roll."""


def is_same_pose(one: FloatingPose, two: FloatingPose) -> bool:
    """Whether two rest poses differ by heading alone, or by a roll without resistance, as a log."""
    scale = one.vessel.weight * one.vessel.radius
    level = _SAME_ENERGY * scale
    if abs(one.energy - two.energy) > level:
        return False
    if _angle_between(one, two) < 1e-4:
        return True

    # a ball rolls every way, a log one way
    soft, stiff = np.linalg.eigvalsh(tilt_stiffness(one))
    if stiff < _SOFT * scale:
        return True
    if soft >= _SOFT * stiff:
        return False
    return any(
        abs(pose.energy - one.energy) <= level and _angle_between(pose, two) <= SEARCH_ANGLE
        for direction in (1.0, -1.0)
        for pose in _roll_along_valley(one, direction)
    )


def _roll_along_valley(pose: FloatingPose, direction: float) -> Iterator[FloatingPose]:
    """Roll about the softest axis, the stiff one kept in balance, once round or until it rises."""
    highest = pose.energy + _SAME_ENERGY * pose.vessel.weight * pose.vessel.radius
    axis = direction * np.linalg.eigh(tilt_stiffness(pose))[1][:, 0]
    for _ in range(math.ceil(2.0 * math.pi / SEARCH_ANGLE)):
        pose = tilt(pose, SEARCH_ANGLE * axis)

        # back to the bottom of the valley, by two Newton steps across it
        for _ in range(2):
            values, axes = np.linalg.eigh(tilt_stiffness(pose))
            across = axes[:, 1]
            if values[1] > 0.0:
                pose = tilt(pose, across * (across @ pose.torque / values[1]))

        # onward, not back
        axis = axes[:, 0] * np.copysign(1.0, axes[:, 0] @ axis)
        yield pose
        if pose.energy > highest:
            return


def _angle_between(one: FloatingPose, two: FloatingPose) -> float:
    """Angle between the verticals of two poses, each seen from the vessel [rad]."""
    a, b = one.rotation[2], two.rotation[2]
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))

"""Units of what actuators, joints and tendons do: of positions, velocities and forces."""

from typing import NamedTuple

import mujoco

_ROTARY = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_BALL))
_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))


class Units(NamedTuple):
    """Units of one coordinate."""

    position: str
    """Of the coordinate."""
    velocity: str
    """Of its rate."""
    force: str
    """Of the generalized force along it."""


LINEAR = Units("m", "m/s", "N")
ANGULAR = Units("rad", "rad/s", "N m")


def joint_units(model: mujoco.MjModel, joint: int) -> Units:
    """Of a joint: angular for hinges and balls."""
    return ANGULAR if model.jnt_type[joint] in _ROTARY else LINEAR


def tendon_units(model: mujoco.MjModel, tendon: int) -> Units:
    """Of a tendon: those of the first joint of a fixed one, which is a sum over joints."""
    first = int(model.tendon_adr[tendon])
    if model.wrap_type[first] == mujoco.mjtWrap.mjWRAP_JOINT:
        return joint_units(model, int(model.wrap_objid[first]))
    return LINEAR


def transmission_units(model: mujoco.MjModel, actuator: int) -> Units:
    """Of what an actuator moves; at a site, of the force unless its gear has a torque alone."""
    kind, target = model.actuator_trntype[actuator], int(model.actuator_trnid[actuator, 0])
    if kind in _JOINTS:
        return joint_units(model, target)
    if kind == mujoco.mjtTrn.mjTRN_TENDON:
        return tendon_units(model, target)
    if kind == mujoco.mjtTrn.mjTRN_SO3:
        return ANGULAR
    gear = model.actuator_gear[actuator]
    if kind == mujoco.mjtTrn.mjTRN_SITE and gear[3:].any() and not gear[:3].any():
        return ANGULAR
    return LINEAR

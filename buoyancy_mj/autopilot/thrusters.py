"""`Thruster`: how each thruster of a vehicle pushes and turns it, as its autopilot sees it."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.autopilot.imu import HALF_TURN, find_imu, imu_pose
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.vehicle.drives import find_pushing
from buoyancy_mj.vehicle.instruments.channels import actuator_name

_JOINTS = (mujoco.mjtTrn.mjTRN_JOINT, mujoco.mjtTrn.mjTRN_JOINTINPARENT)


class Thruster(NamedTuple):
    """An actuator that pushes at a site."""

    actuator: int
    """Index of the actuator."""
    name: str
    """Its name, without that of the vehicle."""
    push: NDArray[np.float64]
    """Direction of a positive push (3,), a unit vector, FRD."""
    turn: NDArray[np.float64]
    """Turns that a push brings about (3,) [m], about the centre of gravity, FRD."""


def find_actuators(model: mujoco.MjModel, vehicle: Vehicle) -> dict[str, int]:
    """The actuators of a vehicle that have one control, by name, without that of the vehicle."""
    own = {}
    for actuator in np.flatnonzero(model.actuator_ctrlnum == 1).tolist():
        prefix, _, short = actuator_name(model, actuator).rpartition("/")
        body = _find_body(model, actuator)
        if body in vehicle.bodies or (body is None and prefix in ("", vehicle.name)):
            own[short] = actuator
    return own


def find_thrusters(model: mujoco.MjModel, data: mujoco.MjData, vehicle: Vehicle) -> list[Thruster]:
    """The thrusters of a vehicle: its actuators that push at a site.

    Args:
        model: the model.
        data: poses of the vehicle, after mj_kinematics.
        vehicle: the vehicle.
    """
    centre = vehicle.centre_of_mass(data)
    _, rotation = imu_pose(data, *find_imu(model, vehicle))
    imu_from_world = rotation.reshape(3, 3).T
    thrusters = []
    pushing = find_pushing(model)
    for name, actuator in find_actuators(model, vehicle).items():
        gear = model.actuator_gear[actuator, :3]
        if actuator not in pushing or not gear.any():
            continue

        # the site's axis and arm, in the axes of the autopilot
        site = int(model.actuator_trnid[actuator, 0])
        axis = data.site_xmat[site].reshape(3, 3) @ gear / np.linalg.norm(gear)
        push = imu_from_world @ axis * HALF_TURN
        arm = imu_from_world @ (data.site_xpos[site] - centre) * HALF_TURN
        thrusters.append(Thruster(actuator, name, push, np.cross(arm, push)))
    return thrusters


def scale_turns(thrusters: Sequence[Thruster]) -> NDArray[np.float64]:
    """Turns (n, 3) of thrusters, each over the greatest about its axis."""
    turns = np.array([thruster.turn for thruster in thrusters]).reshape(-1, 3)
    greatest = np.abs(turns).max(axis=0, initial=0.0)
    scaled: NDArray[np.float64] = turns / np.where(greatest > 0.0, greatest, 1.0)
    return scaled


def _find_body(model: mujoco.MjModel, actuator: int) -> int | None:
    """The body on which an actuator acts; None if it is not one alone."""
    kind, index = model.actuator_trntype[actuator], int(model.actuator_trnid[actuator, 0])
    if kind == mujoco.mjtTrn.mjTRN_SITE:
        return int(model.site_bodyid[index])
    if kind == mujoco.mjtTrn.mjTRN_BODY:
        return index
    return int(model.jnt_bodyid[index]) if kind in _JOINTS else None

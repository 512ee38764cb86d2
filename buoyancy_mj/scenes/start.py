"""The state of a scene at time 0: each vehicle at its start, or at rest on still water."""

import dataclasses
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np
import scipy

from buoyancy_mj.errors import BuoyancyWarning, SceneError, choices
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.tethers import list_roots
from buoyancy_mj.scenes.parts import Part
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.scene_vehicle import ENVIRONMENT, Start
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.equilibrium import find_equilibrium


def place_vehicle(model: mujoco.MjModel, data: mujoco.MjData, part: Part) -> None:
    """Set the state of a vehicle at time 0.

    The first free body takes the pose of the start, and takes the others along as if all were one
    rigid body.

    Args:
        model: a model that holds the vehicle.
        data: receives the state.
        part: what came from the vehicle's file, and its start.

    Raises:
        SceneError: the start names a keyframe that does not exist.
    """
    start = part.entry.start
    if start.keyframe is not None:
        _take_keyframe(model, data, part, start.keyframe)
    free = [
        joint
        for joint in np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE).tolist()
        if model.jnt_bodyid[joint] in part.bodies
    ]
    if not free:
        if dataclasses.replace(start, keyframe=None) != Start():
            warnings.warn(
                f"{part.subject} hangs on joints of its own and has no free one; the position, "
                "attitude and velocity of the start were not applied",
                BuoyancyWarning,
                stacklevel=4,
            )
        return

    # the motion of the first body, which the others share
    poses = [data.qpos[model.jnt_qposadr[joint] :][:7].copy() for joint in free]
    Rotation = scipy.spatial.transform.Rotation
    attitude = Rotation.from_euler("ZYX", [start.yaw, start.pitch, start.roll])
    turn = attitude * Rotation.from_quat(poses[0][3:], scalar_first=True).inv()
    spin = attitude.apply(start.angular_velocity)

    # each body, by its arm from the first
    for joint, pose in zip(free, poses, strict=True):
        q = model.jnt_qposadr[joint]
        v = model.jnt_dofadr[joint]
        arm = turn.apply(pose[:3] - poses[0][:3])
        turned = turn * Rotation.from_quat(pose[3:], scalar_first=True)
        data.qpos[q : q + 3] = start.position + arm
        data.qpos[q + 3 : q + 7] = turned.as_quat(scalar_first=True)
        data.qvel[v : v + 3] = start.velocity + np.cross(spin, arm)
        data.qvel[v + 3 : v + 6] = turned.inv().apply(spin)


def settle_vehicle(
    model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, bodies: Sequence[int]
) -> None:
    """Bring each vessel of a vehicle, whose bodies these are, to rest on still water.

    What welds and connects hold together moves as one.
    """
    hulls = find_hulls(model, scene.selection)
    with_hulls = [hull.body for hull in hulls if hull.body in bodies]
    for group in group_floating_bodies(model):
        if not np.isin(group, with_hulls).any():
            continue
        root = body_name(model, list_roots(model, group)[0])
        vessel = build_vessel_from_hulls(
            model, hulls, scene.water, data.qpos, body=root, ballast=data.act
        )
        data.qpos[:] = find_equilibrium(vessel).qpos


def _take_keyframe(model: mujoco.MjModel, data: mujoco.MjData, part: Part, keyframe: str) -> None:
    """Take the joints, controls and mocap bodies of a vehicle from one of its keyframes."""
    names = {str(model.key(i).name): i for i in range(model.nkey)}
    own = {
        name.removeprefix(part.prefix): key
        for name, key in names.items()
        if name.startswith(part.prefix) and not name.startswith(f"{ENVIRONMENT}/")
    }
    if keyframe not in own:
        raise SceneError(
            f"start: {part.subject} has no keyframe '{keyframe}'; {choices(keyframe, own)}"
        )
    key = own[keyframe]

    # joints
    is_own_joint = np.isin(model.jnt_bodyid, part.bodies)
    sizes = np.diff(np.append(model.jnt_qposadr, model.nq))
    is_own_qpos = np.repeat(is_own_joint, sizes)
    is_own_dof = np.isin(model.dof_bodyid, part.bodies)
    data.qpos[is_own_qpos] = model.key_qpos[key, is_own_qpos]
    data.qvel[is_own_dof] = model.key_qvel[key, is_own_dof]

    # controls
    is_own_actuator = np.isin(np.arange(model.nu), part.actuators)
    is_own_act = np.repeat(is_own_actuator, model.actuator_actnum)
    data.ctrl[is_own_actuator] = model.key_ctrl[key, is_own_actuator]
    data.act[is_own_act] = model.key_act[key, is_own_act]

    # mocap bodies
    mocap = model.body_mocapid[part.bodies]
    own_mocap = mocap[mocap >= 0]
    data.mocap_pos[own_mocap] = model.key_mpos[key].reshape(-1, 3)[own_mocap]
    data.mocap_quat[own_mocap] = model.key_mquat[key].reshape(-1, 4)[own_mocap]

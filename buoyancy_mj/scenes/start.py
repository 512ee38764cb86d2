"""The state of a scene at time 0: the vehicle at its start, or at rest on still water."""

import dataclasses
import warnings

import mujoco
import numpy as np
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import BuoyancyWarning, SceneError, choices
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.tethers import list_roots
from buoyancy_mj.scenes.scene import Scene, Start
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.equilibrium import find_equilibrium


def place_vehicle(model: mujoco.MjModel, data: mujoco.MjData, start: Start, bodies: int) -> None:
    """Set the state of the vehicle at time 0.

    The first free body takes the pose of the start, and takes the others along as if all were one
    rigid body.

    Args:
        model: a model whose first `bodies` bodies are the world and the vehicle.
        data: receives the state.
        start: pose and velocity of the vehicle.
        bodies: how many.

    Raises:
        SceneError: the start names a keyframe that does not exist.
    """
    if start.keyframe is not None:
        _reset_to_keyframe(model, data, start.keyframe)
    free = np.flatnonzero(
        (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE) & (model.jnt_bodyid < bodies)
    )
    if not len(free):
        if dataclasses.replace(start, keyframe=None) != Start():
            warnings.warn(
                "the vehicle hangs on joints of its own and has no free one; the position, "
                "attitude and velocity of the start were not applied",
                BuoyancyWarning,
                stacklevel=4,
            )
        return

    # the motion of the first body, which the others share
    poses = [data.qpos[model.jnt_qposadr[joint] :][:7].copy() for joint in free]
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


def settle_vehicle(model: mujoco.MjModel, data: mujoco.MjData, scene: Scene, bodies: int) -> None:
    """Bring each vessel of the vehicle, the first `bodies` of the model, to rest.

    What welds and connects hold together moves as one.
    """
    with_hulls = [hull.body for hull in find_hulls(model, scene.selection, range(1, bodies))]
    for group in group_floating_bodies(model):
        if not np.isin(group, with_hulls).any():
            continue
        root = body_name(model, list_roots(model, group)[0])
        vessel = build_vessel(model, scene.water, data.qpos, body=root, selection=scene.selection)
        data.qpos[:] = find_equilibrium(vessel).qpos


def _reset_to_keyframe(model: mujoco.MjModel, data: mujoco.MjData, keyframe: str) -> None:
    """Take joints and controls from a keyframe of the vehicle."""
    names = [model.key(i).name for i in range(model.nkey)]
    if keyframe not in names:
        raise SceneError(
            f"start: the vehicle has no keyframe '{keyframe}'; {choices(keyframe, names)}"
        )
    mujoco.mj_resetDataKeyframe(model, data, names.index(keyframe))
    data.time = 0.0

"""How the vehicles of a run move and what the water does to them, as messages."""

from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np

from buoyancy_mj.hulls.bodies import find_mocap_bodies, find_moving_bodies
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.viz.ros import messages as ros
from buoyancy_mj.viz.ros.names import body_frame, site_frame, topic

Message = tuple[str, str, Any]
"""A topic, the type of its messages, and one of them."""
_SLIDING = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))


class Motion:
    """Poses, velocities, joints and loads of the vehicles of a run.

    Args:
        run: the run.
    """

    def __init__(self, run: Run) -> None:
        self._model = model = run.model
        self._vehicles = run.vehicles
        moving = find_moving_bodies(model) | find_mocap_bodies(model)
        self._moving = np.flatnonzero(moving).tolist()
        kinds = model.jnt_type
        self._joints = {
            name: [
                joint
                for joint in np.flatnonzero(np.isin(kinds, _SLIDING)).tolist()
                if model.jnt_bodyid[joint] in vehicle.bodies
            ]
            for name, vehicle in run.vehicles.items()
        }

    def fixed(self) -> Message:
        """Where each site of a moving body lies in it, which never changes."""
        model = self._model
        transforms = [
            ros.transform(
                0.0,
                body_frame(model, int(model.site_bodyid[site])),
                site_frame(model, site),
                model.site_pos[site],
                model.site_quat[site],
            )
            for site in range(model.nsite)
            if self._moves(site)
        ]
        name = "tf2_msgs/msg/TFMessage"
        return "/tf_static", name, ros.make(name, transforms)

    def at(self, frame: Frame) -> Iterator[Message]:
        """All messages of a frame."""
        time, data = frame.time, frame.data
        yield (
            "/clock",
            "rosgraph_msgs/msg/Clock",
            ros.make("rosgraph_msgs/msg/Clock", ros.stamp(time)),
        )
        transforms = [
            ros.transform(
                time, ros.WORLD, body_frame(self._model, body), data.xpos[body], data.xquat[body]
            )
            for body in self._moving
        ]
        name = "tf2_msgs/msg/TFMessage"
        yield "/tf", name, ros.make(name, transforms)
        for vehicle in self._vehicles.values():
            yield from self._of_vehicle(vehicle, frame)

    def _of_vehicle(self, vehicle: Vehicle, frame: Frame) -> Iterator[Message]:
        """How one vehicle moves."""
        model, data, root = self._model, frame.data, vehicle.root
        place = ros.pose(data.xpos[root], data.xquat[root])
        name = "geometry_msgs/msg/PoseStamped"
        head = ros.header(frame.time)
        yield topic(vehicle.name, "pose"), name, ros.make(name, head, place)

        # velocities are those of the body's origin, in its own axes
        motion = np.empty(6)
        kind = int(mujoco.mjtObj.mjOBJ_XBODY)
        mujoco.mj_objectVelocity(model, data, kind, root, motion, 1)
        turns, moves = ros.vector(motion[:3]), ros.vector(motion[3:])
        twist = ros.make("geometry_msgs/msg/Twist", moves, turns)
        name = "nav_msgs/msg/Odometry"
        yield (
            topic(vehicle.name, "odom"),
            name,
            ros.make(
                name,
                head,
                body_frame(model, root),
                ros.make("geometry_msgs/msg/PoseWithCovariance", place, ros.unknown(36)),
                ros.make("geometry_msgs/msg/TwistWithCovariance", twist, ros.unknown(36)),
            ),
        )
        yield from self._of_joints(vehicle, frame)
        yield from self._of_loads(vehicle, frame)

    def _of_joints(self, vehicle: Vehicle, frame: Frame) -> Iterator[Message]:
        """Positions, velocities and efforts of hinges and slides, if there are any."""
        model, data, joints = self._model, frame.data, self._joints[vehicle.name]
        if not joints:
            return
        dofs = model.jnt_dofadr[joints]
        name = "sensor_msgs/msg/JointState"
        yield (
            topic(vehicle.name, "joint_states"),
            name,
            ros.make(
                name,
                ros.header(frame.time, ""),
                [str(model.joint(joint).name) or f"joint {joint}" for joint in joints],
                data.qpos[model.jnt_qposadr[joints]],
                data.qvel[dofs],
                data.qfrc_actuator[dofs],
            ),
        )

    def _of_loads(self, vehicle: Vehicle, frame: Frame) -> Iterator[Message]:
        """The sum of each load on the vehicle, about the origin of its root and in its axes."""
        data, root = frame.data, vehicle.root
        root_from_world = data.xmat[root].reshape(3, 3).T
        arms = data.xipos[vehicle.bodies] - data.xpos[root]
        name = "geometry_msgs/msg/WrenchStamped"
        head = ros.header(frame.time, body_frame(self._model, root))
        for cause, rows in frame.loads.by_cause.items():
            forces, torques = rows[vehicle.bodies, :3], rows[vehicle.bodies, 3:]
            torque = torques.sum(axis=0) + np.cross(arms, forces).sum(axis=0)
            wrench = ros.make(
                "geometry_msgs/msg/Wrench",
                ros.vector(root_from_world @ forces.sum(axis=0)),
                ros.vector(root_from_world @ torque),
            )
            yield topic(vehicle.name, "loads", cause), name, ros.make(name, head, wrench)

    def _moves(self, site: int) -> bool:
        """Whether a site is on a body that has a frame of its own."""
        return int(self._model.site_bodyid[site]) in self._moving

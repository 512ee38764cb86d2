"""`Readings`: what an autopilot senses of its vehicle, in the frames of aviation."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.autopilot.battery import Battery
from buoyancy_mj.autopilot.imu import HALF_TURN, find_imu, imu_pose
from buoyancy_mj.engine.instances import plugin_name
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.simulation import Simulation

FAR = 1.0e4
"""What a range finder tells where it meets nothing [m]: beyond the range of any."""
ALTIMETER = "buoyancy_mj.altimeter"
"""Plugin of the altimeters, which are range finders too."""
BATTERY_EVERY = 8
"""Number of readings for one of the battery."""
RANGE_FINDERS = 6
"""The most range finders that the JSON interface knows."""


class Reading(NamedTuple):
    """What an autopilot senses at one instant; plain numbers, as JSON has them."""

    time: float
    """Simulated time [s]."""
    gyro: tuple[float, ...]
    """Angular velocity (3,) [rad/s], FRD."""
    specific_force: tuple[float, ...]
    """Acceleration less gravity (3,) [m/s^2], FRD: (0, 0, -9.81) at rest, 0 in free fall."""
    position: tuple[float, ...]
    """Place (3,) [m], NED, from the world's origin at the still level."""
    attitude: tuple[float, ...]
    """Unit quaternion (4,), w first, that turns FRD into NED."""
    velocity: tuple[float, ...]
    """Velocity (3,) [m/s], NED."""
    distances: tuple[float, ...] = ()
    """What each range finder tells [m], up to six."""
    battery: tuple[float, float] | None = None
    """Voltage [V] and current [A] of the battery, if the vehicle knows them."""


class Readings:
    """Reads what the autopilot of a vehicle senses.

    Its frame is that of the vehicle's site `imu`, or of its root body where there is none. All that
    is sensed belongs to that one place: it is where the accelerometer is, and its position and
    velocity are told. Range finders are MuJoCo's, and altimeters, in the order of the model.

    Pose, velocity and angular velocity are those at the end of a step. The specific force is the
    engine's accelerometer in the steps since the last reading, on average: summed over time it
    gives the change of velocity, as an inertial navigation sums it, and costs no second evaluation
    of the water.

    Args:
        simulation: the run.
        vehicle: which of its vehicles.
    """

    def __init__(self, simulation: Simulation, vehicle: Vehicle) -> None:
        self._model = model = simulation.model
        self._source = simulation.data
        self._level = simulation.scene.water.level
        self._data = mujoco.MjData(model)
        self._kind, self._object = find_imu(model, vehicle)
        self._motion = np.empty(6)
        self._felt = np.zeros(3)
        self._steps = 0
        self._finders = _find_range_finders(model, vehicle)
        self._battery = Battery(model, vehicle)
        self._drawn: tuple[float, float] | None = None
        self._reads = 0

    def feel(self) -> None:
        """Take the specific force of the step that was just made."""
        model, data = self._model, self._source
        mujoco.mj_rnePostConstraint(model, data)
        # the engine counts gravity as an acceleration upwards, as an accelerometer does
        mujoco.mj_objectAcceleration(model, data, self._kind, self._object, self._motion, 1)
        self._felt += self._motion[3:]
        self._steps += 1

    def read(self) -> Reading:
        """What is sensed now; `feel` has been called for each step since the last reading."""
        model, data, motion = self._model, self._data, self._motion

        # a step leaves the poses and velocities of its beginning
        data.time = self._source.time
        data.qpos[:] = self._source.qpos
        data.qvel[:] = self._source.qvel
        data.mocap_pos[:] = self._source.mocap_pos
        data.mocap_quat[:] = self._source.mocap_quat
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        if len(self._finders):
            mujoco.mj_sensorPos(model, data)

        # where the autopilot is, how it lies, how it moves
        place, rotation = imu_pose(data, self._kind, self._object)
        quaternion = np.empty(4)
        mujoco.mju_mat2Quat(quaternion, rotation)
        mujoco.mj_objectVelocity(model, data, self._kind, self._object, motion, 1)
        velocity = rotation.reshape(3, 3) @ motion[3:]
        felt = self._felt / self._steps
        self._felt[:] = 0.0
        self._steps = 0

        # a battery is measured less often
        if self._reads % BATTERY_EVERY == 0:
            self._drawn = self._battery.read(self._source)
        self._reads += 1

        # in the frames of aviation
        position = place * HALF_TURN
        position[2] += self._level
        quaternion[2:] *= -1.0
        return Reading(
            time=float(data.time),
            gyro=_plain(motion[:3] * HALF_TURN),
            specific_force=_plain(felt * HALF_TURN),
            position=_plain(position),
            attitude=_plain(quaternion),
            velocity=_plain(velocity * HALF_TURN),
            distances=tuple(
                d if d >= 0.0 else FAR for d in data.sensordata[self._finders].tolist()
            ),
            battery=self._drawn,
        )


def _plain(numbers: NDArray[np.float64]) -> tuple[float, ...]:
    """Numbers (n,) of Python, whose text is JSON."""
    return tuple(numbers.tolist())


def _find_range_finders(model: mujoco.MjModel, vehicle: Vehicle) -> NDArray[np.int64]:
    """Addresses (n,) of the values of a vehicle's range finders, n at most six."""
    own = [
        int(model.sensor_adr[i])
        for i in range(model.nsensor)
        if _finds_range(model, i)
        and model.sensor_objtype[i] == mujoco.mjtObj.mjOBJ_SITE
        and model.site_bodyid[model.sensor_objid[i]] in vehicle.bodies
    ]
    return np.array(own[:RANGE_FINDERS], dtype=np.int64)


def _finds_range(model: mujoco.MjModel, sensor: int) -> bool:
    """Whether the first number of a sensor is a distance along a ray."""
    kind, instance = model.sensor_type[sensor], int(model.sensor_plugin[sensor])
    if kind == mujoco.mjtSensor.mjSENS_RANGEFINDER:
        return bool(model.sensor_intprm[sensor, 0] & 1)
    return instance >= 0 and plugin_name(model, instance) == ALTIMETER

"""The sensors of a run as messages: of a type of their own where ROS 2 has one."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.instances import plugin_name
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.vehicle.instruments.channels import sensor_name
from buoyancy_mj.viz.ros import messages as ros
from buoyancy_mj.viz.ros.motion import Message
from buoyancy_mj.viz.ros.names import body_frame, site_frame, topic

_SENSOR = mujoco.mjtSensor
_SITE = int(mujoco.mjtObj.mjOBJ_SITE)
_NO_ORIENTATION = np.array([-1.0] + 8 * [0.0])
"""The covariance by which an IMU says that it knows no orientation (sensor_msgs/Imu)."""
_FARTHEST = float("inf")

Write = Callable[[Any, NDArray[np.float64]], Any]
"""From a header and the numbers of a sensor to a message."""


class Kind(NamedTuple):
    """How the numbers of a sensor become messages."""

    name: str
    """Type of the messages."""
    write: Write
    """Makes one."""


def _stamped(name: str, write: Callable[[NDArray[np.float64]], Any]) -> Kind:
    """A type that has a header and one field."""
    return Kind(name, lambda head, numbers: ros.make(name, head, write(numbers)))


def _write_pressure(head: Any, numbers: NDArray[np.float64]) -> Any:
    return ros.make("sensor_msgs/msg/FluidPressure", head, float(numbers[0]), 0.0)


def _write_range(head: Any, numbers: NDArray[np.float64]) -> Any:
    distance = ros.far(float(numbers[0]))
    # its kind is ultrasound; a single ray has no width, and its least and greatest range are open
    return ros.make("sensor_msgs/msg/Range", head, 0, 0.0, 0.0, _FARTHEST, distance, 0.0)


def _write_magnetic_field(head: Any, numbers: NDArray[np.float64]) -> Any:
    return ros.make("sensor_msgs/msg/MagneticField", head, ros.vector(numbers), ros.unknown(9))


def _write_twist(head: Any, numbers: NDArray[np.float64]) -> Any:
    twist = ros.make("geometry_msgs/msg/Twist", ros.vector(numbers[:3]), ros.vector(np.zeros(3)))
    return ros.make("geometry_msgs/msg/TwistStamped", head, twist)


def _write_numbers(_: Any, numbers: NDArray[np.float64]) -> Any:
    layout = ros.make("std_msgs/msg/MultiArrayLayout", [], 0)
    return ros.make("std_msgs/msg/Float64MultiArray", layout, np.array(numbers))


_VECTOR = _stamped("geometry_msgs/msg/Vector3Stamped", ros.vector)
_QUATERNION = _stamped("geometry_msgs/msg/QuaternionStamped", ros.quaternion)
_POINT = _stamped("geometry_msgs/msg/PointStamped", ros.point)
_RANGE = Kind("sensor_msgs/msg/Range", _write_range)
_NUMBER = Kind(
    "std_msgs/msg/Float64", lambda _, numbers: ros.make("std_msgs/msg/Float64", float(numbers[0]))
)
_NUMBERS = Kind("std_msgs/msg/Float64MultiArray", _write_numbers)
_BY_PLUGIN: Mapping[str, Kind] = {
    "buoyancy_mj.pressure": Kind("sensor_msgs/msg/FluidPressure", _write_pressure),
    "buoyancy_mj.altimeter": _RANGE,
    "buoyancy_mj.dvl": Kind("geometry_msgs/msg/TwistStamped", _write_twist),
}
"""Types for the sensors of this package."""
_BY_TYPE: Mapping[mujoco.mjtSensor, Kind] = {
    _SENSOR.mjSENS_MAGNETOMETER: Kind("sensor_msgs/msg/MagneticField", _write_magnetic_field),
    _SENSOR.mjSENS_FRAMEPOS: _POINT,
    _SENSOR.mjSENS_SUBTREECOM: _POINT,
    _SENSOR.mjSENS_FRAMEQUAT: _QUATERNION,
    _SENSOR.mjSENS_BALLQUAT: _QUATERNION,
}
"""Types for sensors of the engine; others go by how many numbers they have."""
_IN_WORLD = (_SENSOR.mjSENS_FRAMEPOS, _SENSOR.mjSENS_FRAMEQUAT, _SENSOR.mjSENS_SUBTREECOM)
"""Sensors whose numbers are in the frame of the world, unless they refer to another object."""


class Reader(NamedTuple):
    """A sensor and how it is told."""

    topic: str
    """Topic of its messages."""
    kind: Kind
    """How they are made."""
    frame: str
    """Frame of its numbers."""
    numbers: slice
    """Its numbers in `sensordata`."""


class Imu(NamedTuple):
    """The sensors at one site that are an IMU together."""

    topic: str
    """Topic of its messages."""
    frame: str
    """Frame of its numbers."""
    accelerometer: slice
    """Specific force in `sensordata`."""
    gyro: slice
    """Angular velocity in `sensordata`."""
    attitude: slice | None
    """Quaternion in `sensordata`, if the site has one."""


class Sensors:
    """All sensors of a run.

    An accelerometer and a gyro at one site are told as one `sensor_msgs/Imu`, with the attitude of
    the site if a sensor has it; the topic is that of the site.

    Args:
        run: the run.
    """

    def __init__(self, run: Run) -> None:
        self._model = model = run.model
        self._owners = {
            int(body): name for name, vehicle in run.vehicles.items() for body in vehicle.bodies
        }
        self._topics: set[str] = set()
        self._imus = [imu for site in range(model.nsite) if (imu := self._find_imu(site))]
        taken = {part.start for imu in self._imus for part in imu[2:] if part is not None}
        self._readers = [
            self._make_reader(sensor)
            for sensor in range(model.nsensor)
            if model.sensor_adr[sensor] not in taken
        ]

    def at(self, frame: Frame) -> Iterator[Message]:
        """All messages of a frame."""
        numbers = frame.data.sensordata
        for imu in self._imus:
            name = "sensor_msgs/msg/Imu"
            has_attitude = imu.attitude is not None
            attitude = numbers[imu.attitude] if imu.attitude is not None else [1.0, 0.0, 0.0, 0.0]
            yield (
                imu.topic,
                name,
                ros.make(
                    name,
                    ros.header(frame.time, imu.frame),
                    ros.quaternion(attitude),
                    ros.unknown(9) if has_attitude else _NO_ORIENTATION,
                    ros.vector(numbers[imu.gyro]),
                    ros.unknown(9),
                    ros.vector(numbers[imu.accelerometer]),
                    ros.unknown(9),
                ),
            )
        for reader in self._readers:
            head = ros.header(frame.time, reader.frame)
            message = reader.kind.write(head, numbers[reader.numbers])
            yield reader.topic, reader.kind.name, message

    def _find_imu(self, site: int) -> Imu | None:
        """The IMU at a site, if it has an accelerometer and a gyro."""
        model = self._model
        parts: dict[int, slice] = {}
        for sensor in range(model.nsensor):
            own = model.sensor_objtype[sensor] == _SITE and model.sensor_objid[sensor] == site
            if own and model.sensor_refid[sensor] < 0:
                parts.setdefault(int(model.sensor_type[sensor]), self._slice(sensor))
        accelerometer = parts.get(int(_SENSOR.mjSENS_ACCELEROMETER))
        gyro = parts.get(int(_SENSOR.mjSENS_GYRO))
        if accelerometer is None or gyro is None:
            return None
        name = site_frame(model, site).rsplit("/", 1)[-1]
        owner = self._owners.get(int(model.site_bodyid[site]), "")
        attitude = parts.get(int(_SENSOR.mjSENS_FRAMEQUAT))
        return Imu(self._topic(owner, name), site_frame(model, site), accelerometer, gyro, attitude)

    def _make_reader(self, sensor: int) -> Reader:
        """How one sensor is told."""
        model = self._model
        kind, instance = _SENSOR(int(model.sensor_type[sensor])), int(model.sensor_plugin[sensor])
        target, index = int(model.sensor_objtype[sensor]), int(model.sensor_objid[sensor])
        body = self._find_body(target, index)
        name = sensor_name(model, sensor).rsplit("/", 1)[-1]
        told = _BY_TYPE.get(kind)
        if instance >= 0:
            told = _BY_PLUGIN.get(plugin_name(model, instance))
        elif kind == _SENSOR.mjSENS_RANGEFINDER and model.sensor_intprm[sensor, 0] & 1:
            told = _RANGE
        return Reader(
            topic=self._topic(self._owners.get(body, ""), name),
            kind=told or _kind_by_count(int(model.sensor_dim[sensor])),
            frame=ros.WORLD if kind in _IN_WORLD else self._frame(target, index, body),
            numbers=self._slice(sensor),
        )

    def _topic(self, owner: str, name: str) -> str:
        """A topic that no other sensor has."""
        chosen, number = topic(owner, "sensors", name), 1
        while chosen in self._topics:
            number += 1
            chosen = topic(owner, "sensors", f"{name}_{number}")
        self._topics.add(chosen)
        return chosen

    def _find_body(self, target: int, index: int) -> int:
        """The body that bears what a sensor reads; -1 for none."""
        model, kinds = self._model, mujoco.mjtObj
        if target in (kinds.mjOBJ_BODY, kinds.mjOBJ_XBODY):
            return index
        owners = {
            kinds.mjOBJ_SITE: model.site_bodyid,
            kinds.mjOBJ_GEOM: model.geom_bodyid,
            kinds.mjOBJ_JOINT: model.jnt_bodyid,
            kinds.mjOBJ_CAMERA: model.cam_bodyid,
        }
        found = owners.get(kinds(target))
        return -1 if found is None else int(found[index])

    def _frame(self, target: int, index: int, body: int) -> str:
        """The frame of what a sensor reads."""
        if target == _SITE:
            return site_frame(self._model, index)
        return body_frame(self._model, body) if body > 0 else ros.WORLD

    def _slice(self, sensor: int) -> slice:
        """The numbers of a sensor in `sensordata`."""
        first = int(self._model.sensor_adr[sensor])
        return slice(first, first + int(self._model.sensor_dim[sensor]))


def _kind_by_count(count: int) -> Kind:
    """How so many numbers are told of which no more is known."""
    return {1: _NUMBER, 3: _VECTOR}.get(count, _NUMBERS)

"""Messages of ROS 2 by their names, as the bytes that ROS 2 sends (CDR).

The definitions are those of ROS 2 Jazzy, which `rosbags` carries and serializes. Axes are as REP
103 has them: the world x forward, y to port, z up, as MuJoCo's; units are SI.
"""

import functools
import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from rosbags.typesys import Stores, get_typestore

WORLD = "world"
"""Name of the frame of MuJoCo's world."""
NANO = 1_000_000_000
"""Nanoseconds in a second."""


@functools.cache
def _store() -> Any:
    """The types of ROS 2."""
    return get_typestore(Stores.ROS2_JAZZY)


def make(name: str, *fields: Any, **named: Any) -> Any:
    """A message of a type such as 'geometry_msgs/msg/Point', from its fields in their order."""
    return _store().types[name](*fields, **named)


def encode(name: str, message: Any) -> bytes:
    """A message of a type as CDR."""
    return bytes(_store().serialize_cdr(message, name))


@functools.cache
def define(name: str) -> bytes:
    """The definition of a type and of all that it consists of, as `ros2msg` has them."""
    text: str = _store().generate_msgdef(name, ros_version=2)[0]
    return text.encode()


def to_nanoseconds(time: float) -> int:
    """A time [s] in nanoseconds."""
    return round(time * NANO)


def stamp(time: float) -> Any:
    """A time [s] as a stamp."""
    seconds, nanoseconds = divmod(to_nanoseconds(time), NANO)
    return make("builtin_interfaces/msg/Time", seconds, nanoseconds)


def header(time: float, frame: str = WORLD) -> Any:
    """The header of what holds at a time [s] in a frame."""
    return make("std_msgs/msg/Header", stamp(time), frame)


def vector(numbers: ArrayLike) -> Any:
    """Three numbers as a vector."""
    return make("geometry_msgs/msg/Vector3", *_plain(numbers))


def point(numbers: ArrayLike) -> Any:
    """Three numbers as a point."""
    return make("geometry_msgs/msg/Point", *_plain(numbers))


def quaternion(numbers: ArrayLike) -> Any:
    """A quaternion of MuJoCo, w first, as ROS has it, w last."""
    w, x, y, z = _plain(numbers)
    return make("geometry_msgs/msg/Quaternion", x, y, z, w)


def pose(place: ArrayLike, attitude: ArrayLike) -> Any:
    """A place (3,) [m] and a quaternion (4,), w first."""
    return make("geometry_msgs/msg/Pose", point(place), quaternion(attitude))


def transform(time: float, parent: str, child: str, place: ArrayLike, attitude: ArrayLike) -> Any:
    """Where a frame lies in another at a time [s]."""
    moved = make("geometry_msgs/msg/Transform", vector(place), quaternion(attitude))
    return make("geometry_msgs/msg/TransformStamped", header(time, parent), child, moved)


def colour(rgba: NDArray[np.uint8]) -> Any:
    """A colour (4,) from 0 to 255."""
    return make("std_msgs/msg/ColorRGBA", *(np.asarray(rgba, float) / 255.0).tolist())


def unknown(count: int) -> NDArray[np.float64]:
    """A covariance of so many numbers that nobody knows, which ROS writes as zeros."""
    return np.zeros(count)


def far(distance: float) -> float:
    """What a range finder reads, as REP 117 has it: infinite where nothing was met."""
    return distance if distance >= 0.0 else math.inf


def _plain(numbers: ArrayLike) -> list[float]:
    """Numbers of Python."""
    plain: list[float] = np.asarray(numbers, float).tolist()
    return plain

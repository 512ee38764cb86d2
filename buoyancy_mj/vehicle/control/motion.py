"""`Motion`: where a vehicle is and how it moves, from its state or from its sensors."""

import dataclasses
import math
from collections.abc import Callable
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.devices import kind_of
from buoyancy_mj.errors import ControlError, choices, describe
from buoyancy_mj.vehicle.control.controller import Outset
from buoyancy_mj.vehicle.control.rotations import rotate_quaternion
from buoyancy_mj.vehicle.crafts import Craft


class Motion(NamedTuple):
    """Pose and velocity of the root body of a vehicle."""

    position: NDArray[np.float64]
    """Its origin (3,) [m], world frame."""
    rotation: NDArray[np.float64]
    """world_from_body (3, 3)."""
    velocity: NDArray[np.float64]
    """Velocity of its origin (3,) [m/s], world frame."""
    spin: NDArray[np.float64]
    """Angular velocity (3,) [rad/s], body frame."""

    @property
    def heading(self) -> float:
        """Angle of its x axis about the vertical [rad]."""
        return math.atan2(self.rotation[1, 0], self.rotation[0, 0])


class FreeJoint(NamedTuple):
    """Where the free joint of a vehicle stands in the state."""

    qpos: int
    """Its first coordinate in `data.qpos`, of seven."""
    dof: int
    """Its first degree of freedom in `data.qvel`, of six."""

    def read(self, data: mujoco.MjData) -> Motion:
        """The true motion at the time of the data, as a step leaves it."""
        pose, velocity = data.qpos[self.qpos :][:7], data.qvel[self.dof :][:6]
        rotation = rotate_quaternion(pose[3:])
        return Motion(pose[:3].copy(), rotation, velocity[:3].copy(), velocity[3:].copy())


def find_free_joint(model: mujoco.MjModel, craft: Craft) -> FreeJoint:
    """Find the free joint of a vehicle's root body.

    Raises:
        ControlError: it moves on other joints.
    """
    joint = int(model.body_jntadr[craft.root])
    if joint < 0 or model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_FREE:
        raise ControlError(
            f"body '{craft.name}' moves on no free joint; this controller steers what moves "
            "freely, so give it a <freejoint/>"
        )
    return FreeJoint(int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint]))


@dataclasses.dataclass(frozen=True, kw_only=True)
class ControlSensors:
    """Names of the sensors that a controller reads in the place of the true state.

    They stand at sites of the vehicle's root body, and are read one step old, as the engine leaves
    them. What none measures is taken from the true state.
    """

    attitude: str | None = None
    """A framequat."""
    gyro: str | None = None
    """A gyro."""
    position: str | None = None
    """A framepos."""
    depth: str | None = None
    """A depth gauge (buoyancy_mj.depth), which best goes by the still surface; or a framepos, whose
    z is read."""
    velocity: str | None = None
    """A velocimeter, a velocity log (buoyancy_mj.dvl) or a framelinvel."""


KINDS = {
    "attitude": ("framequat",),
    "gyro": ("gyro",),
    "position": ("framepos",),
    "depth": ("buoyancy_mj.depth", "framepos"),
    "velocity": ("velocimeter", "buoyancy_mj.dvl", "framelinvel"),
}
"""Kinds of sensors that may be read: MuJoCo's by their name in MJCF, and plugins."""
_SIZES = {"framequat": 4, "buoyancy_mj.depth": 1}
"""How many numbers are read of a sensor, where it is not three."""


class Reader:
    """Reads the motion of a vehicle.

    Args:
        outset: the vehicle in its model.
        sensors: what to read in the place of the true state.

    Raises:
        ControlError: the vehicle has no free joint, or a sensor is not there, of another size, or
            elsewhere than on the root body.
    """

    def __init__(self, outset: Outset, sensors: ControlSensors | None = None) -> None:
        self._joint = find_free_joint(outset.model, outset.craft)
        self._level = outset.level
        self._instruments: list[tuple[Callable[..., Motion], _Instrument]] = []
        # attitude first: arms are turned by it
        steps: dict[str, Callable[..., Motion]] = {
            "attitude": _take_attitude,
            "gyro": _take_gyro,
            "position": _take_position,
            "depth": self._take_depth,
            "velocity": _take_velocity,
        }
        for kind, take in steps.items():
            name = getattr(sensors, kind) if sensors is not None else None
            if name is not None:
                self._instruments.append((take, _find_instrument(outset, kind, name)))
        self._last: dict[int, NDArray[np.float64]] = {}

    def read(self, data: mujoco.MjData) -> Motion:
        """The motion now."""
        motion = self._joint.read(data)
        for take, instrument in self._instruments:
            value = data.sensordata[instrument.address]
            # an echo that is lost leaves the last one
            if np.isfinite(value).all():
                self._last[instrument.address.start] = value.copy()
            known = self._last.get(instrument.address.start)
            if known is not None:
                motion = take(motion, instrument, known)
        return motion

    def _take_depth(
        self, motion: Motion, instrument: "_Instrument", value: NDArray[np.float64]
    ) -> Motion:
        """The height, from a depth or a height of a site."""
        height = self._level - value[0] if len(value) == 1 else value[2]
        arm = motion.rotation @ instrument.position
        return motion._replace(position=np.append(motion.position[:2], height - arm[2]))


class _Instrument(NamedTuple):
    """A sensor on the root body."""

    address: slice
    """Its numbers in `data.sensordata`."""
    position: NDArray[np.float64]
    """Its place (3,) [m], body frame."""
    rotation: NDArray[np.float64]
    """body_from_site (3, 3)."""
    in_world: bool
    """Whether it measures in the world frame."""


def _take_attitude(motion: Motion, instrument: _Instrument, value: NDArray[np.float64]) -> Motion:
    """The rotation, from that of a site."""
    if not value.any():
        return motion
    site = rotate_quaternion(value)
    return motion._replace(rotation=site @ instrument.rotation.T)


def _take_gyro(motion: Motion, instrument: _Instrument, value: NDArray[np.float64]) -> Motion:
    """The angular velocity."""
    return motion._replace(spin=instrument.rotation @ value)


def _take_position(motion: Motion, instrument: _Instrument, value: NDArray[np.float64]) -> Motion:
    """The position, from that of a site."""
    return motion._replace(position=value - motion.rotation @ instrument.position)


def _take_velocity(motion: Motion, instrument: _Instrument, value: NDArray[np.float64]) -> Motion:
    """The velocity, from that of a site."""
    at_site = value if instrument.in_world else motion.rotation @ (instrument.rotation @ value)
    turning = motion.rotation @ np.cross(motion.spin, instrument.position)
    return motion._replace(velocity=at_site - turning)


def _find_instrument(outset: Outset, kind: str, name: str) -> _Instrument:
    """A sensor of a vehicle by its name in the vehicle's file."""
    model, prefix = outset.model, outset.prefix
    names = [str(model.sensor(i).name) for i in range(model.nsensor)]
    own = {each.removeprefix(prefix): i for i, each in enumerate(names) if each.startswith(prefix)}
    if name not in own:
        raise ControlError(f"there is no sensor {describe(name)}; {choices(name, own)}")
    sensor = own[name]
    got, kinds = _kind_of_sensor(model, sensor), KINDS[kind]
    if got not in kinds or model.sensor_refid[sensor] >= 0:
        against = "" if got not in kinds else " against another frame"
        raise ControlError(
            f"sensor '{name}' is {got}{against}; needed for the {kind} is {' or '.join(kinds)}"
        )
    site = int(model.sensor_objid[sensor])
    is_site = model.sensor_objtype[sensor] == mujoco.mjtObj.mjOBJ_SITE
    if not is_site or model.site_bodyid[site] != outset.craft.root:
        raise ControlError(
            f"sensor '{name}' is at no site of body '{outset.craft.name}'; put it at one, so that "
            "the controller knows where it is"
        )
    start = int(model.sensor_adr[sensor])
    return _Instrument(
        address=slice(start, start + _SIZES.get(got, 3)),
        position=model.site_pos[site].copy(),
        rotation=rotate_quaternion(model.site_quat[site]),
        in_world=got == "framelinvel",
    )


def _kind_of_sensor(model: mujoco.MjModel, sensor: int) -> str:
    """The kind of a sensor: its name in MJCF, or that of its plugin."""
    plugin = int(model.sensor_plugin[sensor])
    if plugin >= 0:
        kind = kind_of(model, plugin)
        return "plugin" if kind is None else kind.plugin
    name = mujoco.mjtSensor(int(model.sensor_type[sensor])).name
    return str(name).removeprefix("mjSENS_").lower()

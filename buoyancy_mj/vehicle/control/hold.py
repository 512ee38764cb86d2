"""`Hold`: keeps a vehicle at a place, a depth and a heading, or leads it along way-points."""

import dataclasses
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError, choices, describe
from buoyancy_mj.values import read_array, set_number
from buoyancy_mj.vehicle.allocation import AXES, Allocation, allocate_craft
from buoyancy_mj.vehicle.control.controller import Control, Outset
from buoyancy_mj.vehicle.control.course import Course, Waypoint
from buoyancy_mj.vehicle.control.gains import Gains, choose_gains
from buoyancy_mj.vehicle.control.motion import ControlSensors, Motion, Reader
from buoyancy_mj.vehicle.control.rotations import find_rotation_vector, rotate_heading
from buoyancy_mj.vehicle.control.switches import find_switches

HELD = {
    "position": ("surge", "sway"),
    "depth": ("heave",),
    "heading": ("yaw",),
    "roll": ("roll",),
    "pitch": ("pitch",),
}
"""What is held, and the axes along which thrusters must push for it."""
WEAKEST = 1e-6
"""Push along an axis [N, N m] below which there is none."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Hold(Control):
    """Hold place, depth and heading, level, by a PID for each axis and thrusters within limits.

    What is not given is held as it is when the controller starts. The gains follow from the
    bandwidth and from the mass of the vehicle with its added mass; each may be given instead, as
    proportional, integral and derivative. The integral takes up the net buoyancy and what else
    pushes steadily, and does not wind up where thrusters are at their limits.

    Raises:
        ControlError: a value that makes no sense, or way-points beside a place.

    Example:
        >>> station = Hold(position=(0.0, 0.0), depth=0.8, heading=0.0)
    """

    needs_rest: ClassVar[bool] = True
    """It asks what the water does at rest when it starts."""

    position: tuple[float, float] | None = None
    """Place of the root body's origin (2,) [m], world frame."""
    depth: float | None = None
    """Depth of the root body's origin below the still surface [m]."""
    heading: float | None = None
    """Angle of the bow about the vertical from x [rad]."""
    waypoints: tuple[Waypoint, ...] = ()
    """Places to pass, one after the other, in place of the three above; the last one is held."""
    speed: float = 0.5
    """How fast the place that is held moves to the next [m/s]."""
    turn_rate: float = 0.5
    """How fast the heading that is held turns to the next [rad/s]."""
    free: tuple[str, ...] = ()
    """What is left alone: 'position', 'depth', 'heading', 'roll', 'pitch'."""
    bandwidth: float = 2.5
    """Natural frequency of each axis [rad/s], with critical damping."""
    position_gains: tuple[float, float, float] | None = None
    """Gains of surge and sway (3,) [N/m, N/(m s), N s/m]."""
    depth_gains: tuple[float, float, float] | None = None
    """Gains of heave (3,) [N/m, N/(m s), N s/m]."""
    roll_gains: tuple[float, float, float] | None = None
    """Gains of roll (3,) [N m/rad, N m/(rad s), N m s/rad]."""
    pitch_gains: tuple[float, float, float] | None = None
    """Gains of pitch (3,) [N m/rad, N m/(rad s), N m s/rad]."""
    heading_gains: tuple[float, float, float] | None = None
    """Gains of yaw (3,) [N m/rad, N m/(rad s), N m s/rad]."""
    sensors: ControlSensors | None = None
    """Sensors to read in the place of the true state."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.rate is None:
            raise ControlError("rate is None; a hold needs one, as 50.0")
        self._check_target()
        for name in ("speed", "turn_rate", "bandwidth"):
            set_number(self, ControlError, name, above=0.0)
        for name in self.free:
            if name not in HELD:
                raise ControlError(f"free holds {describe(name)}; {choices(name, HELD)}")
        for name in HELD:
            if getattr(self, f"{name}_gains") is not None:
                self._check_gains(f"{name}_gains")

    @property
    def title(self) -> str:
        """What messages call it."""
        return "hold"

    def start(self, outset: Outset) -> "HoldController":
        """Start to hold."""
        return HoldController(self, outset)

    def _check_target(self) -> None:
        """Refuse a place that is none, or two ways to say where."""
        if self.position is not None:
            position = read_array(ControlError, "position", self.position, (2,))
            object.__setattr__(self, "position", tuple(position.tolist()))
        for name in ("depth", "heading"):
            if getattr(self, name) is not None:
                set_number(self, ControlError, name)
        if not self.waypoints:
            return
        for waypoint in self.waypoints:
            if not isinstance(waypoint, Waypoint):
                raise ControlError(
                    f"waypoints hold {describe(waypoint)}; each must be a Waypoint, as "
                    "Waypoint(position=(1.0, 0.0))"
                )
        for name in ("position", "depth", "heading"):
            if getattr(self, name) is not None:
                raise ControlError(
                    f"{name} is given beside waypoints; give it to the way-points, or leave one "
                    "of the two out"
                )
        if "position" in self.free:
            raise ControlError("free holds 'position', and waypoints ask for it; leave one out")

    def _check_gains(self, name: str) -> None:
        """Refuse gains that are not three numbers from 0 up."""
        gains = read_array(ControlError, name, getattr(self, name), (3,))
        if gains.min() < 0.0:
            raise ControlError(f"{name} holds {gains.min():g}; gains must not be negative")
        object.__setattr__(self, name, tuple(gains.tolist()))


class HoldController:
    """Holds one vehicle.

    Args:
        hold: the settings.
        outset: the vehicle at its start, in still water.

    Raises:
        ControlError: the vehicle has no free joint, its thrusters cannot push along an axis that is
            to be held, or a sensor is not there.
    """

    def __init__(self, hold: Hold, outset: Outset) -> None:
        self._reader = Reader(outset, hold.sensors)
        if not outset.craft.drives:
            raise ControlError(
                f"no actuator pushes '{outset.craft.name}' at a site; give it motors or thrusters "
                "at sites"
            )
        self.allocation = allocate_craft(outset.model, outset.craft, outset.data.qpos)
        """The thrusters."""
        _check_axes(hold, self.allocation, outset.craft.name)

        # gains (6,) along surge, sway, heave, roll, pitch and yaw
        free = [axis for name in hold.free for axis in HELD[name]]
        self._held = np.array([axis not in free for axis in AXES])
        unreachable = self.allocation.unreachable
        self._counted = np.array([axis not in unreachable for axis in AXES], float)
        self._weights = None if self._counted.all() else self._counted
        self._gains: Gains = choose_gains(hold, outset)
        self._unwinding = 0.5 * hold.bandwidth

        # where to be
        self._hold, self._level = hold, outset.level
        self.course: Course
        """Where the vehicle should be."""
        self._switches = find_switches(hold.waypoints, outset.model, self.allocation.names)
        self._time: float
        self._force: NDArray[np.float64]
        self._torque: NDArray[np.float64]
        self._begin(self._reader.read(outset.data), float(outset.data.time))

    def __call__(self, _: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Write the controls of the thrusters."""
        time, motion = float(data.time), self._reader.read(data)
        if time < self._time:
            # the data were reset
            self._begin(motion, time)
        timestep, self._time = time - self._time, time
        passed = self.course.passed
        reference = self.course.advance(motion, time, timestep)
        for switch in self._switches[passed : self.course.passed]:
            data.ctrl[switch.addresses] = switch.levels

        # errors of place along the axes of the heading, of attitude along those of the body
        turn = rotate_heading(motion.heading)
        wanted = rotate_heading(reference.heading)
        error = np.concatenate(
            [
                turn.T @ (reference.position - motion.position),
                find_rotation_vector(motion.rotation.T @ wanted),
            ]
        )
        upright = motion.rotation.T @ [0.0, 0.0, reference.turning]
        rate = np.concatenate(
            [turn.T @ (reference.velocity - motion.velocity), upright - motion.spin]
        )

        # what the axes ask for: the integrals are forces in the world and torques in the body
        gains = self._gains
        integral = np.concatenate([turn.T @ self._force, self._torque])
        asked = self._held * (gains.proportional * error + gains.derivative * rate + integral)
        to_body = motion.rotation.T @ turn
        wrench = np.concatenate([to_body @ asked[:3], asked[3:]])
        thrusts = self.allocation.allocate(wrench, self._weights)
        self.allocation.write(data, thrusts)

        # the integrals, less what the thrusters could not bring
        missed = self._counted * (wrench - self.allocation.matrix @ thrusts)
        missed = np.concatenate([to_body.T @ missed[:3], missed[3:]])
        change = self._held * (gains.integral * error - self._unwinding * missed) * timestep
        self._force = self._force + turn @ change[:3]
        self._torque = self._torque + change[3:]

    def _begin(self, motion: Motion, time: float) -> None:
        """Plan the course from where the vehicle is at a time [s], with nothing learnt."""
        self.course = _plan_course(self._hold, motion, self._level)
        self._force, self._torque = np.zeros(3), np.zeros(3)
        self._time = time


def _check_axes(hold: Hold, allocation: Allocation, name: str) -> None:
    """Refuse to hold what no thruster can."""
    # the lesser of both directions along each axis
    weak = {
        axis
        for axis, reach in zip(AXES, allocation.reach, strict=True)
        if np.abs(reach).min() < WEAKEST
    }
    lost = [key for key, axes in HELD.items() if key not in hold.free and weak & {*axes}]
    if lost:
        axes = [axis for axis in AXES if axis in weak and any(axis in HELD[key] for key in lost)]
        raise ControlError(
            f"the thrusters of '{name}' do not push along {', '.join(axes)} alone in both "
            f"directions, which a hold needs; give it free = {lost}"
        )


def _plan_course(hold: Hold, motion: Motion, level: float) -> Course:
    """The way from where the vehicle is."""
    waypoints = hold.waypoints
    if not waypoints:
        place = hold.position or (float(motion.position[0]), float(motion.position[1]))
        waypoints = (Waypoint(position=place, depth=hold.depth, heading=hold.heading),)
    drifts = "position" in hold.free
    return Course(
        waypoints,
        motion.position,
        motion.heading,
        level=level,
        speed=hold.speed,
        turn_rate=hold.turn_rate,
        adrift=(drifts, drifts, "depth" in hold.free),
    )

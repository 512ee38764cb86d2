"""`Channel`: which output of an autopilot drives which actuator, by geometry or as stated."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.autopilot.motor_frames import CUSTOM, MOTOR_FRAMES, Motor
from buoyancy_mj.autopilot.packets import CHANNELS
from buoyancy_mj.autopilot.thrusters import Thruster, find_actuators, find_thrusters, scale_turns
from buoyancy_mj.errors import AutopilotError, choices, describe
from buoyancy_mj.scenes.fleet import Vehicle

LEAST_COSINE = 0.8
"""Cosine of the angle between a motor's push and a thruster's, up to which one can be the other:
vectored thrusters stand at other angles than 45 degrees, but none of them pushes straight ahead."""
LEAST_FACTOR = 0.5
"""Factor of a turn that a motor is there for; smaller ones trim the turns of others."""


class Channel(NamedTuple):
    """An output of the autopilot, and what it drives."""

    number: int
    """Number of the output, from 1."""
    actuator: int
    """Index of the actuator."""
    name: str
    """Name of the actuator, without that of the vehicle."""
    sign: float
    """1 if a longer pulse drives it forward, -1 if backward."""

    def __str__(self) -> str:
        return f"{self.number}={'-' if self.sign < 0.0 else ''}{self.name}"


def connect(
    model: mujoco.MjModel, vehicle: Vehicle, frame: str, stated: str | None = None
) -> list[Channel]:
    """Connect the outputs of an autopilot with the actuators of a vehicle.

    What is stated holds. Each other motor of the frame drives the thruster that pushes and turns
    the vehicle as the autopilot thinks that its motor does, in this sense or against it.

    Args:
        model: the model.
        vehicle: the vehicle.
        frame: name of the autopilot's frame, see `MOTOR_FRAMES`.
        stated: outputs and actuators, as in '1=bow_thruster,2=-stern_thruster'; a minus turns the
            sense.

    Returns:
        The channels, by number.

    Raises:
        AutopilotError: no such frame, actuator or output; or no thruster does what a motor does.
    """
    if frame not in MOTOR_FRAMES:
        raise AutopilotError(f"unknown frame '{frame}'; {choices(frame, MOTOR_FRAMES)}")
    channels = _parse_map(find_actuators(model, vehicle), stated) if stated is not None else []
    if frame == CUSTOM and not channels:
        raise AutopilotError(
            f"the frame '{CUSTOM}' drives nothing by itself; say what each output drives, "
            "as in --map 1=NAME,2=-OTHER"
        )

    # what is not stated, by geometry
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    taken = {channel.actuator for channel in channels}
    numbers = {channel.number for channel in channels}
    motors = [motor for motor in MOTOR_FRAMES[frame] if motor.channel not in numbers]
    thrusters = find_thrusters(model, data, vehicle)
    free = [thruster for thruster in thrusters if thruster.actuator not in taken]
    if len(free) < len(motors):
        names = ", ".join(thruster.name for thruster in free) or "none"
        raise AutopilotError(
            f"the frame '{frame}' has {len(motors)} motors without a --map, and vehicle "
            f"'{vehicle.name}' has {len(free)} thrusters for them ({names}); choose another frame, "
            f"or state all that there is (--frame {CUSTOM} --map 1=NAME,2=-OTHER)"
        )
    turns = scale_turns(thrusters)[[thrusters.index(thruster) for thruster in free]]
    channels += _match(frame, motors, free, turns)
    return sorted(channels)


def find_idle(model: mujoco.MjModel, vehicle: Vehicle, channels: Sequence[Channel]) -> list[str]:
    """Names of the actuators of a vehicle that no channel drives."""
    driven = {channel.actuator for channel in channels}
    return [name for name, i in find_actuators(model, vehicle).items() if i not in driven]


def _match(
    frame: str,
    motors: Sequence[Motor],
    thrusters: Sequence[Thruster],
    turns: NDArray[np.float64],
) -> list[Channel]:
    """Give each motor a thruster, so that all pushes and turns agree as well as they can.

    Args:
        frame: name of the frame, for messages.
        motors: the motors.
        thrusters: at least as many thrusters.
        turns: their turns (n, 3), scaled.
    """
    if not motors:
        return []
    pushes = np.array([[_cosine(m.push, t.push) for t in thrusters] for m in motors])
    alike = np.array([[_compare_turns(m, turn) for turn in turns] for m in motors])
    agreement = pushes + alike
    channels = []
    for i, j in zip(*scipy.optimize.linear_sum_assignment(-np.abs(agreement)), strict=True):
        motor, thruster = motors[i], thrusters[j]
        sign = 1.0 if agreement[i, j] > 0.0 else -1.0
        turns_it = np.abs(motor.turn).max() >= LEAST_FACTOR
        if sign * pushes[i, j] < LEAST_COSINE or (turns_it and sign * alike[i, j] <= 0.0):
            names = [thruster.name for thruster in thrusters]
            raise AutopilotError(
                f"no thruster does what motor {motor.channel} of the frame '{frame}' does "
                f"({_describe_motor(motor)}); choose another frame, or state what it drives "
                f"(--map {motor.channel}=NAME); {choices('', names)}"
            )
        channels.append(Channel(motor.channel, thruster.actuator, thruster.name, sign))
    return channels


def _compare_turns(motor: Motor, turn: NDArray[np.float64]) -> float:
    """Cosine between the turns of a motor and of a thruster (3,), about the axes that count."""
    counts = np.abs(motor.turn) >= LEAST_FACTOR
    return _cosine(motor.turn[counts], turn[counts])


def _cosine(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Cosine of the angle between two vectors; 0 where one has no direction."""
    size = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / size if size > 1e-9 else 0.0


def _describe_motor(motor: Motor) -> str:
    """What a motor does, in ArduPilot's words."""
    factors = {name: value for name, value in motor._asdict().items() if name != "channel"}
    return ", ".join(f"{name} {value:+g}" for name, value in factors.items() if value)


def _parse_map(actuators: dict[str, int], text: str) -> list[Channel]:
    """The channels that a text such as '1=NAME,2=-OTHER' states."""
    channels: dict[int, Channel] = {}
    for item in text.split(","):
        found = re.fullmatch(r"\s*(\d{1,3})\s*=\s*(-?)\s*(\S+)\s*", item)
        if found is None:
            raise AutopilotError(
                f"--map says {describe(item)}; write OUTPUT=NAME, or OUTPUT=-NAME to turn its "
                "sense, with commas between, as in 1=bow_thruster,2=-stern_thruster"
            )
        number, minus, name = int(found[1]), found[2], found[3]
        if not 1 <= number <= CHANNELS:
            raise AutopilotError(f"--map names output {number}; there are 1 to {CHANNELS}")
        if name not in actuators:
            raise AutopilotError(f"--map names no actuator '{name}'; {choices(name, actuators)}")
        if number in channels:
            raise AutopilotError(f"--map names output {number} twice; it drives one actuator")
        if any(channel.name == name for channel in channels.values()):
            raise AutopilotError(f"--map names '{name}' twice; one output drives it")
        channels[number] = Channel(number, actuators[name], name, -1.0 if minus else 1.0)
    return list(channels.values())

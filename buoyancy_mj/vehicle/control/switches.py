"""`Switch`: controls of other actuators that change where a vehicle passes a way-point."""

from collections.abc import Container, Sequence
from typing import NamedTuple

import mujoco

from buoyancy_mj.errors import ControlError, choices
from buoyancy_mj.vehicle.control.course import Waypoint


class Switch(NamedTuple):
    """What changes at one way-point."""

    addresses: list[int]
    """Where the controls stand in `data.ctrl` (n)."""
    levels: list[float]
    """Their values from there on (n)."""


def find_switches(
    waypoints: Sequence[Waypoint], model: mujoco.MjModel, thrusters: Container[str]
) -> list[Switch]:
    """What changes at each way-point.

    Args:
        waypoints: the way-points.
        model: the model.
        thrusters: names of the actuators that are steered otherwise.

    Raises:
        ControlError: a way-point names no actuator, or a thruster.
    """
    every = {str(model.actuator(i).name): i for i in range(model.nu)}
    others = {name: i for name, i in every.items() if name not in thrusters}
    for waypoint in waypoints:
        for name in waypoint.controls:
            if name not in others:
                raise ControlError(
                    f"a way-point changes the control of '{name}', which is no actuator beside the "
                    f"thrusters; {choices(name, others)}"
                )
    return [
        Switch(
            [int(model.actuator_ctrladr[others[name]]) for name in waypoint.controls],
            list(waypoint.controls.values()),
        )
        for waypoint in waypoints
    ]

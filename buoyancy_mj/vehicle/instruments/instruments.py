"""`Instruments`: every number that a model measures, commands and actuates, by name and unit."""

from collections.abc import Iterator
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.vehicle.drives import is_ballast
from buoyancy_mj.vehicle.instruments.channels import actuator_name, describe_sensor, sensor_name
from buoyancy_mj.vehicle.instruments.engine_sensors import one, repeat_components
from buoyancy_mj.vehicle.instruments.transmissions import transmission_units

SENSOR, CONTROL, FORCE, ACTIVATION = "sensor", "control", "force", "activation"
"""Kinds of channels."""


class Channel(NamedTuple):
    """One number among the instruments of a model."""

    kind: str
    """Whether it is of a sensor, or the control, the force or the activation of an actuator."""
    owner: str
    """Name of the sensor or actuator."""
    part: str
    """Name of the number within its owner, as 'x'; '' for the only one of its kind."""
    unit: str
    """Its unit; '' for none, and for a control or an activation, which has whatever unit its
    actuator gives it. Those of ballast are volumes."""

    @property
    def name(self) -> str:
        """The name of the number: 'gyro.x', 'motor.control'."""
        kind = "" if self.kind == SENSOR else self.kind
        return ".".join(filter(None, (self.owner, kind, self.part)))


class Instruments:
    """The sensors and actuators of a model.

    Args:
        model: the model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self.channels: tuple[Channel, ...] = (*_list_sensors(model), *_list_actuators(model))
        """The numbers, in the order of the model: those of sensors, controls, forces,
        activations."""

    def read(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The numbers of all channels (n,), as the last pass over the data left them."""
        return np.concatenate([data.sensordata, data.ctrl, data.actuator_force, data.act])


def _list_sensors(model: mujoco.MjModel) -> Iterator[Channel]:
    """The channels of all sensors."""
    for sensor in range(model.nsensor):
        for part, unit in describe_sensor(model, sensor):
            yield Channel(SENSOR, sensor_name(model, sensor), part, unit)


def _list_actuators(model: mujoco.MjModel) -> Iterator[Channel]:
    """The channels of all controls, then of forces, then of activations."""
    for kind, counts in (
        (CONTROL, model.actuator_ctrlnum),
        (FORCE, model.actuator_outnum),
        (ACTIVATION, model.actuator_actnum),
    ):
        for actuator, count in enumerate(counts.tolist()):
            unit = _actuator_unit(model, actuator, kind)
            for part, _ in repeat_components(one(""), count):
                yield Channel(kind, actuator_name(model, actuator), part, unit)


def _actuator_unit(model: mujoco.MjModel, actuator: int, kind: str) -> str:
    """The unit of a channel of an actuator, where that is known."""
    if kind == FORCE:
        return transmission_units(model, actuator).force
    return "m^3" if is_ballast(model, actuator) else ""

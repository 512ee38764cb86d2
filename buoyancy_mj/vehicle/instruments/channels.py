"""`describe_sensor`: a name and a unit for each number of a sensor, ours and the engine's."""

import mujoco

from buoyancy_mj.engine.instances import plugin_name
from buoyancy_mj.vehicle.instruments.engine_sensors import (
    Component,
    one,
    read_components,
    repeat_components,
)
from buoyancy_mj.vehicle.sensors.kinds import CHANNELS


def describe_sensor(model: mujoco.MjModel, sensor: int) -> list[Component]:
    """Name and unit of each number of a sensor, in the order of `sensordata`.

    Args:
        model: the model.
        sensor: index of the sensor.

    Returns:
        A pair of name and unit for each number; the name is '' for the only one. What nobody says
        a name or a unit of, as the sensors of other plugins, is numbered from 1 and has no unit.
    """
    known = read_components(model, sensor)
    if known is None:
        ours = CHANNELS.get(_plugin_name(model, sensor), ())
        known = tuple(Component(*channel) for channel in ours)
    dim = int(model.sensor_dim[sensor])
    if len(known) < dim:
        known = repeat_components(one(""), dim)
    return list(known[:dim])


def sensor_name(model: mujoco.MjModel, sensor: int) -> str:
    """The sensor's own name, or 'sensor INDEX'."""
    return str(model.sensor(sensor).name) or f"sensor {sensor}"


def actuator_name(model: mujoco.MjModel, actuator: int) -> str:
    """The actuator's own name, or 'actuator INDEX'."""
    return str(model.actuator(actuator).name) or f"actuator {actuator}"


def _plugin_name(model: mujoco.MjModel, sensor: int) -> str:
    """The name of the plugin that fills a sensor; '' for none."""
    instance = int(model.sensor_plugin[sensor])
    return plugin_name(model, instance) if instance >= 0 else ""

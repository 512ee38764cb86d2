"""Sensors as plugins of the engine."""

from collections.abc import Mapping

import mujoco

from buoyancy_mj.engine.devices import DeviceKind, Plan, register_kind
from buoyancy_mj.kernels.entries import sensors as entries
from buoyancy_mj.kernels.vehicle.sensors import Sensor


def _plan(model: mujoco.MjModel, instance: int, _: Mapping[str, str]) -> Plan:
    """Where a sensor is, and where its number goes."""
    sensor = int((model.sensor_plugin == instance).nonzero()[0][0])
    site, address = int(model.sensor_objid[sensor]), int(model.sensor_adr[sensor])
    return Plan(
        body=int(model.site_bodyid[site]),
        make=lambda device: Sensor(device, site, address),
        compute=entries.read_depth,
    )


register_kind(
    DeviceKind(
        plugin="buoyancy_mj.depth",
        keys=("noise",),
        plan=_plan,
        capability=mujoco.mjtPluginCapabilityBit.mjPLUGIN_SENSOR,
        numbers=1,
    )
)

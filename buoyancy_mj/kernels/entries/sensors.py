"""Sensors as C functions of the addresses of mjModel, mjData and a `Sensor`."""

from numba import int64

from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.sea import Sea
from buoyancy_mj.kernels.vehicle import sensors
from buoyancy_mj.kernels.vehicle.equipment import Equipment
from buoyancy_mj.kernels.vehicle.sensors import Sensor


def read_depth(model: int64, data: int64, sensor: int64) -> int64:
    """See `sensors.read_depth`; returns 0, for it cannot fail."""
    known = view(sensor, Sensor)
    equipment = view_engine(model, data, known.device.offsets, Equipment)
    sensors.read_depth(known, equipment, view(known.device.sea, Sea))
    return 0

"""What sensors read at one instant."""

from typing import NamedTuple

from numba import njit

from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.motion import find_depth


class Sensor(NamedTuple):
    """One sensor of one mjData."""

    device: Device
    site: int
    """Index of the site that it is at."""
    address: int
    """Index of its first number in `sensordata`."""


@njit(cache=True, error_model="numpy")
def read_depth(sensor, equipment, sea):
    """Write how deep the site is under the surface above it [m]."""
    at = triple(equipment.sites.site_xpos, sensor.site, 0)
    equipment.sensing.sensordata[sensor.address] = find_depth(sea, at, equipment.time)

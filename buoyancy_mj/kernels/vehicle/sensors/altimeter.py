"""An altimeter: the range of one beam."""

import math
from typing import NamedTuple

from buoyancy_mj.kernels.compiling import register_jitable
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.sensors.echoes import Echoes, drop_dry, find_surface
from buoyancy_mj.kernels.vehicle.sensors.sampling import Mount
from buoyancy_mj.kernels.vehicle.sensors.water import find_site


class AltimeterSensor(NamedTuple):
    """One altimeter."""

    device: Device
    mount: Mount
    echoes: Echoes
    """Its beam."""
    surface: int
    """1 to see the surface of the water too."""


@register_jitable(error_model="numpy")
def measure_altitude(sensor, equipment, sea):
    """Range [m] to what the beam met in the water, or to the surface where it sees that."""
    mount, echoes = sensor.mount, sensor.echoes
    at = find_site(mount, equipment)
    solid = echoes.ranges[0]
    drop_dry(echoes, equipment, sea, at)
    far = echoes.ranges[0]

    # the surface hides what lies behind it, and from the air all that is dry may be seen before it
    if sensor.surface != 0:
        way = triple(echoes.ways, 0, 0)
        surface = find_surface(sea, at, way, equipment.time, echoes.farthest)
        far = surface if math.isnan(solid) or surface < solid else solid
    mount.truth[0] = far if echoes.nearest <= far <= echoes.farthest else math.nan

"""`Pressure`: a gauge."""

import dataclasses
from typing import ClassVar

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.entries.sensors import make_entry
from buoyancy_mj.kernels.vehicle.sensors import water
from buoyancy_mj.values import read_truth
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.sampling import Kind, NoisySensor

ATMOSPHERE = 101_325.0
"""Pressure of the air [Pa], the standard atmosphere."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Pressure(NoisySensor):
    """Pressure at a site [Pa]: that of the water above it, with what the waves add.

    It is `Water.pressure`: zero on the surface, far below it that of linear waves, whatever the
    pressure is by which the water lifts hulls. In the air it is 0.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.pressure", (("", "Pa"),))
    """What all of its kind have."""

    absolute: bool = False
    """Whether the standard atmosphere, 101,325 Pa, is added."""

    def __post_init__(self) -> None:
        super().__post_init__()
        read_truth(ModelError, "absolute", self.absolute)


def _make(settings: Pressure, _: Place) -> Bind:
    air = ATMOSPHERE if settings.absolute else 0.0
    return lambda device, mount: water.SiteSensor(device, mount, air)


register_sensor(Pressure, make_entry(water.SiteSensor, water.measure_pressure), _make)

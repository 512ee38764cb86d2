"""`Depth`, `Elevation` and `Wet`: where the surface of the water is."""

import dataclasses
import math
from typing import ClassVar

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.entries.sensors import make_entry
from buoyancy_mj.kernels.vehicle.sensors import water
from buoyancy_mj.values import read_truth
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.sampling import Kind, NoisySensor, SiteSensor


@dataclasses.dataclass(frozen=True, kw_only=True)
class Depth(NoisySensor):
    """How deep a site is under the surface above it [m]; less than 0 in the air.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.depth", (("", "m"),))
    """What all of its kind have."""

    still: bool = False
    """Whether it is the depth under the still level instead, without the waves."""

    def __post_init__(self) -> None:
        super().__post_init__()
        read_truth(ModelError, "still", self.still)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Elevation(NoisySensor):
    """Height of the surface above or below a site [m], z of the world: a wave gauge.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.elevation", (("", "m"),))
    """What all of its kind have."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Wet(SiteSensor):
    """Whether a site is in the water, 0 or 1; or how much of a small ball there is.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.wet", (("", ""),), bounds=(("radius", 0.0, math.inf),))
    """What all of its kind have."""

    radius: float = 0.0
    """Of the ball [m], whose wet share of volume is read; 0 for a point."""


def _make_depth(settings: Depth, _: Place) -> Bind:
    return lambda device, mount: water.SiteSensor(device, mount, float(settings.still))


def _make_elevation(_: Elevation, __: Place) -> Bind:
    return lambda device, mount: water.SiteSensor(device, mount, 0.0)


def _make_wet(settings: Wet, _: Place) -> Bind:
    return lambda device, mount: water.SiteSensor(device, mount, settings.radius)


register_sensor(Depth, make_entry(water.SiteSensor, water.measure_depth), _make_depth)
register_sensor(Elevation, make_entry(water.SiteSensor, water.measure_elevation), _make_elevation)
register_sensor(Wet, make_entry(water.SiteSensor, water.measure_wet), _make_wet)

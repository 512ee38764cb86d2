"""`WaterVelocity` and `SpeedThroughWater`: how the water moves, and a site in it."""

import dataclasses
from typing import ClassVar

import mujoco

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.kernels.entries.sensors import make_entry
from buoyancy_mj.kernels.vehicle.sensors import water
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.sampling import VELOCITY, Kind, NoisySensor

FRAMES = ("world", "site")
"""Axes that a velocity may be read in."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class WaterVelocity(NoisySensor):
    """Velocity of the water at a site [m/s], of waves and current together; 0 in the air.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.water_velocity", VELOCITY)
    """What all of its kind have."""

    frame: str = "world"
    """Whose axes it is along: 'world' or 'site'."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.frame not in FRAMES:
            raise ModelError(f"frame is {describe(self.frame)}; {choices(self.frame, FRAMES)}")


@dataclasses.dataclass(frozen=True, kw_only=True)
class SpeedThroughWater(NoisySensor):
    """Velocity of a site less that of the water there [m/s], along the site's axes; 0 in the air.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.speed_through_water", VELOCITY)
    """What all of its kind have."""


def _make_water_velocity(settings: WaterVelocity, _: Place) -> Bind:
    turned = float(settings.frame == "site")
    return lambda device, mount: water.SiteSensor(device, mount, turned)


def _make_speed(_: SpeedThroughWater, __: Place) -> Bind:
    return lambda device, mount: water.SiteSensor(device, mount, 0.0)


register_sensor(
    WaterVelocity,
    make_entry(water.SiteSensor, water.measure_water_velocity),
    _make_water_velocity,
)
register_sensor(
    SpeedThroughWater,
    make_entry(water.SiteSensor, water.measure_speed_through_water),
    _make_speed,
    mujoco.mjtStage.mjSTAGE_VEL,
)

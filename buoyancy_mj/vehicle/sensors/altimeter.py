"""`Altimeter`: one beam downwards."""

import dataclasses
from typing import ClassVar

import numpy as np

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.entries.sensors import make_echo_entry
from buoyancy_mj.kernels.vehicle.sensors.altimeter import AltimeterSensor, measure_altitude
from buoyancy_mj.values import read_truth
from buoyancy_mj.vehicle.sensors.beams import make_echoes
from buoyancy_mj.vehicle.sensors.kinds import Bind, Place, register_sensor
from buoyancy_mj.vehicle.sensors.ranging import check_ranges
from buoyancy_mj.vehicle.sensors.sampling import Kind, NoisySensor


@dataclasses.dataclass(frozen=True, kw_only=True)
class Altimeter(NoisySensor):
    """Range [m] along -z of a site to the nearest geom of others; -1 for none.

    It sounds through the water: in the air, and to what is in the air, it reads -1. Like all rays
    of MuJoCo it meets visible geoms alone, those that are not wholly transparent.

    Raises:
        ModelError: a value out of its range.
    """

    KIND: ClassVar[Kind] = Kind("buoyancy_mj.altimeter", (("", "m"),), lost=(-1.0,))
    """What all of its kind have."""

    min_range: float = 0.05
    """Least range that is read [m]."""
    max_range: float = 100.0
    """Greatest range that is read [m]."""
    surface: bool = False
    """Whether it sees the surface of the water too, from below as from above; then it works in the
    air as well."""

    def __post_init__(self) -> None:
        super().__post_init__()
        check_ranges(self)
        read_truth(ModelError, "surface", self.surface)


def _make(settings: Altimeter, place: Place) -> Bind:
    down = np.array([[0.0, 0.0, -1.0]])
    return lambda device, mount: AltimeterSensor(
        device,
        mount,
        make_echoes(place, down, settings.min_range, settings.max_range),
        int(settings.surface),
    )


register_sensor(Altimeter, make_echo_entry(AltimeterSensor, measure_altitude), _make)

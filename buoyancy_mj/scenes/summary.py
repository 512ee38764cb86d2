"""`Summary`: a run as a whole, in a few numbers for each vehicle."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from buoyancy_mj.scenes import summary_rows
from buoyancy_mj.scenes.frames import take_only
from buoyancy_mj.scenes.natural_periods import Periods
from buoyancy_mj.scenes.sea_state import SeaState
from buoyancy_mj.scenes.seakeeping import NAMES, Seakeeping
from buoyancy_mj.scenes.sensor_measures import SensorMeasure

_OF_STEERED = "updates_at_limits"
"""What the summary says only of vehicles that have a controller."""


@dataclasses.dataclass(frozen=True)
class VehicleSummary:
    """What a run was for one vehicle."""

    mass: float
    """Its mass [kg]."""
    displacement: float
    """Mass of water that its hulls displace when fully under water [kg]."""
    net_weight: float
    """Weight less greatest buoyancy [N]: positive sinks, negative floats."""
    height: float
    """Height of its hulls from lowest to highest [m], in its own frame."""
    peak_draft: float
    """Greatest depth of its lowest point in the whole run [m]."""
    final_draft: float
    """Depth of its lowest point at the end [m]."""
    seakeeping: Seakeeping
    """How it moved; NaN if no step was taken."""
    contact_steps: int
    """Number of steps in which it touched the bottom or another fixed thing."""
    first_contact: float | None
    """Time of the first touch [s]; None without one."""
    updates_at_limits: int | None = None
    """Number of updates of its controller in which a control was at a limit; None without one."""

    def values(self) -> dict[str, Any]:
        """All numbers by the names that they have in tables, those of `Seakeeping` among them."""
        own = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        values = own | self.seakeeping.values()
        return {name: values[name] for name in _list_names()}


@dataclasses.dataclass(frozen=True)
class Summary:
    """A run in a few numbers.

    What the summary says of its only vehicle, it says itself: `summary.peak_draft` is
    `summary.vehicles[NAME].peak_draft`. Where there are several, that is an error which names them.
    """

    scene: str
    """Title of the scene."""
    method: str
    """Name of the method that finds the submersion."""
    sea: SeaState
    """How high and long the waves were."""
    vehicles: Mapping[str, VehicleSummary]
    """Each vehicle by its name."""
    simulated_time: float
    """Simulated time [s]."""
    wall_time: float
    """Time that the run took [s], with whatever was done with its frames."""
    real_time_factor: float
    """Simulated over wall time."""
    sensors: Mapping[str, SensorMeasure] = dataclasses.field(default_factory=dict)
    """What the sensors measured that were asked for, by the names of their numbers."""
    natural_periods: Mapping[str, Periods] = dataclasses.field(default_factory=dict)
    """Of each vehicle that floats, if they were asked for; see `Simulation.summary`."""

    @property
    def mass(self) -> float:
        """Mass of the only vehicle [kg]."""
        return take_only(self.vehicles).mass

    @property
    def displacement(self) -> float:
        """Mass of water that the only vehicle's hulls displace when fully under water [kg]."""
        return take_only(self.vehicles).displacement

    @property
    def net_weight(self) -> float:
        """Weight less greatest buoyancy of the only vehicle [N]: positive sinks."""
        return take_only(self.vehicles).net_weight

    @property
    def peak_draft(self) -> float:
        """Greatest depth of the lowest point of the only vehicle [m]."""
        return take_only(self.vehicles).peak_draft

    @property
    def final_draft(self) -> float:
        """Depth of the lowest point of the only vehicle at the end [m]."""
        return take_only(self.vehicles).final_draft

    @property
    def seakeeping(self) -> Seakeeping:
        """How the only vehicle moved."""
        return take_only(self.vehicles).seakeeping

    @property
    def contact_steps(self) -> int:
        """Number of steps in which the only vehicle touched something fixed."""
        return take_only(self.vehicles).contact_steps

    @property
    def first_contact(self) -> float | None:
        """Time of the only vehicle's first touch [s]; None without one."""
        return take_only(self.vehicles).first_contact

    @property
    def updates_at_limits(self) -> int | None:
        """Updates of the only vehicle's controller with a control at a limit; None without one."""
        return take_only(self.vehicles).updates_at_limits

    def rows(self) -> list[tuple[str, ...]]:
        """The summary as a table: names, then the value of each vehicle with its unit.

        What holds for the whole run stands once: for several vehicles in `caption`, and here for
        the only one, whose values are compared with what they are to be judged by.
        """
        return summary_rows.list_rows(self)

    def numbers(self) -> list[tuple[str, ...]]:
        """The numbers of `rows` alone, without what they are compared with."""
        return summary_rows.list_numbers(self)

    def _repr_html_(self) -> str:
        """How a notebook shows it."""
        from buoyancy_mj.scenes.portrait import portray

        return portray(self)

    @property
    def caption(self) -> str:
        """What holds for the whole run, in a line or two."""
        return summary_rows.write_caption(self)

    def values(self) -> dict[str, Any]:
        """All numbers by name; of several vehicles each has its own, called NAME.number."""
        steered = [name for name, one in self.vehicles.items() if one.updates_at_limits is not None]
        numbers = {name: one.values() for name, one in self.vehicles.items()}
        flat = {f"{name}.{key}": own[key] for name, own in numbers.items() for key in own}
        if len(numbers) == 1:
            (flat,) = numbers.values()
        names = list_values(list(self.vehicles), steered)
        values = {name: flat[name] if name in flat else getattr(self, name) for name in names}
        for name, measure in self.sensors.items():
            values |= dict(zip(list_sensor_values([name]), measure, strict=True))
        return values


def list_values(vehicles: Sequence[str], steered: Sequence[str] = ()) -> list[str]:
    """The names of the values of a summary in their order, without those of sensors.

    Args:
        vehicles: names of all vehicles.
        steered: names of those that have a controller.
    """
    times = ["simulated_time", "wall_time", "real_time_factor"]
    own = {
        vehicle: [name for name in _list_names() if name != _OF_STEERED or vehicle in steered]
        for vehicle in vehicles
    }
    if len(vehicles) == 1:
        contacts = ["contact_steps", "first_contact"]
        (numbers,) = own.values()
        others = [name for name in numbers if name not in contacts]
        return ["scene", "method", *others, *times, *contacts]
    of_vehicles = [f"{vehicle}.{name}" for vehicle in vehicles for name in own[vehicle]]
    return ["scene", "method", *times, *of_vehicles]


def list_sensor_values(channels: Sequence[str]) -> list[str]:
    """The names of the values of numbers of sensors: 'gyro.x.mean', 'gyro.x.least' ..."""
    return [f"{channel}.{field}" for channel in channels for field in SensorMeasure._fields]


def _list_names() -> list[str]:
    """Names of the numbers of a vehicle in tables."""
    names = [field.name for field in dataclasses.fields(VehicleSummary)]
    at = names.index("seakeeping")
    return [*names[:at], *NAMES, *names[at + 1 :]]

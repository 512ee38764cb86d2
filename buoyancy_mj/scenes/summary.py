"""`Summary`: a run as a whole, in a few numbers for each vehicle."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

from buoyancy_mj.scenes.frames import take_only

LAST = 2.0
"""Length of the end of a run [s] over which the summary takes the range of heights."""
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
    peak_draft: float
    """Greatest depth of its lowest point [m]."""
    final_draft: float
    """Depth of its lowest point at the end [m]."""
    cog_z_range: float
    """Highest less lowest z of its centre of gravity over the last 2 s [m]."""
    contact_steps: int
    """Number of steps in which it touched the bottom or another fixed thing."""
    first_contact: float | None
    """Time of the first touch [s]; None without one."""
    updates_at_limits: int | None = None
    """Number of updates of its controller in which a control was at a limit; None without one."""

    def rows(self) -> list[tuple[str, str]]:
        """The numbers as a table: names, and values with units."""
        verdict = "sinks" if self.net_weight > 0.0 else "floats"
        contact = (
            f"{self.contact_steps} steps, first at {self.first_contact:.2f} s"
            if self.contact_steps
            else "none"
        )
        limits = self.updates_at_limits
        return [
            ("mass", f"{self.mass:.3f} kg"),
            ("displacement, fully under water", f"{self.displacement:.3f} kg"),
            ("net weight, fully under water", f"{self.net_weight:+.2f} N ({verdict})"),
            ("peak draft", f"{self.peak_draft:.3f} m"),
            ("final draft", f"{self.final_draft:.3f} m"),
            (f"CoG z range, last {LAST:g} s", f"{self.cog_z_range:.4f} m"),
            *([] if limits is None else [("controls at their limits", f"{limits} updates")]),
            ("contact with the bottom or walls", contact),
        ]


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
    vehicles: Mapping[str, VehicleSummary]
    """Each vehicle by its name."""
    simulated_time: float
    """Simulated time [s]."""
    wall_time: float
    """Time that the run took [s], with whatever was done with its frames."""
    real_time_factor: float
    """Simulated over wall time."""

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
    def cog_z_range(self) -> float:
        """Highest less lowest z of the only vehicle's centre of gravity over the last 2 s [m]."""
        return take_only(self.vehicles).cog_z_range

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
        the only one.
        """
        tables = [vehicle.rows() for vehicle in self.vehicles.values()]
        names = max((dict(table) for table in tables), key=len)
        rows = [(name, *(dict(table).get(name, "") for table in tables)) for name in names]
        if len(tables) > 1:
            return rows
        *numbers, contact = rows
        return [
            ("method", self.method),
            *numbers,
            ("simulated time", f"{self.simulated_time:.2f} s"),
            ("real-time factor", f"{self.real_time_factor:.1f} x"),
            contact,
        ]

    @property
    def caption(self) -> str:
        """What holds for the whole run, in one line."""
        return (
            f"method {self.method}, {self.simulated_time:.2f} s simulated at "
            f"{self.real_time_factor:.1f} x real time"
        )

    def values(self) -> dict[str, Any]:
        """All numbers by name; of several vehicles each has its own, called NAME.number."""
        values = {}
        steered = [name for name, one in self.vehicles.items() if one.updates_at_limits is not None]
        for name in list_values(list(self.vehicles), steered):
            vehicle, _, number = name.rpartition(".")
            values[name] = getattr(self.vehicles[vehicle] if vehicle else self, number)
        return values


def list_values(vehicles: Sequence[str], steered: Sequence[str] = ()) -> list[str]:
    """The names of the values of a summary in their order.

    Args:
        vehicles: names of all vehicles.
        steered: names of those that have a controller.
    """
    names = [field.name for field in dataclasses.fields(VehicleSummary)]
    times = ["simulated_time", "wall_time", "real_time_factor"]
    own = {
        vehicle: [name for name in names if name != _OF_STEERED or vehicle in steered]
        for vehicle in vehicles
    }
    if len(vehicles) == 1:
        contacts = ["contact_steps", "first_contact"]
        (numbers,) = own.values()
        others = [name for name in numbers if name not in contacts]
        return ["scene", "method", *others, *times, *contacts]
    of_vehicles = [f"{vehicle}.{name}" for vehicle in vehicles for name in own[vehicle]]
    return ["scene", "method", *times, *of_vehicles]

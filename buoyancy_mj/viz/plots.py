"""The lines that a recording plots of each vehicle: their values, names and styles."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.palette import COLOURS, NEUTRAL, Colour, hue

Line = tuple[str, ...]
"""Name of a line: its plot first, the text of the legend last."""
_LINES: Mapping[Line, Colour] = {
    ("height", "centre_of_gravity"): COLOURS["weight"],
    ("height", "surface"): COLOURS["surface"],
    ("attitude", "roll"): COLOURS["roll"],
    ("attitude", "pitch"): COLOURS["pitch"],
    ("attitude", "yaw"): COLOURS["yaw"],
    ("energy", "kinetic"): COLOURS["kinetic"],
    ("energy", "potential"): COLOURS["weight"],
    ("energy", "buoyancy"): COLOURS["buoyancy"],
    ("energy", "total"): NEUTRAL,
    ("volume", "total"): COLOURS["buoyancy"],
}
"""Colours of the lines that every run has."""


def entity(line: Line, vehicle: str = "") -> str:
    """The entity of a line in the recording; the parts of its name may hold any character.

    Args:
        line: the line.
        vehicle: whose it is; '' for the only vehicle.
    """
    parts = (vehicle, *line) if vehicle else line
    return "/".join(["plots", *map(rr.escape_entity_path_part, parts)])


class VehicleLines:
    """The values of all lines of a vehicle, frame by frame.

    Args:
        vehicle: the vehicle.
        name: what tells it from others; '' for the only one.
    """

    def __init__(self, vehicle: Vehicle, name: str) -> None:
        self.name = name
        """What tells the vehicle from others."""
        self._vehicle = vehicle
        self._attitude: NDArray[np.float64] | None = None

    def measure(self, frame: Frame) -> dict[Line, float]:
        """The values at one instant, after those of the frame before.

        Returns:
            Heights [m], angles [degrees] without jumps by a whole turn, energies [J], magnitudes of
            forces [N], volumes [l].
        """
        vehicle, seen = self._vehicle, frame.vehicles[self._vehicle.name]
        energy = seen.energy
        roll, pitch, yaw = np.degrees(self._unwrap(seen.attitude)).tolist()
        result: dict[Line, float] = {
            ("height", "centre_of_gravity"): float(seen.centre_of_mass[2]),
            ("height", "surface"): seen.elevation,
            ("attitude", "roll"): roll,
            ("attitude", "pitch"): pitch,
            ("attitude", "yaw"): yaw,
            ("energy", "kinetic"): energy.kinetic,
            ("energy", "potential"): energy.potential,
            ("energy", "buoyancy"): energy.buoyancy,
            ("energy", "total"): energy.total,
            ("force", "weight"): vehicle.weight,
            ("volume", "total"): 1000.0 * seen.volume,
        }
        for cause, force in seen.forces.items():
            result["force", cause] = float(np.linalg.norm(force))
        for hull, row in zip(vehicle.hulls, vehicle.rows, strict=True):
            result["volume", "hulls", hull.name] = 1000.0 * float(frame.loads.hull.volume[row])
        return result

    def _unwrap(self, attitude: NDArray[np.float64]) -> NDArray[np.float64]:
        """Angles (3,) [rad] within half a turn of those before."""
        if self._attitude is not None:
            turns = np.round((self._attitude - attitude) / (2.0 * np.pi))
            attitude = attitude + 2.0 * np.pi * turns
        self._attitude = attitude
        return attitude


def styles(causes: Sequence[str], hulls: Sequence[str]) -> dict[Line, rr.SeriesLines]:
    """The style of each line, for the names of loads and of hulls."""
    colours: dict[Line, Colour] = {
        ("volume", "hulls", name): hue(i) for i, name in enumerate(hulls)
    }
    colours |= {("force", cause): COLOURS.get(cause, NEUTRAL) for cause in ("weight", *causes)}
    colours |= _LINES
    return {
        line: rr.SeriesLines(colors=[colour], names=[line[-1].replace("_", " ")], widths=[1.5])
        for line, colour in colours.items()
    }

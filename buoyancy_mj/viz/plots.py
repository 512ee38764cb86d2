"""The lines that a recording plots: their values, names and colours."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame

Colour = tuple[int, int, int]
Line = tuple[str, ...]
"""Name of a line: its plot first, the text of the legend last."""
COLOURS: Mapping[str, Colour] = {
    "weight": (235, 200, 40),
    "buoyancy": (60, 160, 255),
    "wave_pressure": (80, 200, 190),
    "drag": (240, 90, 60),
    "radiation": (240, 150, 200),
    "foil": (150, 210, 70),
    "added_mass": (170, 120, 230),
    "slamming": (250, 245, 150),
    "ballast": (200, 150, 90),
}
"""Colours of forces, in plots and as arrows."""
NEUTRAL: Colour = (225, 225, 225)
"""Colour of sums, and of forces without a colour of their own."""
_LINES: Mapping[Line, Colour] = {
    ("height", "centre_of_gravity"): (240, 130, 40),
    ("height", "surface"): (60, 160, 255),
    ("attitude", "roll"): (230, 80, 80),
    ("attitude", "pitch"): (80, 200, 100),
    ("attitude", "yaw"): (90, 130, 250),
    ("energy", "kinetic"): (230, 80, 80),
    ("energy", "potential"): COLOURS["weight"],
    ("energy", "buoyancy"): COLOURS["buoyancy"],
    ("energy", "total"): NEUTRAL,
    ("volume", "total"): NEUTRAL,
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


def list_plots(vehicle: str = "") -> dict[str, list[str]]:
    """Entities that each plot of a vehicle shows, by its title, from top to bottom."""
    top = f"/plots/{rr.escape_entity_path_part(vehicle)}" if vehicle else "/plots"
    large = [f"{top}/force/weight", f"{top}/force/buoyancy"]
    return {
        "height [m]": [f"{top}/height/**"],
        "weight and buoyancy [N]": large,
        # small beside the weight
        "other forces [N]": [f"{top}/force/**", *(f"- {path}" for path in large)],
        "submerged volume [l]": [f"{top}/volume/**"],
        "attitude [deg]": [f"{top}/attitude/**"],
        "energy [J]": [f"{top}/energy/**"],
    }


def values(vehicle: Vehicle, frame: Frame) -> dict[Line, float]:
    """The values of all lines of a vehicle at one instant.

    Returns:
        Heights [m], angles [degrees], energies [J], magnitudes of forces [N], volumes [l].
    """
    seen = frame.vehicles[vehicle.name]
    energy = seen.energy
    roll, pitch, yaw = np.degrees(seen.attitude).tolist()
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


def styles(causes: Sequence[str], hulls: Sequence[str]) -> dict[Line, rr.SeriesLines]:
    """The style of each line, for the names of loads and of hulls."""
    colours: dict[Line, Colour] = {
        ("volume", "hulls", name): hue(i) for i, name in enumerate(hulls)
    }
    colours |= {("force", cause): COLOURS.get(cause, NEUTRAL) for cause in ("weight", *causes)}
    colours |= _LINES
    return {
        line: rr.SeriesLines(colors=[colour], names=[line[-1]], widths=[1.5])
        for line, colour in colours.items()
    }


def hue(i: int) -> Colour:
    """The i-th of many colours, far from its neighbours: steps of the golden ratio in hue."""
    import trimesh

    hsv = np.array([[0.61803 * i % 1.0, 0.5, 0.9]])
    red, green, blue, _ = trimesh.visual.color.hsv_to_rgba(hsv)[0].tolist()
    return red, green, blue

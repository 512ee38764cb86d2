"""The lines that a recording plots: their values, names and colours."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
import trimesh

from buoyancy_mj.scenes.frames import Frame

Colour = tuple[int, int, int]
Line = tuple[str, ...]
"""Name of a line: its plot first, the text of the legend last."""
TIMELINE = "sim_time"
"""Name of the timeline of simulated time [s]."""
COLOURS: Mapping[str, Colour] = {
    "weight": (235, 200, 40),
    "buoyancy": (60, 160, 255),
    "wave_pressure": (80, 200, 190),
    "drag": (240, 90, 60),
    "radiation": (240, 150, 200),
    "added_mass": (170, 120, 230),
}
"""Colours of forces, in plots and as arrows."""
NEUTRAL: Colour = (225, 225, 225)
"""Colour of sums, and of forces without a colour of their own."""
_LARGE = ("/plots/force/weight", "/plots/force/buoyancy")
PLOTS: Mapping[str, Sequence[str]] = {
    "height [m]": ["/plots/height/**"],
    "weight and buoyancy [N]": _LARGE,
    # small beside the weight
    "other forces [N]": ["/plots/force/**", *(f"- {path}" for path in _LARGE)],
    "submerged volume [l]": ["/plots/volume/**"],
    "attitude [deg]": ["/plots/attitude/**"],
    "energy [J]": ["/plots/energy/**"],
}
"""Entities that each plot shows, by its title, from top to bottom."""
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


def entity(line: Line) -> str:
    """The entity of a line in the recording; the parts of its name may hold any character."""
    return "/".join(["plots", *map(rr.escape_entity_path_part, line)])


def values(frame: Frame, weight: float) -> dict[Line, float]:
    """The values of all lines at one instant.

    Args:
        frame: the instant.
        weight: weight of the vehicle [N].

    Returns:
        Heights [m], angles [degrees], energies [J], magnitudes of forces [N], volumes [l].
    """
    loads = frame.loads
    energy = frame.energy
    roll, pitch, yaw = np.degrees(frame.attitude).tolist()
    result: dict[Line, float] = {
        ("height", "centre_of_gravity"): float(frame.centre_of_mass[2]),
        ("height", "surface"): frame.elevation,
        ("attitude", "roll"): roll,
        ("attitude", "pitch"): pitch,
        ("attitude", "yaw"): yaw,
        ("energy", "kinetic"): energy.kinetic,
        ("energy", "potential"): energy.potential,
        ("energy", "buoyancy"): energy.buoyancy,
        ("energy", "total"): energy.total,
        ("force", "weight"): weight,
        ("volume", "total"): 1000.0 * float(loads.total.volume),
    }
    for cause, rows in loads.by_cause.items():
        result["force", cause] = float(np.linalg.norm(rows[:, :3].sum(axis=0)))
    for name, volume in zip(loads.names, loads.hull.volume, strict=True):
        result["volume", "hulls", name] = 1000.0 * float(volume)
    return result


def styles(causes: Sequence[str], hulls: Sequence[str]) -> dict[Line, rr.SeriesLines]:
    """The style of each line, for the names of loads and of hulls."""
    colours: dict[Line, Colour] = {
        ("volume", "hulls", name): _hue(i) for i, name in enumerate(hulls)
    }
    colours |= {("force", cause): COLOURS.get(cause, NEUTRAL) for cause in ("weight", *causes)}
    colours |= _LINES
    return {
        line: rr.SeriesLines(colors=[colour], names=[line[-1]], widths=[1.5])
        for line, colour in colours.items()
    }


def _hue(i: int) -> Colour:
    """The i-th of many colours, far from its neighbours: steps of the golden ratio in hue."""
    hsv = np.array([[0.61803 * i % 1.0, 0.5, 0.9]])
    red, green, blue, _ = trimesh.visual.color.hsv_to_rgba(hsv)[0].tolist()
    return red, green, blue

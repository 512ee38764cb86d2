"""What a recording plots, and how the viewer is laid out."""

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.scenes.frames import Frame

TIMELINE = "sim_time"
"""Simulated time [s]."""
Colour = tuple[int, int, int]
Line = tuple[str, ...]
"""Name of a line: its plot first, what the legend shows last."""
COLOURS: Mapping[str, Colour] = {
    "weight": (235, 200, 40),
    "buoyancy": (60, 160, 255),
    "wave_pressure": (80, 200, 190),
    "drag": (240, 90, 60),
    "radiation": (240, 150, 200),
    "added_mass": (170, 120, 230),
}
"""Of forces, in plots and as arrows."""
NEUTRAL: Colour = (225, 225, 225)
_LARGE = ("/plots/force/weight", "/plots/force/buoyancy")
PLOTS: Mapping[str, Sequence[str]] = {
    "height [m]": ["/plots/height/**"],
    "weight and buoyancy [N]": _LARGE,
    "other forces [N]": ["/plots/force/**", *(f"- {path}" for path in _LARGE)],
    "submerged volume [l]": ["/plots/volume/**"],
    "attitude [deg]": ["/plots/attitude/**"],
    "energy [J]": ["/plots/energy/**"],
}
"""What the plots show by their titles, from top to bottom; other forces are small beside the weight."""
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


def entity(line: Line) -> str:
    """Where a line stands in the recording; its parts may hold anything."""
    return "/".join(["plots", *map(rr.escape_entity_path_part, line)])


def values(frame: Frame, weight: float) -> dict[Line, float]:
    """All lines at one instant; volumes in litres, angles in degrees, forces [N] as magnitudes."""
    loads, energy = frame.loads, frame.energy
    roll, pitch, yaw = np.degrees(frame.attitude).tolist()
    named: dict[Line, float] = {
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
    named |= {
        ("force", cause): float(np.linalg.norm(rows[:, :3].sum(axis=0)))
        for cause, rows in loads.by_cause.items()
    }
    named |= {
        ("volume", "hulls", name): 1000.0 * float(volume)
        for name, volume in zip(loads.names, loads.hull.volume, strict=True)
    }
    return named


def styles(causes: Sequence[str], hulls: Sequence[str]) -> dict[Line, rr.SeriesLines]:
    """How each line is drawn."""
    colours: dict[Line, Colour] = {
        ("volume", "hulls", name): _hue(i) for i, name in enumerate(hulls)
    }
    colours |= {("force", cause): COLOURS.get(cause, NEUTRAL) for cause in ("weight", *causes)}
    colours |= _LINES
    return {
        line: rr.SeriesLines(colors=[colour], names=[line[-1]], widths=[1.5])
        for line, colour in colours.items()
    }


def blueprint(title: str, look_at: NDArray[np.float64], size: float) -> rrb.Blueprint:
    """3D on the left, looking at a point from a few lengths [m] away, plots on the right, playing at once."""
    view = rrb.Spatial3DView(
        origin="world",
        name=title,
        background=rrb.Background(color=[24, 30, 40]),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=rrb.EyeControls3D(
            position=look_at + size * np.array([-0.95, -1.35, 0.6]),
            look_target=look_at,
            eye_up=[0, 0, 1],
        ),
    )
    plots = [
        rrb.TimeSeriesView(
            origin="plots",
            contents=[path if path.startswith("-") else f"+ {path}" for path in contents],
            name=title,
            plot_legend=rrb.PlotLegend(
                corner=rrb.Corner2D.RightTop, visible="/plots/volume/**" not in contents
            ),
        )
        for title, contents in PLOTS.items()
    ]
    texts = rrb.Tabs(
        rrb.TextDocumentView(origin="summary", name="summary"),
        rrb.TextDocumentView(origin="scene", name="scene"),
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(view, texts, row_shares=[4, 1]), rrb.Vertical(*plots), column_shares=[3, 2]
        ),
        rrb.TimePanel(timeline=TIMELINE, play_state="playing", state="collapsed"),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _hue(i: int) -> Colour:
    """Colours far apart for neighbours: steps of the golden ratio around the circle of hues."""
    red, green, blue, _ = trimesh.visual.color.hsv_to_rgba(
        np.array([[0.61803 * i % 1.0, 0.5, 0.9]])
    )[0].tolist()
    return red, green, blue

"""`portray`: hydrostatics in a notebook, with the heights of keel, B, G and M over each other."""

import math
from typing import TYPE_CHECKING

from buoyancy_mj.displays.tables import write_table

if TYPE_CHECKING:
    from buoyancy_mj.statics.hydrostatics import Hydrostatics


def portray(at: "Hydrostatics") -> str:
    """Hydrostatics as HTML, beside what each number is judged by.

    Args:
        at: the hydrostatics of a vessel in a pose.
    """
    whole = at.density * at.whole_volume
    heave, roll, pitch = at.natural_periods().tolist()
    rows = [
        ("mass", f"{at.mass:.4g} kg", f"{whole:.4g} kg of water fully under"),
        ("displacement", f"{at.displacement:.4g} kg", f"{_divide(at.displacement, whole):.0%}"),
        ("reserve", f"{at.reserve:+.4g} kg", "floats" if at.reserve > 0.0 else "sinks"),
        ("draft", f"{at.draft:.4g} m", f"waterline {at.waterline_length:.4g} m long"),
        ("heel, trim", f"{_degrees(at.heel)}, {_degrees(at.trim)} degrees", "port up, bow down"),
        ("KB, KG, BG", f"{at.KB:.4g}, {at.KG:.4g}, {at.BG:.4g} m", "over the keel"),
        ("GM across, along", f"{at.GMt:.4g}, {at.GMl:.4g} m", _judge(at.GM)),
        ("waterplane area", f"{at.waterplane_area:.4g} m^2", f"wetted {at.wetted_area:.4g} m^2"),
        (
            "natural periods",
            f"{heave:.3g}, {roll:.3g}, {pitch:.3g} s",
            "heave, roll, pitch, no added mass",
        ),
    ]
    return write_table("Hydrostatics", rows)


def _degrees(angle: float) -> str:
    """An angle [rad] in degrees."""
    return f"{math.degrees(angle) + 0.0:.2f}"


def _divide(part: float, whole: float) -> float:
    """A part of a whole; NaN of nothing."""
    return part / whole if whole else math.nan


def _judge(height: float) -> str:
    """What the least metacentric height [m] says."""
    return "rights itself" if height > 0.0 else "turns over"

"""`draw_centres`: the centres of a vessel, each with a line to its name beside the vessel."""

from collections.abc import Mapping

import numpy as np
import rerun as rr
from numpy.typing import NDArray

NAMES: Mapping[str, tuple[str, tuple[int, int, int]]] = {
    "G": ("centre of gravity", (240, 80, 70)),
    "B": ("centre of buoyancy", (95, 150, 255)),
    "F": ("centre of flotation", (235, 235, 235)),
    "Mt": ("metacentre, heeling", (70, 200, 100)),
    "Ml": ("metacentre, trimming", (190, 225, 60)),
}
"""What each letter means, and its colour."""
ASIDE = 0.55
"""How far names stand beside the vessel, over its length."""
APART = 0.075
"""Least distance between two names, over the length of the vessel: more than one is high."""


def draw_centres(
    stream: rr.RecordingStream,
    entity: str,
    points: Mapping[str, NDArray[np.float64]],
    size: float,
    right: NDArray[np.float64],
    level: float,
) -> None:
    """Draw points by their letters in `NAMES`, and a line from G to B.

    Args:
        stream: where to.
        entity: the vessel's entity.
        points: the centres (3,) [m], world frame.
        size: length of the vessel [m].
        right: unit vector (3,) that points right in the picture.
        level: height of the water [m].
    """
    letters = sorted(points, key=lambda letter: points[letter][2])
    places = np.array([points[letter] for letter in letters])
    colours = [NAMES[letter][1] for letter in letters]
    spheres = rr.Points3D(places, colors=colours, radii=0.012 * size)
    stream.log(f"{entity}/centres", spheres, static=True)
    line = rr.LineStrips3D([[points["G"], points["B"]]], colors=(200, 200, 200), radii=0.003 * size)
    stream.log(f"{entity}/centres/BG", line, static=True)

    # names beside the vessel, over each other
    ends = places + ASIDE * size * right
    ends[:, 2] = spread_heights(places[:, 2], APART * size)
    heights = places[:, 2] - level
    labels = [
        f"{letter}  {NAMES[letter][0]}{_describe_height(height)}"
        for letter, height in zip(letters, heights.tolist(), strict=True)
    ]
    names = rr.Points3D(ends, labels=labels, colors=colours, radii=0.0, show_labels=True)
    stream.log(f"{entity}/centres/names", names, static=True)
    leaders = rr.LineStrips3D(np.stack([places, ends], axis=1), colors=colours, radii=0.0015 * size)
    stream.log(f"{entity}/centres/leaders", leaders, static=True)


def _describe_height(height: float) -> str:
    """How far a point is over the water [m], as the end of its name; nothing at the surface."""
    if abs(height) < 5e-4:
        return ""
    return f", {abs(height):.3g} m {'over' if height > 0.0 else 'under'} water"


def spread_heights(heights: NDArray[np.float64], apart: float) -> NDArray[np.float64]:
    """Heights (n,) near others, ascending, of which none is nearer than `apart` to its neighbour.

    Those that have to move go up and down alike: least squares by pooling, for heights less what
    they are apart at least.
    """
    import scipy

    steps = apart * np.arange(len(heights))
    pooled = scipy.optimize.isotonic_regression(heights - steps).x
    return np.asarray(pooled + steps)

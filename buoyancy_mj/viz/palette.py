"""One colour for each meaning, in plots and in the world of a recording.

The viewer is dark or light, as its user likes, so all can be read on black and on white. Neighbours
in one plot differ in lightness as well as in hue, for those who tell few hues apart.
"""

from collections.abc import Mapping

import numpy as np

Colour = tuple[int, int, int]
COLOURS: Mapping[str, Colour] = {
    # loads
    "weight": (222, 180, 30),
    "buoyancy": (60, 160, 255),
    "wave_pressure": (80, 200, 190),
    "drag": (240, 80, 70),
    "radiation": (240, 150, 200),
    "foil": (150, 210, 70),
    "added_mass": (170, 120, 230),
    "slamming": (240, 165, 120),
    "ballast": (190, 140, 80),
    # motion
    "surface": (105, 195, 230),
    "roll": (255, 140, 30),
    "pitch": (40, 175, 105),
    "yaw": (120, 115, 235),
    "kinetic": (225, 60, 160),
}
"""Colours by meaning: the loads by their causes, and what else every run has."""
NEUTRAL: Colour = (150, 150, 150)
"""Colour of sums, and of forces without a colour of their own."""


def hue(i: int) -> Colour:
    """The i-th of many colours, far from its neighbours: steps of the golden ratio in hue."""
    import trimesh

    hsv = np.array([[0.61803 * i % 1.0, 0.5, 0.9]])
    red, green, blue, _ = trimesh.visual.color.hsv_to_rgba(hsv)[0].tolist()
    return red, green, blue

"""`Look`: colours of the sea, the sky and the haze, as numbers in one place."""

import dataclasses
import math

Colour = tuple[float, float, float]
"""Red, green and blue from 0 to 1, as screens show them (sRGB)."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Look:
    """How the sea and all around it look."""

    # the sky
    zenith: Colour = (0.16, 0.38, 0.68)
    """The sky overhead."""
    horizon: Colour = (0.80, 0.88, 0.94)
    """The sky just above the sea."""
    cloud: Colour = (0.98, 0.97, 0.95)
    """The lit side of clouds."""
    cloud_cover: float = 0.45
    """Part of the sky that clouds cover, 0 to 1."""
    sun: Colour = (1.0, 0.94, 0.82)
    """Light of the sun."""
    sun_azimuth: float = math.radians(-40.0)
    """Where the sun stands, from x towards y [rad]."""
    sun_height: float = math.radians(34.0)
    """How high it stands over the horizon [rad]."""

    # the sea from above
    water: Colour = (0.02, 0.16, 0.24)
    """The sea where one looks into it."""
    opacity: float = 0.72
    """How little shows through the surface, 0 to 1."""
    ripple: float = 0.35
    """Slope of the ripples that are drawn on the surface and do not act."""
    ripple_length: float = 1.6
    """Width of the square of ripples that repeats over the surface [m]."""

    # the sea from below
    haze: Colour = (0.05, 0.33, 0.42)
    """The water in the distance."""
    visibility: float = 18.0
    """Distance at which the haze hides all but a twentieth [m]."""
    surface_below: Colour = (0.45, 0.78, 0.84)
    """The surface seen from below."""
    floor: Colour = (0.55, 0.53, 0.42)
    """Sand of the sea's floor."""


DAYLIGHT = Look()
"""A clear day on open water."""

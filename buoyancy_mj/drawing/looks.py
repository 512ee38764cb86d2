"""`Look`: colours of the sea, the sky and the haze, as numbers in one place."""

import dataclasses
import math

Colour = tuple[float, float, float]
"""Red, green and blue from 0 to 1, as screens show them (sRGB)."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Shade:
    """One side of the surface."""

    colour: Colour
    """The water where one looks into it."""
    opacity: float
    """How little shows through it, 0 to 1."""
    roughness: float
    """How blurred its reflections are, 0 to 1."""


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
    skylight: float = 18_000.0
    """Light of the sky [lx]."""
    sun: Colour = (1.0, 0.94, 0.82)
    """Light of the sun."""
    sunlight: float = 50_000.0
    """How much of it falls on a surface that faces it [lx]."""
    sun_azimuth: float = math.radians(-40.0)
    """Where the sun stands, from x towards y [rad]."""
    sun_height: float = math.radians(34.0)
    """How high it stands over the horizon [rad]."""

    # the surface
    above: Shade = Shade(colour=(0.03, 0.27, 0.34), opacity=0.6, roughness=0.08)
    """The surface from above."""
    below: Shade = Shade(colour=(0.60, 0.94, 0.97), opacity=0.8, roughness=0.3)
    """The surface from below."""
    ripple: float = 0.07
    """Slope of the ripples that are drawn on the surface and do not act."""
    ripple_length: float = 2.0
    """Width of the square of ripples that repeats over the surface, over the radius of what floats.
    """

    # under water
    deep: Colour = (0.02, 0.20, 0.28)
    """What one sees through the surface where nothing is under it."""
    haze: Colour = (0.06, 0.44, 0.52)
    """The water in the distance."""
    bright: Colour = (0.60, 0.90, 0.92)
    """The water overhead."""
    dark: Colour = (0.05, 0.30, 0.38)
    """The water underfoot."""
    skylight_below: float = 28_000.0
    """Light from all around [lx]; more than reaches there, as a diver's eye would have it."""
    sunlight_below: float = 40_000.0
    """Light of the sun [lx]."""
    lamp_below: float = 25_000.0
    """Light of a lamp beside the camera [lx], which keeps the colours of what is near."""
    sun_below: Colour = (0.62, 0.95, 1.0)
    """Light of the sun under water."""
    visibility: float = 40.0
    """Distance at which the haze hides all but a twentieth [m]."""


DAYLIGHT = Look()
"""A clear day on open water."""


def to_linear(colour: Colour) -> Colour:
    """A colour as light adds up, for one as screens show it (IEC 61966-2-1)."""
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in colour)
    return red, green, blue

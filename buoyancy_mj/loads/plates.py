"""Added mass of foils: thin plates that carry water along their normal."""

import math

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.loads.foil_arrays import PlacedFoil

_SLENDERNESS = (0.0, 0.125, 0.25, 0.5, 0.625, 0.8, 1.0)
_SHARE = (1.0, 0.934, 0.872, 0.757, 0.704, 0.642, 0.579)
"""Added mass of a rectangular plate as a part of pi/4 rho a^2 b, by its short side a over its long
side b (DNV-RP-N103, table A-2)."""


def estimate_plate(foil: PlacedFoil, density: float) -> NDArray[np.float64]:
    """Added mass (6, 6) [kg, kg m, kg m^2] of a foil about the origin of its body.

    Along the normal it is that of a rectangular plate, or of an elliptic one, 4/3 pi rho a b^2 / E
    with half sides a and b, b the shorter, and E the elliptic integral (Lamb 1932, art. 114). About
    chord and span it is that of strips, pi/4 rho c^2 along the normal and pi/128 rho c^4 about
    the span, lowered by the same share.

    Args:
        foil: on its body.
        density: of the water [kg/m^3].
    """
    # in the axes of the foil, about its middle
    along, chords, widths = foil.strips.T
    strips = 0.25 * math.pi * density * chords**2 * widths
    share = _normal_mass(foil, density) / strips.sum()
    mass = share * strips.sum()
    roll = share * float((strips * (along**2 + widths**2 / 12.0)).sum())
    pitch = share * float((math.pi / 128.0 * density * chords**4 * widths).sum())

    # each is a motion of the body times its mass
    chord, span, normal = foil.body_from_foil.T
    push = np.concatenate([normal, np.cross(foil.middle, normal)])
    turns = ((roll, chord), (pitch, span))
    matrix: NDArray[np.float64] = mass * np.outer(push, push)
    for inertia, axis in turns:
        turn = np.concatenate([np.zeros(3), axis])
        matrix += inertia * np.outer(turn, turn)
    return matrix


def _normal_mass(foil: PlacedFoil, density: float) -> float:
    """Added mass along the normal [kg]."""
    short, long = sorted((foil.span, foil.chord))
    if foil.elliptic:
        integral = float(scipy.special.ellipe(1.0 - (short / long) ** 2))
        return math.pi / 6.0 * density * long * short**2 / integral
    share = float(np.interp(short / long, _SLENDERNESS, _SHARE))
    return 0.25 * math.pi * density * short**2 * long * share

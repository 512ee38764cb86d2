"""`Foil`: what a fin, a rudder, a keel or a wing is like, and the lift and drag that follow."""

import dataclasses
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.selection import split_words
from buoyancy_mj.kernels import polar
from buoyancy_mj.values import read_number, read_whole_number

SECTION_STALL = 12.0
"""Angle of attack at which a symmetric section stalls in plane flow [degrees]: between the 10 and
the 15 of a NACA 0015 at Reynolds numbers of 0.16 and 1 million (Sheldahl and Klimas 1981)."""
LATEST_STALL = 40.0
"""Greatest angle of stall that is taken without being stated [degrees]; foils of aspect ratio 1 and
less stall about there (Hoerner and Borst 1975, *Fluid-Dynamic Lift*, ch. 17)."""
MOST_CROSSFLOW = 2.0
"""Normal force of cross-flow over sin^2 a at most: that of a plate of no span at all (Bollay 1939,
ZAMM 19, 21)."""
_STALL_WIDTH = 0.3
"""Half the width over which the flow parts, as a part of the angle of stall."""
_BOUNDS = {
    "span": {"above": 0.0, "most": 1e3},
    "chord": {"above": 0.0, "most": 1e3},
    "thickness": {"least": 0.0, "most": 0.5},
    "aspect": {"least": 0.1, "most": 1e6},
    "lift_slope": {"above": 0.0, "most": 7.0},
    "zero_lift": {"least": -20.0, "most": 20.0},
    "stall": {"least": 1.0, "most": 60.0},
    "drag": {"least": 0.0, "most": 1.0},
    "efficiency": {"least": 0.6, "most": 2.0},
    "crossflow": {"least": 0.0, "most": 4.0},
    "suction": {"least": 0.0, "most": 1.0},
}
"""Range of each number."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Foil:
    """A fin, a rudder, a keel or a wing: its size, its tips and its section.

    A model states it in `<custom>`, as the text 'foil:NAME' of words KEY=VALUE, where NAME is a
    geom or a site. The formulas stand in `kernels.polar.coefficients`.

    Raises:
        ModelError: a value out of its range, or an aspect ratio beside walls.

    Example:
        >>> lift, drag, moment = Foil(span=0.2, chord=0.1, walls=1).coefficients(np.radians(5.0))[0]
        >>> float(lift)
        0.338...
    """

    span: float | None = None
    """Span [m]; None for the y side of the box or ellipsoid."""
    chord: float | None = None
    """Longest chord [m]; None for the x side."""
    thickness: float | None = None
    """Thickness as a part of the chord; None for that of the box or ellipsoid."""
    walls: int = 0
    """How many ends meet a wall, as the root of a fin meets the hull: the wall mirrors the fin, so
    that one doubles the aspect ratio, and two make the flow plane."""
    aspect: float | None = None
    """Aspect ratio, with what walls do to it; None for span over mean chord."""
    lift_slope: float = 2.0 * math.pi
    """Lift slope of the section in plane flow [1/rad]; that of thin aerofoil theory by default.
    Measured ones are 0.85 to 1 times as large."""
    zero_lift: float = 0.0
    """Angle of attack without lift [degrees]; below 0 for a section that is cambered towards z."""
    stall: float | None = None
    """Angle of attack at which the foil stalls [degrees]. None for a section that stalls at
    `SECTION_STALL`, later by what the tips take off the angle, at most at `LATEST_STALL`."""
    drag: float = 0.01
    """Drag coefficient of the section at zero lift, over the area on one side."""
    efficiency: float = 0.9
    """Oswald's e in the drag that lift induces, C_L^2 / (pi e AR)."""
    crossflow: float = 0.8
    """Hoerner's cross-flow coefficient, C_D / AR sin^2 a along the normal: 0.8 for the square tips
    of Whicker and Fehlner's rudders. Over the aspect ratio it is `MOST_CROSSFLOW` at most."""
    suction: float = 1.0
    """How much of the leading edge's suction there is: 1 for round edges, 0 for the sharp ones of a
    flat plate."""

    def __post_init__(self) -> None:
        for name, bounds in _BOUNDS.items():
            value = getattr(self, name)
            if value is not None:
                value = read_number(ModelError, f"foil {name}", value, **bounds)
                object.__setattr__(self, name, value)
        walls = read_whole_number(ModelError, "foil walls", self.walls, 0, 2)
        object.__setattr__(self, "walls", walls)
        if self.aspect is not None and walls:
            raise ModelError(
                f"foil aspect is {self.aspect:g} beside {walls} walls; "
                "an aspect ratio holds what walls do to it, so leave one of them out"
            )

    def aspect_ratio(self, mean_chord: float | None = None) -> float:
        """The aspect ratio that its lift has; infinite between two walls.

        Args:
            mean_chord: area over span [m]; None for a rectangle.

        Raises:
            ModelError: span or chord is None, and so is the aspect ratio.
        """
        if self.walls == 2:
            return math.inf
        if self.aspect is not None:
            return self.aspect
        if self.span is None or self.chord is None:
            raise ModelError("a foil without an aspect ratio needs span and chord; give both")
        return (1 + self.walls) * self.span / (mean_chord or self.chord)

    def section(self, mean_chord: float | None = None) -> NDArray[np.float64]:
        """The row of `kernels.polar` for it, see `aspect_ratio`."""
        inverse = 1.0 / self.aspect_ratio(mean_chord)
        slope = finite_slope(self.lift_slope, inverse)
        stall = self.stall
        if stall is None:
            stall = min(SECTION_STALL * self.lift_slope / slope, LATEST_STALL)
        row = np.zeros(polar.SECTION)
        row[polar.SLOPE] = slope
        row[polar.CAMBER] = math.sin(math.radians(self.zero_lift))
        row[polar.INDUCED] = inverse / (math.pi * self.efficiency)
        row[polar.CROSSFLOW] = min(self.crossflow * inverse, MOST_CROSSFLOW)
        row[polar.LOST] = 1.0 - self.suction
        row[polar.STALL] = math.radians(stall)
        row[polar.BLEND] = _STALL_WIDTH * math.radians(stall)
        row[polar.PROFILE] = self.drag
        row[polar.PLATE] = 1.994 - 0.858 * (self.thickness or 0.0)
        row[polar.TIPS] = 0.41 * (-math.expm1(-17.0 * inverse))
        return row

    def coefficients(self, angles: ArrayLike) -> NDArray[np.float64]:
        """Lift, drag and moment coefficient at angles of attack (n,) [rad], as (n, 3).

        The moment is about the quarter of the chord, positive where it raises the leading edge.
        All are over the area on one side, the moment over the chord too.

        Raises:
            ModelError: the aspect ratio is not known, see `aspect_ratio`.
        """
        flat = np.atleast_1d(np.asarray(angles, float)).ravel()
        rows: NDArray[np.float64] = polar.sweep(self.section(), np.ascontiguousarray(flat))
        return rows


def finite_slope(slope: float, inverse: float) -> float:
    """Lift slope [1/rad] of a foil of finite span, from that of its section.

    a AR / (a / pi + sqrt(AR^2 + 4)): Helmbold (1942) with a = 2 pi, and Whicker and Fehlner (1958,
    DTMB 933), without sweep, with 0.9 times that. The mean downwash of the tips' vortices is in it.

    Args:
        slope: a of the section in plane flow [1/rad].
        inverse: one over the aspect ratio AR.
    """
    return slope / (slope * inverse / math.pi + math.sqrt(1.0 + 4.0 * inverse * inverse))


def parse_foil(text: str, what: str) -> Foil:
    """The foil of a text of words KEY=VALUE.

    Args:
        text: the text.
        what: how messages call it.

    Raises:
        ModelError: a word that is none, an unknown key, a key twice, or a value out of its range.
    """
    values: dict[str, float] = {}
    keys = [field.name for field in dataclasses.fields(Foil)]
    for word in split_words(text, what):
        key, equals, value = word.partition("=")
        if key not in keys:
            raise ModelError(f"{what} has the word {describe(word)}; {choices(key, keys)}")
        if key in values:
            raise ModelError(f"{what} has {key} twice; leave one of them out")
        values[key] = _parse_number(key, value if equals else "", word, what)
    try:
        return Foil(**values)  # type: ignore[arg-type]
    except ModelError as error:
        raise ModelError(f"{what}: {error}") from None


def _parse_number(key: str, value: str, word: str, what: str) -> float:
    """The number of a word KEY=VALUE."""
    try:
        return int(value) if key == "walls" else float(value)
    except ValueError:
        kind = "whole number" if key == "walls" else "number"
        raise ModelError(
            f"{what} has the word {describe(word)}; it must be {key}= and a {kind}, as '{key}=1'"
        ) from None

"""The Otter, a catamaran at the surface: stiffness and periods of heave, roll and pitch."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco

from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.hydrostatics import hydrostatics
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body, follow, numeric
from buoyancy_mj.validation.signals import period

DENSITY = 1025.0
"""Density of the water [kg/m^3]."""
VOLUME = 0.0780488
"""Displaced volume [m^3]."""
WATERPLANE_AREA = 0.75
"""Area of the waterplane [m^2]."""
TRANSVERSE_BM = 1.537912
"""Metacentre above the centre of buoyancy in roll [m]."""
LONGITUDINAL_BM = 3.416667
"""Metacentre above the centre of buoyancy in pitch [m]."""
TRANSVERSE_GM = 1.2325
"""Metacentric height in roll [m]."""


class Motion(NamedTuple):
    """One of the motions that the still water restores."""

    name: str
    """Its name."""
    joint: str
    """MJCF of a joint that leaves it alone free, but for where it is."""
    unit: str
    """Unit of its stiffness."""
    stiffness: float
    """Published stiffness."""
    period: float
    """Published natural period [s]."""
    start: float
    """Where its decay starts [m or rad]."""

    @property
    def inertia(self) -> float:
        """Inertia and added mass together [kg or kg m^2], by the stiffness and the period."""
        return self.stiffness * (self.period / (2 * math.pi)) ** 2


HEAVE = Motion("heave", 'type="slide" axis="0 0 1"', "N/m", 7541.44, 0.8407, 0.01)
ROLL = Motion("roll", 'type="hinge" axis="1 0 0"', "N m", 967.27, 1.0079, 0.02)
PITCH = Motion("pitch", 'type="hinge" axis="0 1 0"', "N m", 2441.71, 0.8575, 0.02)

# two wall-sided floats whose waterplane has the area, and by both BM the moments I = BM V
_DRAFT = VOLUME / WATERPLANE_AREA
_LENGTH = math.sqrt(12.0 * (LONGITUDINAL_BM * VOLUME) / WATERPLANE_AREA)
_BREADTH = 0.5 * WATERPLANE_AREA / _LENGTH
_OFFSET = math.sqrt(
    (TRANSVERSE_BM * VOLUME - WATERPLANE_AREA * _BREADTH**2 / 12.0) / WATERPLANE_AREA
)
_KG = 0.5 * _DRAFT + TRANSVERSE_BM - TRANSVERSE_GM
"""Centre of gravity above the keel [m]."""
_FLOATS = "".join(
    f'<geom type="box" size="{0.5 * _LENGTH!r} {0.5 * _BREADTH!r} .2"'
    f' pos="0 {side * _OFFSET!r} {0.2 - _DRAFT!r}"/>'
    for side in (-1.0, 1.0)
)


def _compare() -> Sequence[Row]:
    """Compare stiffness and periods."""
    return [*_compare_stiffness(), *_compare_periods()]


def _compare_stiffness() -> Sequence[Row]:
    inertia = (ROLL.inertia, 1.05 * ROLL.inertia, ROLL.inertia)
    model = _build("<freejoint/>", inertia)
    stiffness = hydrostatics(model, Water(density=DENSITY), qpos=[0, 0, 0, 1, 0, 0, 0]).stiffness
    return [
        Row(
            f"stiffness of {motion.name} [{motion.unit}]",
            motion.stiffness,
            float(stiffness[dof, dof]),
            0.005,
        )
        for dof, motion in ((2, HEAVE), (3, ROLL), (4, PITCH))
    ]


def _compare_periods() -> Sequence[Row]:
    return [
        Row(f"period of {motion.name} [s]", motion.period, _period(motion), 0.02)
        for motion in (HEAVE, ROLL, PITCH)
    ]


def _period(motion: Motion) -> float:
    """Period [s] of one motion by itself, undamped."""
    # about the centre of gravity
    position = "" if motion is HEAVE else f' pos="0 0 {_KG - _DRAFT!r}"'
    joint = f"<joint {motion.joint}{position}/>"

    # of heave alone the added mass is known; it scales with what is wet of the floats
    mass = DENSITY * VOLUME
    added_mass = (motion.inertia - mass) * 0.4 / _DRAFT if motion is HEAVE else 0.0
    custom = numeric("added_mass", [0, 0, added_mass, 0, 0, 0])

    # a third moment with which the three are those of a body
    yaw = max(ROLL.inertia, abs(PITCH.inertia - ROLL.inertia) + 1.0)
    model = _build(joint, (ROLL.inertia, PITCH.inertia, yaw), custom)

    def start(data: mujoco.MjData) -> None:
        data.qpos[0] = motion.start

    times, values = follow(
        model,
        Water(density=DENSITY),
        6.0,
        read=lambda data: float(data.qpos[0]),
        start=start,
        damping=None,
    )
    return period(times, values - values.mean())


def _build(joint: str, inertia: Sequence[float], custom: str = "") -> mujoco.MjModel:
    """Build the two floats with a joint, an inertia (3,) [kg m^2] and elements of `<custom>`."""
    return build_body(
        _FLOATS,
        mass=DENSITY * VOLUME,
        inertia=inertia,
        centre=f"0 0 {_KG - _DRAFT!r}",
        joint=joint,
        custom=custom,
    )


CASES = (
    Case(
        "otter",
        "Otter: stiffness and periods",
        "Fossen 2021, *Handbook of Marine Craft Hydrodynamics and Motion Control*, and its Python "
        "Vehicle Simulator, `otter.py`; each motion by itself",
        "Two wall-sided floats have the vehicle's displacement, and the area and the moments of "
        "its waterplane. The centre of gravity gives its metacentric height, and each inertia "
        "includes the added mass. The periods are those of a decay from 1 cm or a degree.",
        _compare,
        loads=("buoyancy", "added_mass: in heave"),
    ),
)
"""In the order of the page."""

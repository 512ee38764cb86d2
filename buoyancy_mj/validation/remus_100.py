"""The REMUS 100, deep under water: periods of roll and pitch."""

import math
from collections.abc import Sequence

import mujoco
import numpy as np

from buoyancy_mj.potential.ellipsoid import ellipsoid_added_mass
from buoyancy_mj.sea.water import Water
from buoyancy_mj.validation.case import Case, Row
from buoyancy_mj.validation.runs import build_body, follow, numeric
from buoyancy_mj.validation.signals import period

DENSITY = 1026.0
"""Density of the water [kg/m^3]."""
MASS = 31.029
"""Mass of the vehicle [kg]."""
INERTIA = (0.1120, 4.028, 4.028)
"""Its inertia [kg m^2]."""


def _compare() -> Sequence[Row]:
    """Compare periods with added mass and without."""
    wet = _build(numeric("added_mass", _added_mass()))
    dry = _build()
    return [
        Row("period of roll [s]", 0.9917, _period(wet, 1, 5.0), 0.02),
        Row("period of pitch [s]", 6.953, _period(wet, 2, 60.0), 0.02),
        Row("period of roll without added mass [s]", 0.8523, _period(dry, 1, 5.0), 0.02),
        Row("period of pitch without added mass [s]", 5.1107, _period(dry, 2, 60.0), 0.02),
    ]


_RADII = np.array([0.8, 0.095, 0.095])
"""Radii of a prolate spheroid of the vehicle's length and diameter [m]."""


def _added_mass() -> list[float]:
    """Added mass (6,) [kg, kg m^2] of the spheroid, and in roll by the simulator's rule."""
    added_mass = ellipsoid_added_mass(_RADII, DENSITY)
    added_mass[3] = 0.3 * INERTIA[0]  # a smooth spheroid would have none
    return [float(value) for value in added_mass]


def _build(custom: str = "") -> mujoco.MjModel:
    """Build the spheroid, scaled to be neutral, its centre of gravity 2 cm under its middle."""
    volume = MASS / DENSITY
    scale = (volume / (4.0 / 3.0 * math.pi * float(_RADII.prod()))) ** (1.0 / 3.0)
    size = " ".join(repr(float(radius * scale)) for radius in _RADII)
    return build_body(
        f'<geom type="ellipsoid" size="{size}"/>',
        mass=MASS,
        inertia=INERTIA,
        centre="0 0 -.02",
        custom=custom,
    )


def _period(model: mujoco.MjModel, axis: int, duration: float) -> float:
    """Period [s] of the free body after a small turn about an axis (1 roll, 2 pitch), undamped."""
    angle = 0.02

    def start(data: mujoco.MjData) -> None:
        data.qpos[2] = -20.0
        data.qpos[3] = math.cos(0.5 * angle)
        data.qpos[3 + axis] = math.sin(0.5 * angle)

    times, angles = follow(
        model,
        Water(density=DENSITY),
        duration,
        read=lambda data: float(data.qpos[3 + axis]),
        start=start,
        damping=None,
    )
    return period(times, angles)


CASES = (
    Case(
        "remus_100",
        "REMUS 100: periods of roll and pitch",
        "Fossen 2021, *Handbook of Marine Craft Hydrodynamics and Motion Control*, and its Python "
        "Vehicle Simulator, `remus100.py`; periods coupled with sway and heave, and without added "
        "mass about the middle",
        "A prolate spheroid has the vehicle's length, diameter and mass, Lamb's added mass, and "
        "0.3 of its inertia as added mass in roll. It is free, turned by a degree, without drag.",
        _compare,
        loads=("buoyancy", "added_mass: in two of the rows"),
    ),
)
"""In the order of the page."""

"""The water around the hulls: surface, current, density, and the model of its pressure."""

from enum import IntEnum
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.waves import ROWS

PressureModel = IntEnum("PressureModel", "archimedes hydrostatic froude_krylov", start=0)
"""Models of the pressure in waves: rho g V upward; that of the depth under the surface; that of
linear waves."""


class Sea(NamedTuple):
    """One sea."""

    waves: Annotated[Doubles, (ROWS, "w")]
    """The waves, see `kernels.waves`."""
    current: Annotated[Doubles, ("c", 5)]
    """The current, see `kernels.currents`."""
    density: float
    """[kg/m^3]."""
    level: float
    """Height of the still level [m]."""
    pressure: int
    """One of `PressureModel`."""

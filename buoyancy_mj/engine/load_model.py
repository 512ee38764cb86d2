"""`Acting`: all that acts on the bodies of a model, resolved to arrays; what one pass of the water needs."""

import dataclasses
import functools

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.entries.passive import Pressure
from buoyancy_mj.loads.added_mass import AddedMass
from buoyancy_mj.loads.damping_arrays import DampingArrays
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.methods import Packed

CAUSES = ("buoyancy", "wave_pressure", "drag", "radiation", "added_mass")
"""Names of all loads that there are."""


@dataclasses.dataclass(frozen=True, eq=False)
class LoadModel:
    """What the water does to the bodies of one model."""

    water: Water
    """The sea."""
    packed: Packed
    """Its hulls."""
    owners: NDArray[np.int64]
    """The body of each (h,)."""
    pressure: Pressure
    """What the pressure in waves is taken for."""
    damping: DampingArrays | None
    """Drag of the bodies; None for none."""
    added: AddedMass
    """Added mass of those that have one."""

    @functools.cached_property
    def causes(self) -> tuple[str, ...]:
        """Names of the loads that act."""
        acting = {
            "wave_pressure": self.pressure != Pressure.archimedes,
            "drag": self.damping is not None,
            "radiation": self.damping is not None and self.damping.radiates,
            "added_mass": self.has_added_mass,
        }
        return tuple(cause for cause in CAUSES if acting.get(cause, True))

    @functools.cached_property
    def has_added_mass(self) -> bool:
        """Whether any body has added mass."""
        return len(self.added.bodies) > 0

    @functools.cached_property
    def has_wave_pressure(self) -> bool:
        """Whether the pressure is another than Archimedes': on still water it is not."""
        return self.pressure != Pressure.archimedes and len(self.rows) > 0

    @functools.cached_property
    def rows(self) -> NDArray[np.float64]:
        """The waves, see `kernels.waves`."""
        return self.water.rows

    @property
    def current(self) -> NDArray[np.float64]:
        """The current, see `kernels.currents`."""
        return self.water.current_rows

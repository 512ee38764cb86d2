"""`LoadModel`: all that acts on the bodies of a model, resolved to arrays."""

import dataclasses
import functools

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import clip
from buoyancy_mj.kernels.arrays import conform, empty
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.kernels.passes import IDS, Causes, LoadArrays, Record
from buoyancy_mj.kernels.scratch import Scratch
from buoyancy_mj.kernels.sea import PressureModel
from buoyancy_mj.sea.water import Water
from buoyancy_mj.submersion.exact import PackedHulls, sea_arrays
from buoyancy_mj.submersion.methods import Packed

CAUSES = Causes._fields
"""Names of all loads that there are."""


@dataclasses.dataclass(frozen=True, eq=False)
class LoadModel:
    """What the water does to the bodies of one model."""

    packed: Packed
    """The hulls, ready to be submerged."""
    arrays: LoadArrays
    """All that acts, as kernels read it."""

    @functools.cached_property
    def causes(self) -> tuple[str, ...]:
        """Names of the loads that act."""
        damping = self.arrays.damping
        acts = {
            "wave_pressure": self.arrays.sea.pressure != PressureModel.archimedes,
            "drag": len(damping.bodies) > 0,
            "radiation": damping.radiates,
            "added_mass": len(self.arrays.added_mass.bodies) > 0,
        }
        return tuple(cause for cause in CAUSES if acts.get(cause, True))

    @functools.cached_property
    def has_wave_pressure(self) -> bool:
        """Whether the pressure differs from Archimedes': on still water it does not."""
        return "wave_pressure" in self.causes and len(self.arrays.sea.waves) > 0

    @functools.cached_property
    def scratch(self) -> Scratch:
        """Arrays to work in, for Python."""
        return self.new_scratches(1)[0]

    def new_scratches(self, count: int) -> list[Scratch]:
        """Arrays to work in, for so many threads."""
        if isinstance(self.packed, PackedHulls):
            return self.packed.new_scratches(count)
        return [empty(Scratch)] * count

    def record(self, bodies: int, inertias: int) -> Record:
        """Room for what one pass leaves.

        Args:
            bodies: how many the model has.
            inertias: elements of its mass matrix.
        """
        hulls = len(self.arrays.owners)
        return Record(
            wet=np.zeros((hulls, clip.COLUMNS)),
            centres=np.zeros((bodies, 4)),
            heads=np.zeros((hulls, 6)),
            causes=Causes(
                *(np.zeros((bodies if cause in self.causes else 0, 6)) for cause in CAUSES)
            ),
            total=np.zeros((bodies, 6)),
            inertia=np.zeros(inertias if "added_mass" in self.causes else 0),
            instant=np.zeros(1),
            ids=np.zeros(IDS, np.int64),
        )


def build_load_model(
    water: Water,
    packed: Packed,
    owners: NDArray[np.int64],
    pressure: PressureModel,
    damping: DampingArrays | None,
    added_mass: AddedMass,
) -> LoadModel:
    """A `LoadModel`.

    Args:
        water: the sea.
        packed: the hulls.
        owners: the body of each hull (h,).
        pressure: the model of the pressure in waves.
        damping: drag of the bodies; None for none.
        added_mass: added mass of the bodies that have one.
    """
    arrays = LoadArrays(
        hulls=packed.hulls if isinstance(packed, PackedHulls) else empty(Hulls),
        owners=owners,
        bodies=np.unique(owners),
        sea=sea_arrays(water, pressure),
        damping=empty(DampingArrays) if damping is None else damping,
        added_mass=added_mass,
    )
    return LoadModel(packed, conform(arrays))

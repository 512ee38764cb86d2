"""`VesselInspection`: what a vessel weighs and displaces, whether it floats, and how it rests."""

import dataclasses
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning
from buoyancy_mj.hulls.gravity import find_weighing_masses
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.inspection.sentences import list_doubts, write_sentence
from buoyancy_mj.statics.balance import NEUTRAL
from buoyancy_mj.statics.equilibrium import (
    Equilibrium,
    find_equilibria,
    find_equilibrium,
    move_to_rest,
)
from buoyancy_mj.statics.righting import RightingArm, compute_righting_arm
from buoyancy_mj.statics.vessel import Vessel


@dataclasses.dataclass(frozen=True)
class BuoyancyBudget:
    """What a body weighs and displaces."""

    body: str
    """Name of the body."""
    mass: float
    """Mass [kg]."""
    carried: float
    """Part of its mass that gravity compensation carries [kg]."""
    displacement: float
    """Mass of the water that it displaces fully submerged [kg]."""
    gravity: float
    """Downward acceleration [m/s^2]."""

    @property
    def reserve(self) -> float:
        """Mass [kg] that it could carry, negative where it is too heavy."""
        return self.displacement - (self.mass - self.carried)

    @property
    def lift(self) -> float:
        """Net upward force fully submerged [N]."""
        return self.reserve * self.gravity


@dataclasses.dataclass(frozen=True, eq=False)
class VesselInspection:
    """A vessel: whether it floats, and how."""

    vessel: Vessel
    """The vessel where the model has it."""
    bodies: tuple[BuoyancyBudget, ...]
    """Budget of each of its bodies that weighs or displaces anything."""
    sentence: str
    """Whether it floats, and how, in one sentence."""
    rest: Equilibrium | None
    """Where it comes to rest from its pose in the model; None if it sinks, or is not free."""
    rests: tuple[Equilibrium, ...]
    """All poses in which it stays at rest, lowest energy first."""
    refused: tuple[str, ...]
    """Names of its geoms whose meshes are refused; while there are any, nothing else is known."""
    righting: RightingArm | None
    """Righting arms from where it rests."""
    notes: tuple[str, ...]
    """Sentences on what else looks odd."""

    @property
    def at_rest(self) -> Vessel:
        """The vessel where it comes to rest; where the model has it, if it does not."""
        return self.vessel if self.rest is None else move_to_rest(self.vessel, self.rest)

    @property
    def total(self) -> BuoyancyBudget:
        """Budget of all its bodies, under the name of the root body."""
        vessel = self.vessel
        displacement = vessel.water.density * vessel.volume
        return BuoyancyBudget(
            vessel.name, vessel.whole_mass, vessel.carried_mass, displacement, vessel.gravity
        )

    @property
    def root_names(self) -> tuple[str, ...]:
        """Names of the roots of its kinematic trees, which welds and connects hold together."""
        return tuple(body_name(self.vessel.model, tree.root) for tree in self.vessel.trees)

    @property
    def centre_of_gravity(self) -> NDArray[np.float64]:
        """Centre of gravity in the frame of its root body (3,) [m]."""
        return self.vessel.centre_of_gravity

    @property
    def centre_of_buoyancy(self) -> NDArray[np.float64]:
        """Centre of buoyancy fully submerged, in the frame of its root body (3,) [m]."""
        return self.vessel.centre_of_gravity + self.vessel.centroid


def inspect_vessel(
    vessel: Vessel,
    hulls: Sequence[Hull],
    refused: Sequence[str] = (),
    notices: Sequence[str] = (),
) -> VesselInspection:
    """Inspect a vessel.

    Args:
        vessel: the vessel.
        hulls: all hulls of its model, by body.
        refused: names of its geoms whose meshes are refused, so that its hulls are not whole.
        notices: what was told when it was built.
    """
    notes = [*notices, *([] if refused else list_doubts(vessel))]
    rest: Equilibrium | None = None
    rests: tuple[Equilibrium, ...] = ()
    righting: RightingArm | None = None

    # a search that fails becomes a note
    floats = vessel.mass > 0.0 and vessel.reserve >= -NEUTRAL * vessel.mass
    if floats and vessel.free and not refused:
        try:
            rest = find_equilibrium(vessel)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", BuoyancyWarning)
                rests = find_equilibria(vessel)
                righting = compute_righting_arm(
                    vessel,
                    np.radians(np.arange(181.0)),
                    upright=move_to_rest(vessel, rest).rotation,
                )
            notes += [str(entry.message) for entry in caught]
        except BuoyancyError as error:
            notes.append(str(error))
    return VesselInspection(
        vessel=vessel,
        bodies=_weigh_bodies(vessel, hulls),
        sentence=write_sentence(vessel, rest, refused),
        rest=rest,
        rests=rests,
        refused=tuple(refused),
        righting=righting,
        notes=tuple(notes),
    )


def _weigh_bodies(vessel: Vessel, hulls: Sequence[Hull]) -> tuple[BuoyancyBudget, ...]:
    """Budgets of its bodies; a body without joints counts with the one that it moves with."""
    model = vessel.model
    carriers = model.body_weldid[vessel.bodies]
    masses = model.body_mass[vessel.bodies]
    carried = masses - find_weighing_masses(model)[vessel.bodies]
    budgets = []
    for body in np.unique(carriers):
        mass = float(masses[carriers == body].sum())
        volume = sum(hull.displaced_volume for hull in hulls if hull.body == body)
        if mass > 0.0 or volume > 0.0:
            name = body_name(model, int(body))
            displacement = vessel.water.density * volume
            lifted = float(carried[carriers == body].sum())
            budgets.append(BuoyancyBudget(name, mass, lifted, displacement, vessel.gravity))
    return tuple(budgets)

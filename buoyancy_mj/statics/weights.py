"""`Weight`: a rigid mass added to a vessel; and the vessel with it."""

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.statics.vessel import Vessel


class Weight(NamedTuple):
    """A rigid mass."""

    mass: float
    """[kg]."""
    point: NDArray[np.float64]
    """Its centre in the vessel's axes (3,) [m]."""
    inertia: NDArray[np.float64]
    """Its inertia about that (3, 3) [kg m^2]."""


def add_weights(vessel: Vessel, weights: Sequence[Weight]) -> tuple[NDArray[np.float64], Vessel]:
    """How far weights move the centre of gravity (3,) [m], and a copy of the vessel with them.

    What weighs nothing has no centre of gravity, and keeps that of its mass.
    """
    added = sum(weight.mass for weight in weights)
    moment = sum((weight.mass * weight.point for weight in weights), np.zeros(3))
    mass = vessel.mass + added
    shift = moment / mass if mass else np.zeros(3)

    # the centre of mass, and inertia about it
    whole = vessel.whole_mass
    centre = (whole * vessel.centre_of_mass + moment) / (whole + added)
    inertia = vessel.inertia + whole * steiner(vessel.centre_of_mass - centre)
    for weight in weights:
        inertia = inertia + weight.mass * steiner(weight.point - centre) + weight.inertia

    # all places from the new centre of gravity
    return shift, dataclasses.replace(
        vessel,
        mass=mass,
        inertia=inertia,
        centre_of_mass=centre - shift,
        centre_of_gravity=vessel.centre_of_gravity + shift,
        position=vessel.position + vessel.rotation @ shift,
        hulls=tuple(
            dataclasses.replace(hull, position=hull.position - shift) for hull in vessel.hulls
        ),
        tanks=tuple(
            dataclasses.replace(
                tank, position=tank.position - shift, centroid=tank.centroid - shift
            )
            for tank in vessel.tanks
        ),
        sites={name: point - shift for name, point in vessel.sites.items()},
    )


def steiner(arm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inertia per mass (3, 3) [m^2] of a point at `arm` (3,) [m] about the origin (Steiner)."""
    return np.asarray(arm @ arm * np.eye(3) - np.outer(arm, arm), float)

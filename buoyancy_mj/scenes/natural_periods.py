"""`find_natural_periods`: how fast vehicles swing by themselves, beside the waves of a run."""

import math
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.scenes.added_inertia import measure_added_mass
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.equilibrium import find_equilibrium

DEEP = 10.0
"""Depth over the length of a vehicle and the height of waves, at which all of it is wet."""
CARRIES = 1e-6
"""Added mass over the mass of a vehicle, from which on there is one."""


class Periods(NamedTuple):
    """Undamped periods of one vehicle [s]; inf where nothing restores."""

    heave: float
    """Of heave."""
    roll: float
    """Of roll."""
    pitch: float
    """Of pitch."""
    with_added_mass: bool
    """Whether the water that it moves along is in them."""


def find_natural_periods(
    model: mujoco.MjModel, hulls: Sequence[Hull], vehicles: Mapping[str, Vehicle], water: Water
) -> dict[str, Periods]:
    """The natural periods of the vehicles that float at the surface, by their names.

    Added mass is that of the vehicle under water, times the part of its volume that is wet at rest.

    Args:
        model: the model.
        hulls: its hulls.
        vehicles: its vehicles.
        water: the sea.
    """
    found = {}
    for name, vehicle in vehicles.items():
        if vehicle.displacement <= vehicle.mass:
            continue
        root = body_name(model, vehicle.root)
        try:
            with warnings.catch_warnings():
                # the run has told what there was to tell
                warnings.simplefilter("ignore")
                vessel = build_vessel_from_hulls(model, hulls, water, body=root)
                rest = find_equilibrium(vessel)
        except BuoyancyError:
            # what has no rest swings nowhere
            continue
        at = rest.hydrostatics

        # out of reach of the waves
        deep = rest.qpos.copy()
        height = int(model.jnt_qposadr[model.body_jntadr[vehicle.root]]) + 2
        deep[height] -= DEEP * (vehicle.length + np.abs(water.rows[:, 0]).sum())
        share = at.displacement / vehicle.displacement
        added = share * measure_added_mass(model, vessel, at, deep)
        carries = bool(np.abs(added[:3, :3]).max() > CARRIES * vehicle.mass)
        heave, roll, pitch = at.natural_periods(added if carries else None).tolist()
        if math.isfinite(heave):
            found[name] = Periods(heave, roll, pitch, carries)
    return found

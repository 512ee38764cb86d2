"""`find_natural_periods`: how fast vehicles swing by themselves, beside the waves of a run."""

import math
import warnings
from collections.abc import Mapping, Sequence

import mujoco

from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.equilibrium import find_equilibrium

Periods = tuple[float, float, float]
"""Undamped periods of heave, roll and pitch without added mass [s]; inf where nothing restores."""


def find_natural_periods(
    model: mujoco.MjModel, hulls: Sequence[Hull], vehicles: Mapping[str, Vehicle], water: Water
) -> dict[str, Periods]:
    """The natural periods of the vehicles that float at the surface, by their names.

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
                rest = find_equilibrium(vessel).hydrostatics
        except BuoyancyError:
            # what has no rest swings nowhere
            continue
        heave, roll, pitch = rest.natural_periods().tolist()
        if math.isfinite(heave):
            found[name] = (heave, roll, pitch)
    return found

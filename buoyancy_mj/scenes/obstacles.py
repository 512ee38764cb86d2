"""Obstacles: what is in the way of the vehicles of a scene where they start."""

import warnings
from collections.abc import Iterator, Mapping

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import body_name, geom_kind, geom_name
from buoyancy_mj.hulls.tethers import has_free_joint
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.heights import SQUARE, TOUCH, bound_geoms, find_heights

_UNDER = 0.5
"""How far ground is looked for from the middle of a vehicle, over half of its beam."""


def warn_of_obstacles(
    model: mujoco.MjModel, data: mujoco.MjData, vehicles: Mapping[str, Vehicle], level: float
) -> None:
    """Warn of what vehicles lie in at the start, and of what they would rest on above the water.

    Args:
        model: the model of a scene.
        data: its poses at the start, after mj_fwdPosition.
        vehicles: its vehicles by name.
        level: height of the still water [m].
    """
    for message in [
        *_list_contacts(model, data, vehicles),
        *_list_grounds(model, data, vehicles, level),
    ]:
        warnings.warn(message, BuoyancyWarning, stacklevel=3)


def _list_contacts(
    model: mujoco.MjModel, data: mujoco.MjData, vehicles: Mapping[str, Vehicle]
) -> Iterator[str]:
    """Sentences on vehicles that lie in each other, or in other bodies that move."""
    owners = np.where(find_moving_bodies(model), len(vehicles) + 1 + model.body_treeid, 0)
    for number, vehicle in enumerate(vehicles.values(), 1):
        owners[vehicle.bodies] = number
    pairs = owners[model.geom_bodyid[data.contact.geom[data.contact.dist < 0.0]]]
    names = ["", *vehicles, *(body_name(model, int(root)) for root in model.tree_bodyadr)]
    for one, other in sorted({(min(pair), max(pair)) for pair in pairs.tolist()}):
        if not 0 < one <= len(vehicles) or one == other:
            continue
        both = other <= len(vehicles)
        subject, mend = ("vehicles", "one of them") if both else ("vehicle", "the vehicle")
        yield (
            f"{subject} '{names[one]}' and '{names[other]}' lie in each other at the start, and "
            f"contact will throw them apart; start {mend} elsewhere (start.position)"
        )


def _list_grounds(
    model: mujoco.MjModel, data: mujoco.MjData, vehicles: Mapping[str, Vehicle], level: float
) -> Iterator[str]:
    """Sentences on what is fixed under a vehicle that floats and reaches out of the water.

    What hangs on joints, as a crane on its pier, does not come down on it.
    """
    fixed = _find_fixed_geoms(model).tolist()
    for vehicle in vehicles.values():
        if not has_free_joint(model, vehicle.root):
            continue
        subject = "the vehicle" if len(vehicles) == 1 else f"vehicle '{vehicle.name}'"
        points = _place_lines(model, data, vehicle)
        for geom in fixed:
            height = round(float(find_heights(model, data, geom, points).max()), 9) + 0.0
            if height >= level - TOUCH:
                yield (
                    f"{subject} starts above the {geom_kind(model, geom)} "
                    f"'{geom_name(model, geom)}', which reaches out of the water to "
                    f"z = {height:g} m, and will rest on it"
                )


def _find_fixed_geoms(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Indices of the geoms that cannot move and can be touched."""
    solid = (model.geom_contype != 0) | (model.geom_conaffinity != 0)
    solid[model.pair_geom1] = solid[model.pair_geom2] = True
    return np.flatnonzero(solid & ~find_moving_bodies(model)[model.geom_bodyid])


def _place_lines(
    model: mujoco.MjModel, data: mujoco.MjData, vehicle: Vehicle
) -> NDArray[np.float64]:
    """Points (n, 3) [m] over the middle of a vehicle, at its top, from which to look down."""
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, vehicle.bodies))
    bounds = bound_geoms(model, data, geoms, data.xpos[vehicle.root])
    middle = bounds.mean(axis=0)
    middle[2] = bounds[1, 2] + TOUCH
    half_beam = 0.5 * float(np.ptp(bounds[:, :2], axis=0).min())
    return np.asarray(middle + _UNDER * half_beam * SQUARE, float)

"""`fill_vessel`: a vessel with water in its tanks, and with its bladders blown up."""

import dataclasses
from collections.abc import Mapping

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.hulls.ballast_volumes import read_volumes
from buoyancy_mj.hulls.placed_ballasts import PlacedBallast, find_ballasts
from buoyancy_mj.statics.tanks import VesselTank
from buoyancy_mj.statics.vessel import Vessel, VesselHull
from buoyancy_mj.statics.weights import Weight, add_weights


def fill_vessel(
    vessel: Vessel,
    data: mujoco.MjData,
    origin: NDArray[np.float64],
    root_from_world: NDArray[np.float64],
    ballast: Mapping[str, float] | ArrayLike | None,
) -> Vessel:
    """A copy of a vessel whose ballast holds what it is said to hold.

    Args:
        vessel: the vessel.
        data: its bodies where its coordinates have them.
        origin: origin of its root body (3,) [m], world frame.
        root_from_world: rotation of that body (3, 3).
        ballast: see `hulls.ballast_volumes.read_volumes`.

    Raises:
        ModelError: ballast that makes no sense.
    """
    placed = find_ballasts(vessel.model)
    volumes = read_volumes(vessel.model, placed, ballast)
    weights: list[Weight] = []
    hulls: list[VesselHull] = []
    tanks: list[VesselTank] = []
    for one, volume in zip(placed, volumes, strict=True):
        if one.body not in vessel.bodies or not volume > 0.0:
            continue
        turn = root_from_world @ data.xmat[one.body].reshape(3, 3)
        start = root_from_world @ (data.xpos[one.body] - origin) - vessel.centre_of_gravity
        rotation, position = turn @ one.body_from_geom, turn @ one.position + start
        if not one.holds_water:
            share = volume / one.mesh.volume
            hulls.append(VesselHull(one.name, one.mesh, position, rotation, share))
            continue
        weight = _weigh(one, volume, vessel.water.density, turn, start)
        weights.append(weight)
        if one.has_level:
            tanks.append(VesselTank(one.name, one.mesh, position, rotation, volume, weight.point))

    # all from the new centre of gravity
    beside = dataclasses.replace(
        vessel, hulls=(*vessel.hulls, *hulls), tanks=(*vessel.tanks, *tanks)
    )
    return add_weights(beside, weights)[1] if weights else beside


def _weigh(
    one: PlacedBallast,
    volume: float,
    density: float,
    turn: NDArray[np.float64],
    start: NDArray[np.float64],
) -> Weight:
    """The water of a tank as it lies in an upright body; rotation and origin are the body's."""
    first, second = one.water(volume)
    middle = first / volume
    spread = second - volume * np.outer(middle, middle)
    inertia = density * (np.trace(spread) * np.eye(3) - spread)
    return Weight(density * volume, turn @ middle + start, turn @ inertia @ turn.T)

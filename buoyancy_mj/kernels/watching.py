"""What the summary of a run keeps of each vehicle, step by step."""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.drafts import Corners, find_draft

NOBODYS, OWN, FIXED = range(3)
"""What a geom is to a vehicle."""


class Watched(NamedTuple):
    """A vehicle, and what has been seen of it."""

    corners: Corners
    """Where it may be deepest."""
    bodies: Annotated[Words, ("b",)]
    """Its bodies."""
    masses: Annotated[Doubles, ("b",)]
    """Theirs [kg]."""
    mass: float
    """Of all [kg]."""
    owners: Annotated[Words, ("g",)]
    """`NOBODYS`, `OWN` or `FIXED` for each geom."""
    seen: Annotated[Words, (1,)]
    """How many poses have been seen."""
    times: Annotated[Doubles, ("c",)]
    """Times of those [s]."""
    heights: Annotated[Doubles, ("c",)]
    """Heights of its centre of gravity in those [m]."""
    peak: Annotated[Doubles, (1,)]
    """Greatest draft [m]."""
    contact_steps: Annotated[Words, (1,)]
    """Number of steps in which it touched something fixed."""
    first_contact: Annotated[Doubles, (1,)]
    """Time of the first of them [s]; NaN for none."""


class Bounds(NamedTuple):
    """Within what the moving bodies of a run are calm."""

    bodies: Annotated[Words, ("n",)]
    """Those bodies."""
    start: Annotated[Doubles, ("n", 3)]
    """Their centres of mass at the start [m]."""
    lowest: Annotated[Doubles, ("n",)]
    """Height [m] under which each may have fallen through a floor."""
    farthest: float
    """Distance from the start along an axis [m]."""
    fastest: float
    """Velocity along an axis [m/s], and about one [rad/s]."""


@njit(cache=True, error_model="numpy")
def add_poses(watched, xpos, xmat, xipos, time):
    """Keep the draft and the height of the centre of gravity in poses at a time [s].

    Poses are (nbody, 3), (nbody, 9), (nbody, 3). There must be room for them.
    """
    peak = watched.peak
    peak[0] = find_draft(watched.corners, xpos, xmat, time, peak[0])
    add_height(watched, xipos, time)


@njit(cache=True, error_model="numpy")
def add_height(watched, xipos, time):
    """Keep the height of the centre of gravity in poses (nbody, 3) at a time [s]."""
    seen, moment = watched.seen, 0.0
    for n in range(watched.bodies.shape[0]):
        moment += watched.masses[n] * xipos[watched.bodies[n], 2]
    watched.times[seen[0]] = time
    watched.heights[seen[0]] = moment / watched.mass
    seen[0] += 1


@njit(cache=True, error_model="numpy", inline="always")
def touches(watched, one, two):
    """Whether the vehicle touches something fixed in a contact of two geoms; -1 for no geom."""
    if one < 0 or two < 0:
        return False
    owners = watched.owners
    return owners[one] + owners[two] == OWN + FIXED and owners[one] * owners[two] == OWN * FIXED


@njit(cache=True, error_model="numpy")
def add_contact(watched, time):
    """Count the step that ended at a time [s], in which the vehicle touched something fixed."""
    watched.contact_steps[0] += 1
    if math.isnan(watched.first_contact[0]):
        watched.first_contact[0] = time


@njit(cache=True, error_model="numpy")
def is_calm(bounds, xipos, cvel):
    """Whether all moving bodies are far from where they could not be believed.

    Their centres of mass are (nbody, 3), their velocities (nbody, 6). Nothing is calm that is no
    number.
    """
    for body in range(cvel.shape[0]):
        for k in range(6):
            if not abs(cvel[body, k]) < bounds.fastest:
                return False
    return is_near(bounds, xipos)


@njit(cache=True, error_model="numpy")
def is_near(bounds, xipos):
    """Whether all moving bodies are near their start, and none is low."""
    bodies, start = bounds.bodies, bounds.start
    for n in range(bodies.shape[0]):
        for k in range(3):
            if not abs(xipos[bodies[n], k] - start[n, k]) < bounds.farthest:
                return False
        if xipos[bodies[n], 2] < bounds.lowest[n]:
            return False
    return True


@njit(cache=True, error_model="numpy")
def count_calm(bounds, centres, timestep):
    """How many poses of a run are calm, one timestep [s] apart, before the first that is not.

    `centres` (steps, nbody, 3) [m] are the centres of mass of all bodies. How far they move in a
    step is their velocity.
    """
    bodies = bounds.bodies
    for step in range(centres.shape[0]):
        if not is_near(bounds, centres[step]):
            return step
        for n in range(bodies.shape[0] if step > 0 else 0):
            for k in range(3):
                moved = centres[step, bodies[n], k] - centres[step - 1, bodies[n], k]
                if not abs(moved) < bounds.fastest * timestep:
                    return step
    return centres.shape[0]

"""A look at data after each step of a run, by addresses: is it calm, and what has it to tell."""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Int32s, Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.drafts import find_draft
from buoyancy_mj.kernels.entries.pointers import integers, word
from buoyancy_mj.kernels.entries.views import view
from buoyancy_mj.kernels.watching import (
    Bounds,
    Watched,
    add_contact,
    add_height,
    add_poses,
    is_calm,
    touches,
)

LAST_INFO, NUMBER = 0, 1
"""Columns of a warning."""


class Lookout(NamedTuple):
    """One data, and who is watched in it."""

    xpos: Annotated[Doubles, ("nbody", 3)]
    """Origins of the bodies [m]; these arrays are the engine's own."""
    xmat: Annotated[Doubles, ("nbody", 9)]
    """Their rotations world_from_body."""
    xipos: Annotated[Doubles, ("nbody", 3)]
    """Their centres of mass [m]."""
    cvel: Annotated[Doubles, ("nbody", 6)]
    """Their velocities, as `multibody.Bodies` has them."""
    warnings: Annotated[Int32s, ("w", 2)]
    """What MuJoCo counts."""
    bad_values: Annotated[Words, ("v",)]
    """Which of its warnings are of values that are no number."""
    bounds: Bounds
    """Within what all is calm."""
    watched: Annotated[Words, ("n",)]
    """Address of the `Watched` of each vehicle."""
    contact_count: int
    """Address of mjData.ncon."""
    contacts: int
    """Address of the word that holds the address of the contacts."""
    contact_size: int
    """Bytes of a contact."""
    contact_geoms: int
    """Bytes in it before its two geoms."""


@njit(cache=True, error_model="numpy")
def look(lookout, before, now):
    """See what a step from one time [s] to another has left, if all is calm.

    Returns 1 if it is not, and nothing has been added.
    """
    table = view(lookout, Lookout)
    for n in range(table.bad_values.shape[0]):
        if table.warnings[table.bad_values[n], NUMBER] != 0:
            return 1
    if not is_calm(table.bounds, table.xipos, table.cvel):
        return 1
    add_step(lookout, before, now)
    return 0


@njit(cache=True, error_model="numpy")
def add_step(lookout, before, now):
    """Keep of each vehicle what a step from one time [s] to another has left."""
    table = view(lookout, Lookout)
    count, _ = integers(table.contact_count)
    for n in range(table.watched.shape[0]):
        watched = view(table.watched[n], Watched)
        add_poses(watched, table.xpos, table.xmat, table.xipos, before)
        for contact in range(count):
            place = word(table.contacts) + contact * table.contact_size + table.contact_geoms
            one, other = integers(place)
            if touches(watched, one, other):
                add_contact(watched, now)
                break


@njit(cache=True, error_model="numpy")
def add_trajectory(watched, xpos, xmat, xipos, timestep):
    """Keep of a vehicle the poses of a whole run, (steps, ...), one timestep [s] apart from 0 s."""
    known = view(watched, Watched)
    for step in range(xpos.shape[0]):
        add_poses(known, xpos[step], xmat[step], xipos[step], step * timestep)


@njit(cache=True, error_model="numpy")
def add_instant(watched, xpos, xmat, xipos, time):
    """Keep of a vehicle the poses at one time [s]; the draft in them [m]."""
    known = view(watched, Watched)
    draft = find_draft(known.corners, xpos, xmat, time, -np.inf)
    known.peak[0] = max(known.peak[0], draft)
    add_height(known, xipos, time)
    return draft

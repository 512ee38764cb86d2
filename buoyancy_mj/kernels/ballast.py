"""Ballast that changes under way: bladders, and the water in tanks and compartments.

A bladder displaces more water: its geom's buoyancy, and what waves add to it, grow by the volume of
the bladder over that of the geom.

Water in a tank moves with its body as a rigid body of its own, whose mass, first and second moments
follow from how full the tank is. Their part that goes with accelerations stands in the mass matrix,
as that of added mass does; the rest, -I dv - C(v) v, and the weight are a load. The weight acts at
the centroid of the water with a level surface. Of all places of so much water that one has the
least energy, so the load is the slope of that energy, and none is made or lost; the inertia is that
of the water as it stands in the tank of an upright body, see `fills`.
"""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels import fills
from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.clip import CX, CY, CZ, VOLUME
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.fills import Fills
from buoyancy_mj.kernels.flooding import BLADDER, find_flow
from buoyancy_mj.kernels.inertia import add_matrix, set_to_body
from buoyancy_mj.kernels.reaction import add_coriolis, multiply, set_motion
from buoyancy_mj.kernels.vectors import difference, place, triple
from buoyancy_mj.kernels.vehicle.motion import find_velocity, set_water_velocity
from buoyancy_mj.kernels.wrenches import add_wrench


class Ballast(NamedTuple):
    """All ballast of a model that changes under way."""

    kinds: Annotated[Words, ("n",)]
    """What each is, `flooding.BLADDER` to `flooding.COMPARTMENT`."""
    bodies: Annotated[Words, ("n",)]
    """Index of the body that each moves with."""
    frames: Annotated[Words, ("n",)]
    """Index of its geom."""
    sites: Annotated[Words, ("n",)]
    """Index of the site where water comes in: the opening of a compartment."""
    addresses: Annotated[Words, ("n",)]
    """Index of its command in `ctrl`."""
    outputs: Annotated[Words, ("n",)]
    """Index of its actuator in `actuator_force`."""
    acts: Annotated[Words, ("n",)]
    """Index of its volume [m^3] among the states of actuators."""
    rows: Annotated[Words, ("n",)]
    """Row of a bladder's geom in `Record.wet`; -1 for others."""
    capacities: Annotated[Doubles, ("n",)]
    """Most that each holds [m^3]."""
    rates: Annotated[Doubles, ("n",)]
    """Fastest change of a bladder or a tank [m^3/s]."""
    openings: Annotated[Doubles, ("n",)]
    """Area of a compartment's opening times its coefficient of discharge [m^2]."""
    sealed: Annotated[Words, ("n",)]
    """1 for a compartment whose air cannot leave."""
    levels: Annotated[Words, ("n",)]
    """1 where the surface of the water stays level, 0 where a piston holds the water."""
    fills: Fills
    """The shapes of their geoms."""


@njit(cache=True, error_model="numpy", inline="always")
def held_volume(ballast, n, act):
    """What one holds [m^3], within its limits."""
    return min(max(act[ballast.acts[n]], 0.0), ballast.capacities[n])


@njit(cache=True, error_model="numpy")
def add_inertia(
    ballast,  # `Ballast`
    act,  # (na,) states of actuators
    density,  # of the water [kg/m^3]
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    mass_matrix,  # `multibody.MassMatrix`, written
):
    """Add the inertia of the water in tanks to the mass matrix; returns whether there is any."""
    changed = False
    count = ballast.kinds.shape[0]
    if count == 0:
        return changed
    p, g, half = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    moments, matrix = np.empty(fills.MOMENTS), np.empty(36)
    for n in range(count):
        volume = held_volume(ballast, n, act)
        if ballast.kinds[n] == BLADDER or not volume > 0.0:
            continue
        changed = True
        fills.set_moments(ballast.fills, n, volume, moments)
        fills.set_matrix(volume, moments, density, matrix)
        add_matrix(matrix, 1.0, bodies, joints, ballast.bodies[n], p, half, g, mass_matrix)
    return changed


@njit(cache=True, error_model="numpy")
def add_ballast(
    ballast,  # `Ballast`
    commands,  # `multibody.Commands`
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    gravity,  # downward acceleration [m/s^2]
    wet,  # (h, 8) submersion of the hulls, and of the geoms of bladders
    heads,  # (h, 6) pressure on them, see `pressure.press_hulls`
    out,  # (nbody, 6)
):
    """Add the loads of all ballast about `xipos`, but for what stands in the mass matrix."""
    p, v, rate = np.empty((6, 6)), np.empty(6), np.empty(6)
    momentum, f, water = np.empty(6), np.empty(6), np.empty(3)
    moments, matrix = np.empty(fills.MOMENTS), np.empty(36)
    for n in range(ballast.kinds.shape[0]):
        b, geom = ballast.bodies[n], ballast.frames[n]
        volume = held_volume(ballast, n, commands.act)
        com = bodies.xipos[b]
        if ballast.kinds[n] == BLADDER:
            share = volume / ballast.fills.volumes[n]
            weight = share * sea.density * gravity
            wavy = sea.pressure != 0 and sea.waves.shape[1] > 0
            origin = geoms.geom_xpos[geom]
            _add_bladder(ballast.rows[n], weight, wavy, wet, heads, origin, com, out[b])
            continue

        # the water's own motion, and its weight
        origin, r = bodies.xpos[b], bodies.xmat[b]
        set_to_body(bodies, b, p)
        set_motion(bodies, joints, b, p, v, rate)
        if volume > 0.0:
            fills.set_moments(ballast.fills, n, volume, moments)
            fills.set_matrix(volume, moments, sea.density, matrix)
            multiply(matrix, rate, f)
            multiply(matrix, v, momentum)
            add_coriolis(v, momentum, f)
            for i in range(6):
                f[i] = -f[i]
            add_wrench(r, origin, com, f, out[b])
            if ballast.levels[n] != 0:
                turn = geoms.geom_xmat[geom]
                _, _, cx, cy, cz = fills.find_level(
                    ballast.fills, n, turn[6], turn[7], turn[8], volume
                )
                at = place(geoms.geom_xpos[geom], turn, cx, cy, cz)
            else:
                at = place(origin, r, moments[0] / volume, moments[1] / volume, moments[2] / volume)
            _add_push(at, com, 0.0, 0.0, -sea.density * gravity * volume, out[b])

        # what comes aboard brings the momentum of the water around, and what leaves has the hull's;
        # what is aboard takes on the hull's wherever it lies, and not only at the opening
        if volume != commands.act[ballast.acts[n]]:
            continue
        flow = find_flow(ballast, n, commands, geoms, sea, time, timestep, gravity)
        if flow == 0.0:
            continue
        fills.set_growth(ballast.fills, n, volume, moments)
        fills.set_matrix(1.0, moments, -sea.density * flow, matrix)
        multiply(matrix, v, f)
        add_wrench(r, origin, com, f, out[b])
        at = triple(commands.site_xpos, ballast.sites[n], 0)
        if flow > 0.0:
            set_water_velocity(sea, at, time, water)
        else:
            water[0], water[1], water[2] = find_velocity(bodies, b, at)
        taken = sea.density * flow
        _add_push(at, com, taken * water[0], taken * water[1], taken * water[2], out[b])


@njit(cache=True, error_model="numpy", inline="always")
def _add_bladder(row, weight, wavy, wet, heads, origin, com, out):
    """Add a bladder's share of the buoyancy of its geom, or of the pressure on it, to `out` (6,).

    `weight` is the weight of water per volume [N/m^3], times that share.
    """
    if wavy:
        fx, fy, fz = weight * heads[row, 0], weight * heads[row, 1], weight * heads[row, 2]
        _add_push((origin[0], origin[1], origin[2]), com, fx, fy, fz, out)
        for i in range(3):
            out[3 + i] += weight * heads[row, 3 + i]
    elif wet[row, VOLUME] != 0.0:
        at = wet[row, CX], wet[row, CY], wet[row, CZ]
        _add_push(at, com, 0.0, 0.0, weight * wet[row, VOLUME], out)


@njit(cache=True, error_model="numpy", inline="always")
def _add_push(at, com, fx, fy, fz, out):
    """Add a force at a place, and its torque about a centre of mass, to `out` (6,)."""
    x, y, z = difference(at, com)
    out[0] += fx
    out[1] += fy
    out[2] += fz
    out[3] += y * fz - z * fy
    out[4] += z * fx - x * fz
    out[5] += x * fy - y * fx

"""Wrenches on bodies from what is wet: buoyancy, and drag from velocity relative to the water."""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels.waves import add_velocity


@njit(cache=True)
def add_buoyancy(wet, bodies, weight, xipos, out):
    """Add to rows of `out` (nbody, 6) the force `weight` [N/m^3] times volume upward at each hull's centroid.

    The torque is about `xipos`, the centre of mass of the body: where MuJoCo's xfrc_applied acts.
    """
    for h in range(bodies.shape[0]):
        if wet[h, 0] == 0.0:
            continue
        b = bodies[h]
        force = weight * wet[h, 0]
        out[b, 2] += force
        out[b, 3] += (wet[h, 2] - xipos[b, 1]) * force
        out[b, 4] -= (wet[h, 1] - xipos[b, 0]) * force


@njit(cache=True)
def add_drag(
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    bodies,  # (n,) bodies that have drag
    volumes,  # (n,) their whole volumes
    linear,  # (n, 6) force and torque per velocity along the body's axes
    quadratic,  # (n, 6) the same per velocity squared
    masses,  # (n,)
    inertias,  # (n, 3) about the body's axes, off-diagonal parts left out by the inverse's diagonal
    xipos,  # (nbody, 3)
    xmat,  # (nbody, 9)
    cvel,  # (nbody, 6) MuJoCo's: rotation, then translation at the root's centre of mass
    subtree_com,  # (nbody, 3)
    roots,  # (nbody,)
    level,
    waves,
    current,
    time,
    timestep,
    out,  # (nbody, 6)
):
    """Add linear and quadratic damping along each body's axes, scaled with the wet fraction of its volume.

    The force acts at the centroid of what is wet, on the velocity there relative to the water. An
    explicit force must not turn the motion round within a timestep, so each coefficient is held
    below the body's apparent mass there divided by the timestep.
    """
    water = np.empty(3)
    for n in range(bodies.shape[0]):
        b = bodies[n]
        volume = centres[b, 0]
        if not volume > 0.0:
            continue
        wet = min(volume / volumes[n], 1.0)
        root = roots[b]
        r = xmat[b]
        arm = centres[b, 1:] - xipos[b]
        far = centres[b, 1:] - subtree_com[root]
        w = cvel[b, :3]
        water[:] = current
        add_velocity(waves, centres[b, 1], centres[b, 2], centres[b, 3] - level, time, water)
        # velocity relative to the water, world frame
        ux = cvel[b, 3] + w[1] * far[2] - w[2] * far[1] - water[0]
        uy = cvel[b, 4] + w[2] * far[0] - w[0] * far[2] - water[1]
        uz = cvel[b, 5] + w[0] * far[1] - w[1] * far[0] - water[2]
        least_inertia = min(inertias[n, 0], inertias[n, 1], inertias[n, 2])
        squared_arm = arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]
        apparent = 1.0 / (1.0 / masses[n] + squared_arm / least_inertia)
        fx = fy = fz = tx = ty = tz = 0.0
        for i in range(3):
            ax, ay, az = r[i], r[3 + i], r[6 + i]
            speed = ux * ax + uy * ay + uz * az
            spin = w[0] * ax + w[1] * ay + w[2] * az
            push = wet * (linear[n, i] + quadratic[n, i] * abs(speed))
            twist = wet * (linear[n, 3 + i] + quadratic[n, 3 + i] * abs(spin))
            push = -min(push, apparent / timestep) * speed
            twist = -min(twist, inertias[n, i] / timestep) * spin
            fx, fy, fz = fx + push * ax, fy + push * ay, fz + push * az
            tx, ty, tz = tx + twist * ax, ty + twist * ay, tz + twist * az
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz
        out[b, 3] += tx + arm[1] * fz - arm[2] * fy
        out[b, 4] += ty + arm[2] * fx - arm[0] * fz
        out[b, 5] += tz + arm[0] * fy - arm[1] * fx


@njit(cache=True)
def merge(wet, owners, out):
    """Volume and centroid of the hulls of each owner, rows of `out` (n, 4); the centroid is NaN where all is dry."""
    out[:, :] = 0.0
    for h in range(owners.shape[0]):
        if wet[h, 0] == 0.0:
            continue
        row = out[owners[h]]
        row[0] += wet[h, 0]
        for c in range(3):
            row[1 + c] += wet[h, 0] * wet[h, 1 + c]
    for n in range(out.shape[0]):
        for c in range(1, 4):
            out[n, c] = out[n, c] / out[n, 0] if out[n, 0] != 0.0 else math.nan

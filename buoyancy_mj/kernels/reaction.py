"""The water's reaction to a body with added mass, but for what stands in the mass matrix.

The kinetic energy of the water is 1/2 s v'A v: v is the body's velocity relative to the water,
along the body's axes, and s the body's wet share. So the water opposes the body by

    - s A (dv - du) - s C(v) v - ds/dt A v + 1/2 (v'A v) grad s

(Lagrange's equations; Fossen 2021, sec. 6.3 and 8.1, for all but the change of s), where dv is the
rate of the body's own components, and du of the water's. In still water the power of all that is
the rate of that energy: none is made and none is lost.

The last two terms are what an entry brings. With slamming the last one, which gives half of the
momentum back, is left out while s grows: the water keeps ds/dt A v in full, as von Karman (1929,
NACA TN 321) has it, and carries half of the energy away as spray.
"""

import numpy as np

from buoyancy_mj.kernels.clip import CX
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.inertia import set_to_body
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.spatial_inertia import find_hold, set_inertia
from buoyancy_mj.kernels.vectors import rotate_back, triple
from buoyancy_mj.kernels.waves import add_motion
from buoyancy_mj.kernels.wet_share import set_gradient, wet_share
from buoyancy_mj.kernels.wrenches import add_wrench


@njit(cache=True, error_model="numpy")
def add_reaction(
    added_mass,  # `inertia.AddedMass`
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    wet,  # (h, 8) submersion of the hulls
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    out,  # (nbody, 6)
    slamming,  # (nbody, 6); no rows without slamming
    first,  # row of `added_mass`, and one past the last
    last,
):
    """Add the reaction about `xipos`, but for the part that goes with the joints' accelerations."""
    p, whole = np.empty((6, 6)), np.empty((6, 6))
    v, rate, momentum, f = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    gradient, change, kept = np.empty(6), np.empty(6), np.empty(6)
    hulls, hull_starts = added_mass.hulls, added_mass.hull_starts
    members, member_starts = added_mass.members, added_mass.member_starts
    for n in range(first, last):
        b, matrix, volume = added_mass.bodies[n], added_mass.matrices[n], added_mass.volumes[n]
        share = wet_share(centres, b, volume)
        if not share > 0.0:
            continue

        # how the body moves, how fast its wet share grows, and how it moves through the water
        set_to_body(bodies, b, p)
        set_motion(bodies, joints, b, p, v, rate)
        own = hulls[hull_starts[n] : hull_starts[n + 1]]
        place, r = bodies.xpos[b], bodies.xmat[b]
        growth = set_gradient(own, wet, volume, sea.level, sea.waves, time, r, place, gradient)
        growth += _dot(gradient, v)
        _subtract_water(sea, time, r, triple(centres, b, CX), v, rate)

        # what a share that stays brings
        multiply(matrix, rate, f)
        multiply(matrix, v, momentum)
        add_coriolis(v, momentum, f)
        for i in range(6):
            f[i] *= -share

        # what its change brings
        if gradient.any():
            keeps = added_mass.slamming != 0 and growth > 0.0
            _set_change(share, growth, gradient, v, momentum, timestep, keeps, change, kept)
            group = members[member_starts[n] : member_starts[n + 1]]
            set_inertia(bodies, b, group, matrix, share, whole)
            held = find_hold(whole, v, change, kept, timestep, rate)
            for i in range(6):
                f[i] += held * change[i]
                kept[i] *= held
            if keeps:
                add_wrench(r, place, bodies.xipos[b], kept, slamming[b])
        add_wrench(r, place, bodies.xipos[b], f, out[b])


@njit(cache=True, error_model="numpy")
def set_motion(bodies, joints, b, p, v, rate):
    """Write a body's velocity along its axes, and what the joints' velocities add to its rate."""
    spin0 = spin1 = spin2 = spin3 = spin4 = spin5 = 0.0
    i = last_dof(joints, b)
    while i >= 0:
        c, speed = joints.cdof_dot[i], joints.qvel[i]
        spin0, spin1, spin2 = spin0 + c[0] * speed, spin1 + c[1] * speed, spin2 + c[2] * speed
        spin3, spin4, spin5 = spin3 + c[3] * speed, spin4 + c[4] * speed, spin5 + c[5] * speed
        i = joints.dof_parentid[i]
    spin, cvel = (spin0, spin1, spin2, spin3, spin4, spin5), bodies.cvel[b]
    for i in range(6):
        v[i], rate[i] = _dot(p[i], cvel), _dot(p[i], spin)


@njit(cache=True, error_model="numpy")
def _subtract_water(sea, time, r, at, v, rate):
    """Make a velocity, and its rate, relative to the water at a place."""
    water, rush = np.empty(3), np.empty(3)
    x, y, z = at
    set_current(sea.current, sea.level - z, time, water)
    set_rate(sea.current, time, rush)
    add_motion(sea.waves, x, y, z - sea.level, time, water, rush)
    u0, u1, u2 = rotate_back(r, water[0], water[1], water[2])
    a0, a1, a2 = rotate_back(r, rush[0], rush[1], rush[2])

    # the rate of the water's components, in axes that turn
    w0, w1, w2 = v[3], v[4], v[5]
    rate[0] -= a0 - (w1 * u2 - w2 * u1)
    rate[1] -= a1 - (w2 * u0 - w0 * u2)
    rate[2] -= a2 - (w0 * u1 - w1 * u0)
    v[0], v[1], v[2] = v[0] - u0, v[1] - u1, v[2] - u2


@njit(cache=True, error_model="numpy", inline="always")
def _set_change(share, growth, gradient, v, momentum, timestep, keeps, change, kept):
    """Write -ds/dt A v + 1/2 (v'A v) grad s to `change` (6,), and what slamming keeps to `kept`.

    A share that shrinks to nothing within the timestep gives back only what is left of it.
    """
    shrinkage = -growth * timestep
    factor = share / shrinkage if shrinkage > share else 1.0
    lift = 0.5 * _dot(v, momentum)
    for i in range(6):
        change[i] = factor * (lift * gradient[i] - growth * momentum[i])
        kept[i] = -lift * gradient[i] if keeps else 0.0


@njit(cache=True, error_model="numpy", inline="always")
def _dot(x, y):
    """The scalar product of two vectors (6,)."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + x[3] * y[3] + x[4] * y[4] + x[5] * y[5]


@njit(cache=True, error_model="numpy", inline="always")
def multiply(matrix, x, out):
    """Write a matrix, row by row (36,), times a vector (6,) to `out` (6,)."""
    for i in range(6):
        total = 0.0
        for k in range(6):
            total += matrix[6 * i + k] * x[k]
        out[i] = total


@njit(cache=True, error_model="numpy", inline="always")
def add_coriolis(v, momentum, f):
    """Add C(v) v = (w x p, v x p + w x h) to `f` (6,).

    w is the rotation in v, and p, h are the momentum A v.
    """
    p0, p1, p2 = momentum[0], momentum[1], momentum[2]
    h0, h1, h2 = momentum[3], momentum[4], momentum[5]
    w0, w1, w2 = v[3], v[4], v[5]
    f[0] += w1 * p2 - w2 * p1
    f[1] += w2 * p0 - w0 * p2
    f[2] += w0 * p1 - w1 * p0
    f[3] += v[1] * p2 - v[2] * p1 + w1 * h2 - w2 * h1
    f[4] += v[2] * p0 - v[0] * p2 + w2 * h0 - w0 * h2
    f[5] += v[0] * p1 - v[1] * p0 + w0 * h1 - w1 * h0

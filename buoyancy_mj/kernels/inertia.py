"""Added mass: in the engine's mass matrix, and the rest of the water's reaction as a load.

The water's kinetic energy is 1/2 s v'A v, with v the body's velocity relative to the water, along
the body's axes, and s the wet share of the body. So the water opposes the body by

    - s A (dv - du) - s C(v) v - ds/dt A v + 1/2 (v'A v) grad s

(Lagrange's equations; Fossen 2021, sec. 6.3 and 8.1, for all but the change of s), where dv is the
rate of the body's own components and du of the water's. In still water the power of all that is the
rate of that energy: none is made or lost. The part -s A dv that goes with the engine's
accelerations stands in its mass matrix, so that it cannot be unstable.

Of the momentum that an entry takes the water carries a part away, as spray. With `slamming` the
water then keeps ds/dt A v in full, as von Karman (1929, NACA TN 321) has it: the last term, which
gives half of it back, is left out while s grows.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.clip import CX
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.spatial_inertia import find_hold, set_inertia
from buoyancy_mj.kernels.vectors import difference, rotate, rotate_back, triple
from buoyancy_mj.kernels.waves import add_acceleration, add_velocity
from buoyancy_mj.kernels.wet_share import set_gradient, wet_share


class AddedMass(NamedTuple):
    """Added mass of those bodies that have one, when fully wet."""

    bodies: Annotated[Words, ("n",)]
    """Indices of the bodies in the model."""
    volumes: Annotated[Doubles, ("n",)]
    """Volume of the hulls of each [m^3]."""
    matrices: Annotated[Doubles, ("n", 36)]
    """Row by row [kg, kg m, kg m^2]: surge, sway, heave, roll, pitch, yaw along the axes of each
    body, about its origin."""
    hulls: Annotated[Words, ("h",)]
    """Indices of the hulls of each, one body after the other."""
    hull_starts: Annotated[Words, ("n + 1",)]
    """Where those of each body begin, and the end of all."""
    members: Annotated[Words, ("m",)]
    """Indices of each body and of all that is welded to it, one body after the other."""
    member_starts: Annotated[Words, ("n + 1",)]
    """Where those of each body begin, and the end of all."""
    slamming: int
    """1 where the water keeps the momentum that an entry takes."""


@njit(cache=True, error_model="numpy")
def add_inertia(
    added_mass,  # `AddedMass`
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    mass_matrix,  # `multibody.MassMatrix`, written
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
):
    """Add J^T A J of each body to the mass matrix, scaled with the wet part of its volume.

    Returns whether any body was wet.
    """
    p, g, half, u = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6)), np.empty(6)
    changed = False
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        share = wet_share(centres, b, added_mass.volumes[n])
        if not share > 0.0:
            continue
        changed = True
        _to_body(bodies, b, p)
        _transform(added_mass.matrices[n], p, share, half, g)
        i = last_dof(joints, b)
        while i >= 0:
            for k in range(6):
                u[k] = 0.0
                for m in range(6):
                    u[k] += g[k, m] * joints.cdof[i, m]
            _add_row(joints, mass_matrix, i, u)
            i = joints.dof_parentid[i]
    return changed


@njit(cache=True, error_model="numpy")
def _to_body(bodies, b, out):
    """Write the matrix (6, 6) from MuJoCo's velocities of a body to those along its own axes.

    MuJoCo's are rotation, then translation at the root's centre of mass; the body's are at its
    origin.
    """
    r = bodies.xmat[b]
    arm = difference(bodies.xpos[b], bodies.subtree_com[bodies.body_rootid[b]])
    for i in range(3):
        a0, a1, a2 = r[i], r[3 + i], r[6 + i]
        out[i, 0] = arm[1] * a2 - arm[2] * a1
        out[i, 1] = arm[2] * a0 - arm[0] * a2
        out[i, 2] = arm[0] * a1 - arm[1] * a0
        out[i, 3], out[i, 4], out[i, 5] = a0, a1, a2
        out[3 + i, 0], out[3 + i, 1], out[3 + i, 2] = a0, a1, a2
        out[3 + i, 3:6] = 0.0


@njit(cache=True, error_model="numpy", inline="always")
def _transform(matrix, p, factor, half, out):
    """Write factor p^T A p of a matrix A, row by row (36,), to `out` (6, 6); `half` is scratch."""
    for i in range(6):
        for j in range(6):
            total = 0.0
            for k in range(6):
                total += matrix[6 * i + k] * p[k, j]
            half[i, j] = factor * total
    for i in range(6):
        for j in range(6):
            total = 0.0
            for k in range(6):
                total += p[k, i] * half[k, j]
            out[i, j] = total


@njit(cache=True, error_model="numpy", inline="always")
def _add_row(joints, mass_matrix, i, u):
    """Add to row i of the mass matrix the products of u (6,) with the axes of its columns."""
    # the columns of a row are the degree of freedom itself, last, and those above it
    first = mass_matrix.M_rowadr[i]
    for e in range(first, first + mass_matrix.M_rownnz[i]):
        c = joints.cdof[mass_matrix.M_colind[e]]
        mass_matrix.M[e] += (
            c[0] * u[0] + c[1] * u[1] + c[2] * u[2] + c[3] * u[3] + c[4] * u[4] + c[5] * u[5]
        )


@njit(cache=True, error_model="numpy")
def add_reaction(
    added_mass,
    bodies,
    joints,
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    wet,  # (h, 8) submersion of the hulls
    centres,
    out,  # (nbody, 6)
    slamming,  # (nbody, 6); no rows without slamming
):
    """Add the reaction about `xipos`, but for the part that goes with the joints' accelerations.

    That part, -s A times what the accelerations bring, stands in the mass matrix.
    """
    p, whole = np.empty((6, 6)), np.empty((6, 6))
    water, rush = np.empty(3), np.empty(3)
    spin, rate, v, f = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    gradient, change, kept = np.empty(6), np.empty(6), np.empty(6)
    hulls, hull_starts = added_mass.hulls, added_mass.hull_starts
    members, member_starts = added_mass.members, added_mass.member_starts
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        share = wet_share(centres, b, added_mass.volumes[n])
        if not share > 0.0:
            continue
        r = bodies.xmat[b]
        _to_body(bodies, b, p)

        # what the velocities of the joints bring to the acceleration
        spin[:] = 0.0
        i = last_dof(joints, b)
        while i >= 0:
            for k in range(6):
                spin[k] += joints.cdof_dot[i, k] * joints.qvel[i]
            i = joints.dof_parentid[i]
        for i in range(6):
            v[i] = rate[i] = 0.0
            for k in range(6):
                v[i] += p[i, k] * bodies.cvel[b, k]
                rate[i] += p[i, k] * spin[k]

        # how fast the wet share grows
        growth = set_gradient(
            hulls[hull_starts[n] : hull_starts[n + 1]],
            wet,
            added_mass.volumes[n],
            sea.level,
            sea.waves,
            time,
            r,
            bodies.xpos[b],
            gradient,
        )
        growth += _dot(gradient, v)

        # the water's velocity and acceleration at the centroid
        x, y, z = triple(centres, b, CX)
        set_current(sea.current, sea.level - z, time, water)
        set_rate(sea.current, time, rush)
        add_velocity(sea.waves, x, y, z - sea.level, time, water)
        add_acceleration(sea.waves, x, y, z - sea.level, time, rush)
        u0, u1, u2 = rotate_back(r, water[0], water[1], water[2])
        a0, a1, a2 = rotate_back(r, rush[0], rush[1], rush[2])

        # relative to it: the rate of the water's components in axes that turn
        w0, w1, w2 = v[3], v[4], v[5]
        rate[0] -= a0 - (w1 * u2 - w2 * u1)
        rate[1] -= a1 - (w2 * u0 - w0 * u2)
        rate[2] -= a2 - (w0 * u1 - w1 * u0)
        v[0], v[1], v[2] = v[0] - u0, v[1] - u1, v[2] - u2
        _multiply(added_mass.matrices[n], rate, f)
        _multiply(added_mass.matrices[n], v, spin)
        _add_coriolis(v, spin, f)
        for i in range(6):
            f[i] *= -share

        # what the change of the wet share brings
        if gradient[0] != 0.0 or gradient[1] != 0.0 or gradient[2] != 0.0:
            keeps = added_mass.slamming != 0 and growth > 0.0
            _set_change(share, growth, gradient, v, spin, timestep, keeps, change, kept)
            for i in range(6):
                rate[i] = change[i] + kept[i]
            group = members[member_starts[n] : member_starts[n + 1]]
            set_inertia(bodies, b, group, added_mass.matrices[n], share, whole)
            held = find_hold(whole, v, rate, timestep, spin)
            for i in range(6):
                f[i] += held * change[i]
                kept[i] *= held
            if keeps:
                _deliver(bodies, b, kept, slamming[b])
        _deliver(bodies, b, f, out[b])


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
def _deliver(bodies, b, f, out):
    """Add a wrench at a body's origin, along its axes, to `out` (6,): about `xipos`, world axes."""
    r = bodies.xmat[b]
    fx, fy, fz = rotate(r, f[0], f[1], f[2])
    tx, ty, tz = rotate(r, f[3], f[4], f[5])
    x, y, z = difference(bodies.xpos[b], bodies.xipos[b])
    out[0] += fx
    out[1] += fy
    out[2] += fz
    out[3] += tx + y * fz - z * fy
    out[4] += ty + z * fx - x * fz
    out[5] += tz + x * fy - y * fx


@njit(cache=True, error_model="numpy", inline="always")
def _dot(x, y):
    """The scalar product of two vectors (6,)."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2] + x[3] * y[3] + x[4] * y[4] + x[5] * y[5]


@njit(cache=True, error_model="numpy", inline="always")
def _multiply(matrix, x, out):
    """Write a matrix, row by row (36,), times a vector (6,) to `out` (6,)."""
    for i in range(6):
        total = 0.0
        for k in range(6):
            total += matrix[6 * i + k] * x[k]
        out[i] = total


@njit(cache=True, error_model="numpy", inline="always")
def _add_coriolis(v, momentum, f):
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

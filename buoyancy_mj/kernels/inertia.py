"""Added mass: in the engine's mass matrix, and the rest of the water's reaction as a load.

The water opposes a body's motion with -A (dv - du) - C(v - u) (v - u), in the body's axes: v its
velocity, dv the rate of those components, u the water's there (Fossen 2021, sec. 6.3 and 8.1). The
part -A dv that goes with the engine's accelerations stands in its mass matrix, so that it cannot be
unstable.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.clip import CX, VOLUME
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import difference, rotate, rotate_back, scale, triple
from buoyancy_mj.kernels.waves import add_motion


class AddedMass(NamedTuple):
    """Added mass of those bodies that have one, when fully wet."""

    bodies: Annotated[Words, ("n",)]
    """Indices of the bodies in the model."""
    volumes: Annotated[Doubles, ("n",)]
    """Volume of the hulls of each [m^3]."""
    matrices: Annotated[Doubles, ("n", 36)]
    """Row by row [kg, kg m, kg m^2]: surge, sway, heave, roll, pitch, yaw along the axes of each
    body, about its origin."""


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
    p, g, u = np.empty((6, 6)), np.empty((6, 6)), np.empty(6)
    changed = False
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        wet = _wet_part(centres, b, added_mass.volumes[n])
        if not wet > 0.0:
            continue
        changed = True
        _to_body(bodies, b, p)
        _transform(added_mass.matrices[n], p, wet, g)
        i = last_dof(joints, b)
        while i >= 0:
            for k in range(6):
                u[k] = 0.0
                for m in range(6):
                    u[k] += g[k, m] * joints.cdof[i, m]
            _add_row(joints, mass_matrix, i, u)
            i = joints.dof_parentid[i]
    return changed


@njit(cache=True, error_model="numpy", inline="always")
def _wet_part(centres, b, volume):
    """The part of a body's volume that is wet."""
    return min(centres[b, VOLUME] / volume, 1.0)


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
def _transform(matrix, p, factor, out):
    """Write factor p^T A p of a matrix A, row by row (36,), to `out` (6, 6)."""
    for i in range(6):
        for j in range(6):
            total = 0.0
            for k in range(6):
                for m in range(6):
                    total += p[k, i] * matrix[6 * k + m] * p[m, j]
            out[i, j] = factor * total


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
    centres,
    out,  # (nbody, 6)
):
    """Add the reaction about `xipos`, but for the part that goes with the joints' accelerations.

    That part, -A times what the accelerations bring, stands in the mass matrix.
    """
    p = np.empty((6, 6))
    water, rush = np.empty(3), np.empty(3)
    spin, rate, v, f = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        wet = _wet_part(centres, b, added_mass.volumes[n])
        if not wet > 0.0:
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

        # the water's velocity and acceleration at the centroid
        x, y, z = triple(centres, b, CX)
        set_current(sea.current, sea.level - z, time, water)
        set_rate(sea.current, time, rush)
        add_motion(sea.waves, x, y, z - sea.level, time, water, rush)
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

        # minus all that, about the centre of mass
        fx, fy, fz = scale(-wet, rotate(r, f[0], f[1], f[2]))
        tx, ty, tz = scale(wet, rotate(r, f[3], f[4], f[5]))
        x, y, z = difference(bodies.xpos[b], bodies.xipos[b])
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz
        out[b, 3] += y * fz - z * fy - tx
        out[b, 4] += z * fx - x * fz - ty
        out[b, 5] += x * fy - y * fx - tz


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

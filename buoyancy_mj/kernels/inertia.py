"""Added mass: into the engine's own mass matrix, and what of it depends on velocities and the water's acceleration.

The water opposes a body's motion with -A (dv - du) - C(v - u) (v - u), in the body's axes: v its velocity,
dv the rate of those components, u the water's there (Fossen 2021, sec. 6.3 and 8.1). The part -A dv that
goes with the engine's accelerations stands in its mass matrix, so that it cannot be unstable.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.currents import set_current, set_rate
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.waves import add_acceleration, add_velocity


class AddedMass(NamedTuple):
    """Added mass of those bodies that have one, when fully wet."""

    bodies: Annotated[Words, ("n",)]
    """Indices of the bodies in the model."""
    volumes: Annotated[Doubles, ("n",)]
    """Volume of the hulls of each [m^3]."""
    matrices: Annotated[Doubles, ("n", 36)]
    """Row by row [kg, kg m, kg m^2]: surge, sway, heave, roll, pitch, yaw along the axes of each body, about its origin."""


@njit(cache=True, error_model="numpy")
def _to_body(r, arm, out):
    """The matrix (6, 6) from MuJoCo's velocities (rotation, translation `arm` off) to translation, rotation along r."""
    for i in range(3):
        a0, a1, a2 = r[i], r[3 + i], r[6 + i]
        out[i, 0], out[i, 1], out[i, 2] = (
            arm[1] * a2 - arm[2] * a1,
            arm[2] * a0 - arm[0] * a2,
            arm[0] * a1 - arm[1] * a0,
        )
        out[i, 3], out[i, 4], out[i, 5] = a0, a1, a2
        out[3 + i, 0], out[3 + i, 1], out[3 + i, 2] = a0, a1, a2
        out[3 + i, 3:6] = 0.0


@njit(cache=True, error_model="numpy", inline="always")
def _share(centres, b, volume):
    """The part of a body's volume that is wet."""
    return min(centres[b, 0] / volume, 1.0)


@njit(cache=True, error_model="numpy")
def add_inertia(
    added_mass,  # `AddedMass`
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    mass_matrix,  # `multibody.MassMatrix`, written
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
):
    """Add J^T A J of each body, scaled with the wet part of its volume; gives whether any was."""
    p, g = np.empty((6, 6)), np.empty((6, 6))
    u = np.empty(6)
    changed = False
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        wet = _share(centres, b, added_mass.volumes[n])
        if not wet > 0.0:
            continue
        changed = True
        _to_body(bodies.xmat[b], bodies.xpos[b] - bodies.subtree_com[bodies.body_rootid[b]], p)
        for i in range(6):
            for j in range(6):
                total = 0.0
                for k in range(6):
                    for m in range(6):
                        total += p[k, i] * added_mass.matrices[n, 6 * k + m] * p[m, j]
                g[i, j] = wet * total
        i = last_dof(joints, b)
        while i >= 0:
            for k in range(6):
                u[k] = 0.0
                for m in range(6):
                    u[k] += g[k, m] * joints.cdof[i, m]
            first = mass_matrix.M_rowadr[i]
            # the columns of a row are the dof itself, last, and those above it
            for e in range(first, first + mass_matrix.M_rownnz[i]):
                c = joints.cdof[mass_matrix.M_colind[e]]
                mass_matrix.M[e] += (
                    c[0] * u[0]
                    + c[1] * u[1]
                    + c[2] * u[2]
                    + c[3] * u[3]
                    + c[4] * u[4]
                    + c[5] * u[5]
                )
            i = joints.dof_parentid[i]
    return changed


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
    """Add the rest of the reaction, about `xipos`: all but -A times what the accelerations of the joints bring."""
    p = np.empty((6, 6))
    water, rush = np.empty(3), np.empty(3)
    spin, rate, v, f = np.empty(6), np.empty(6), np.empty(6), np.empty(6)
    for n in range(added_mass.bodies.shape[0]):
        b = added_mass.bodies[n]
        wet = _share(centres, b, added_mass.volumes[n])
        if not wet > 0.0:
            continue
        r = bodies.xmat[b]
        _to_body(r, bodies.xpos[b] - bodies.subtree_com[bodies.body_rootid[b]], p)
        # what the velocities of the joints bring to the acceleration
        spin[:] = 0.0
        i = last_dof(joints, b)
        while i >= 0:
            for k in range(6):
                spin[k] += joints.cdof_dot[i, k] * joints.qvel[i]
            i = joints.dof_parentid[i]
        set_current(sea.current, sea.level - centres[b, 3], time, water)
        set_rate(sea.current, time, rush)
        add_velocity(
            sea.waves, centres[b, 1], centres[b, 2], centres[b, 3] - sea.level, time, water
        )
        add_acceleration(
            sea.waves, centres[b, 1], centres[b, 2], centres[b, 3] - sea.level, time, rush
        )
        for i in range(6):
            v[i] = rate[i] = 0.0
            for k in range(6):
                v[i] += p[i, k] * bodies.cvel[b, k]
                rate[i] += p[i, k] * spin[k]
        u0, u1, u2 = _along(r, water)
        a0, a1, a2 = _along(r, rush)
        w0, w1, w2 = v[3], v[4], v[5]
        # the rate of the water's components in axes that turn
        rate[0] -= a0 - (w1 * u2 - w2 * u1)
        rate[1] -= a1 - (w2 * u0 - w0 * u2)
        rate[2] -= a2 - (w0 * u1 - w1 * u0)
        v[0], v[1], v[2] = v[0] - u0, v[1] - u1, v[2] - u2
        for i in range(6):
            f[i] = _product(added_mass.matrices[n], i, rate)
            spin[i] = _product(added_mass.matrices[n], i, v)
        # C(v) v = (w x p, v x p + w x h) with momentum p, h
        f[0] += w1 * spin[2] - w2 * spin[1]
        f[1] += w2 * spin[0] - w0 * spin[2]
        f[2] += w0 * spin[1] - w1 * spin[0]
        f[3] += v[1] * spin[2] - v[2] * spin[1] + w1 * spin[5] - w2 * spin[4]
        f[4] += v[2] * spin[0] - v[0] * spin[2] + w2 * spin[3] - w0 * spin[5]
        f[5] += v[0] * spin[1] - v[1] * spin[0] + w0 * spin[4] - w1 * spin[3]
        fx = -wet * (r[0] * f[0] + r[1] * f[1] + r[2] * f[2])
        fy = -wet * (r[3] * f[0] + r[4] * f[1] + r[5] * f[2])
        fz = -wet * (r[6] * f[0] + r[7] * f[1] + r[8] * f[2])
        at, com = bodies.xpos[b], bodies.xipos[b]
        x, y, z = at[0] - com[0], at[1] - com[1], at[2] - com[2]
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz
        out[b, 3] += y * fz - z * fy - wet * (r[0] * f[3] + r[1] * f[4] + r[2] * f[5])
        out[b, 4] += z * fx - x * fz - wet * (r[3] * f[3] + r[4] * f[4] + r[5] * f[5])
        out[b, 5] += x * fy - y * fx - wet * (r[6] * f[3] + r[7] * f[4] + r[8] * f[5])


@njit(cache=True, error_model="numpy", inline="always")
def _along(r, x):
    """A vector of the world along the axes of r."""
    return (
        r[0] * x[0] + r[3] * x[1] + r[6] * x[2],
        r[1] * x[0] + r[4] * x[1] + r[7] * x[2],
        r[2] * x[0] + r[5] * x[1] + r[8] * x[2],
    )


@njit(cache=True, error_model="numpy", inline="always")
def _product(matrix, i, x):
    """Row i of a matrix (36,) times a vector (6,)."""
    total = 0.0
    for k in range(6):
        total += matrix[6 * i + k] * x[k]
    return total

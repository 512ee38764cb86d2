"""Added mass of bodies, and its place in the engine's mass matrix.

The water's kinetic energy is 1/2 s v'A v, with A the added mass of a body that is fully wet, v its
velocity relative to the water, along its axes, and s its wet share. What goes with the engine's
accelerations, -s A dv, stands in its mass matrix, so that it cannot be unstable; `reaction` has the
rest.
"""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import difference
from buoyancy_mj.kernels.wet_share import wet_share


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
    first,  # row of `added_mass`, and one past the last
    last,
):
    """Add J^T A J of bodies to the mass matrix, scaled with the wet part of their volumes.

    The bodies of one kinematic tree have elements in common. So those of a tree that begins before
    the first row are left out, and those of one that begins before the last are all done.
    """
    p, g, half = np.empty((6, 6)), np.empty((6, 6)), np.empty((6, 6))
    begin = _next_tree(added_mass.bodies, bodies.body_rootid, first)
    end = _next_tree(added_mass.bodies, bodies.body_rootid, last)
    for n in range(begin, end):
        b = added_mass.bodies[n]
        share = wet_share(centres, b, added_mass.volumes[n])
        if not share > 0.0:
            continue
        add_matrix(added_mass.matrices[n], share, bodies, joints, b, p, half, g, mass_matrix)


@njit(cache=True, error_model="numpy")
def is_wet(added_mass, centres):
    """Whether any body that has added mass is wet."""
    for n in range(added_mass.bodies.shape[0]):
        if wet_share(centres, added_mass.bodies[n], added_mass.volumes[n]) > 0.0:
            return True
    return False


@njit(cache=True, error_model="numpy", inline="always")
def _next_tree(bodies, roots, n):
    """The first row, from n on, whose body is of another tree than that of the row before."""
    while 0 < n < bodies.shape[0] and roots[bodies[n]] == roots[bodies[n - 1]]:
        n += 1
    return n


@njit(cache=True, error_model="numpy")
def add_matrix(matrix, share, bodies, joints, b, p, half, g, mass_matrix):
    """Add J^T A J of one body to the mass matrix, for a share of the matrix A, row by row (36,).

    A is along the axes of the body, about its origin; `p`, `half` and `g` (6, 6) are scratch.
    """
    u = np.empty(6)
    set_to_body(bodies, b, p)
    _transform(matrix, p, share, half, g)
    i = last_dof(joints, b)
    while i >= 0:
        for k in range(6):
            u[k] = 0.0
            for m in range(6):
                u[k] += g[k, m] * joints.cdof[i, m]
        _add_row(joints, mass_matrix, i, u)
        i = joints.dof_parentid[i]


@njit(cache=True, error_model="numpy")
def set_to_body(bodies, b, out):
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

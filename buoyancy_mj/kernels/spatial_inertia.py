"""The inertia (6, 6) of a rigid body with its added mass, and what a wrench can do against it.

Velocities are translation, then rotation, along the body's axes and at its origin; so are wrenches.
"""

import math

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.vectors import difference, rotate_back


@njit(cache=True, error_model="numpy")
def set_inertia(
    bodies,  # `multibody.Bodies`
    b,  # the body
    members,  # indices of the body and of all that is welded to it
    added,  # (36,) added mass, row by row
    share,  # the part of it that counts
    out,  # (6, 6) written
):
    """Write the inertia of a body, of all that is welded to it, and of a share of its added mass.

    Only the lower triangle is written.
    """
    masses, inertias = bodies.body_mass, bodies.body_inertia
    xipos, ximat, origin, r = bodies.xipos, bodies.ximat, bodies.xpos[b], bodies.xmat[b]
    for i in range(6):
        for j in range(i + 1):
            out[i, j] = share * added[6 * i + j]
    for k in members:
        # its mass, at its centre
        m = masses[k]
        x, y, z = difference(xipos[k], origin)
        x, y, z = rotate_back(r, x, y, z)
        for i in range(3):
            out[i, i] += m
        out[3, 1] -= m * z
        out[3, 2] += m * y
        out[4, 0] += m * z
        out[4, 2] -= m * x
        out[5, 0] -= m * y
        out[5, 1] += m * x
        out[3, 3] += m * (y * y + z * z)
        out[4, 4] += m * (z * z + x * x)
        out[5, 5] += m * (x * x + y * y)
        out[4, 3] -= m * x * y
        out[5, 3] -= m * z * x
        out[5, 4] -= m * y * z

        # its inertia about that, by its principal axes
        for a in range(3):
            x, y, z = rotate_back(r, ximat[k, a], ximat[k, 3 + a], ximat[k, 6 + a])
            moment = inertias[k, a]
            out[3, 3] += moment * x * x
            out[4, 4] += moment * y * y
            out[5, 5] += moment * z * z
            out[4, 3] += moment * x * y
            out[5, 3] += moment * z * x
            out[5, 4] += moment * y * z


@njit(cache=True, error_model="numpy")
def find_hold(
    inertia,  # (6, 6) lower triangle; its Cholesky factor afterwards
    v,  # (6,) velocity
    wrench,  # (6,)
    more,  # (6,), which is added to it
    timestep,  # [s]
    work,  # (6,) scratch
):
    """The factor, at most 1, that keeps a wrench from turning a motion round within a timestep.

    In the norm of the kinetic energy the wrench then changes the velocity by no more than the
    velocity itself. Joints only make a body harder to move (Gauss's principle), so that of a body
    in a linkage the wrench changes less. It is 0 for what has no inertia.
    """
    energy = 0.0
    for i in range(6):
        for j in range(i):
            energy += 2.0 * inertia[i, j] * v[i] * v[j]
        energy += inertia[i, i] * v[i] * v[i]

    # what the wrench brings, by the Cholesky factor
    change = 0.0
    for i in range(6):
        for j in range(i):
            total = inertia[i, j]
            for k in range(j):
                total -= inertia[i, k] * inertia[j, k]
            inertia[i, j] = total / inertia[j, j]
        pivot, total = inertia[i, i], wrench[i] + more[i]
        for k in range(i):
            pivot -= inertia[i, k] * inertia[i, k]
            total -= inertia[i, k] * work[k]
        if not pivot > 0.0:
            return 0.0
        inertia[i, i] = math.sqrt(pivot)
        work[i] = total / inertia[i, i]
        change += work[i] * work[i]
    change *= timestep * timestep
    return math.sqrt(energy / change) if change > energy else 1.0

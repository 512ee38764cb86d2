"""Explicit forces that oppose motion, held so that none turns a motion round within a timestep.

A force that grows with velocity by D (6, 6) on a body of mobility L (6, 6), the acceleration per
force, slows its motions down at rates that are the eigenvalues of D L. Here L is that of the whole
tree of bodies, from MuJoCo's factors of the mass matrix. Wrenches are torque, then force, about the
centre of mass of the tree, as MuJoCo's `cdof` has velocities.
"""

import math

import numpy as np

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import difference


@inner
def set_mobility(joints, mass_matrix, b, rows, out):
    """Write J M^-1 J^T of a body to `out` (6, 6); `rows` (6, nv) are worked in.

    With MuJoCo's M = L^T D L only the joints that carry the body matter: L^-T leads from each to
    those above it.
    """
    cdof, parents = joints.cdof, joints.dof_parentid
    lower, inverse, columns = mass_matrix.qLD, mass_matrix.qLDiagInv, mass_matrix.M_colind
    firsts, counts = mass_matrix.M_rowadr, mass_matrix.M_rownnz
    last = last_dof(joints, b)
    i = last
    while i >= 0:
        for k in range(6):
            rows[k, i] = cdof[i, k]
        i = parents[i]
    out[:, :] = 0.0
    i = last
    while i >= 0:
        for e in range(firsts[i], firsts[i] + counts[i] - 1):
            for k in range(6):
                rows[k, columns[e]] -= lower[e] * rows[k, i]
        for k in range(6):
            for m in range(6):
                out[k, m] += rows[k, i] * rows[m, i] * inverse[i]
        i = parents[i]


@njit(cache=True, error_model="numpy", inline="always")
def set_push(at, com, normal, out):
    """Write the wrench (6,) of a unit force along a normal at a place."""
    x, y, z = difference(at, com)
    fx, fy, fz = normal
    out[0], out[1], out[2] = y * fz - z * fy, z * fx - x * fz, x * fy - y * fx
    out[3], out[4], out[5] = fx, fy, fz


@njit(cache=True, error_model="numpy", inline="always")
def quadratic(matrix, v):
    """v^T A v of a matrix A (6, 6)."""
    total = 0.0
    for i in range(6):
        for j in range(6):
            total += v[i] * matrix[i, j] * v[j]
    return total


@njit(cache=True, error_model="numpy", inline="always")
def excess(stiffness):
    """How far the sum of all rates is beyond what a timestep can bear.

    It is the x of `hold` for the sum, where `stiffness` is that sum times the timestep: the root of
    stiffness (1 + x) = 1 + x + x^2, and 0 where the stiffness is 1.
    """
    beyond = stiffness - 1.0
    return 0.5 * (beyond + math.sqrt(beyond * beyond + 4.0 * beyond))


@njit(cache=True, error_model="numpy")
def hold(damping, mobility, velocity, time, step, xipos, com, out):
    """Hold the wrench `out` (6,), force and torque about `xipos`, below a rate.

    It becomes (1 + X) / (1 + X + X^2) of it, with X the `time` times D L. So fast motions lose most
    of their force, and slow ones what is of second order. With `excess` over the sum of all rates
    as the time, no motion is slowed down at more than one over the timestep: the held rate grows
    with the rate, and that of a motion that has all of the sum is one over the timestep.

    D knows the forces along the normal. Lift also pushes and turns foils within their planes, with
    what it takes from the motion along the normal; where that is held, this is held too: within a
    `step` the wrench adds no more energy than it would have added as it was.

    Args:
        damping: D (6, 6).
        mobility: L (6, 6).
        velocity: of the body through the water (6,), rotation first.
        time: see above [s].
        step: the timestep over the body's share of all rates [s].
        xipos: where the wrench acts.
        com: the centre of mass of the tree.
        out: the wrench.
    """
    # torques about the centre of mass of the tree
    x, y, z = difference(xipos, com)
    w, v = np.empty(6), np.empty(6)
    w[3], w[4], w[5] = out[0], out[1], out[2]
    w[0] = out[3] + y * out[2] - z * out[1]
    w[1] = out[4] + z * out[0] - x * out[2]
    w[2] = out[5] + x * out[1] - y * out[0]

    # X
    rates = np.empty((6, 6))
    for i in range(6):
        for j in range(6):
            rates[i, j] = 0.0
            for k in range(6):
                rates[i, j] += time * damping[i, k] * mobility[k, j]
    _slow_down(rates, w, v)
    _take_back(damping, mobility, rates, velocity, 0.5 * step, w, v)

    # and back
    out[0], out[1], out[2] = v[3], v[4], v[5]
    out[3] = v[0] - y * out[2] + z * out[1]
    out[4] = v[1] - z * out[0] + x * out[2]
    out[5] = v[2] - x * out[1] + y * out[0]


@njit(cache=True, error_model="numpy")
def _slow_down(rates, wrench, out):
    """Write (1 + X) / (1 + X + X^2) of a wrench (6,) to `out` (6,), with X the `rates` (6, 6)."""
    a = np.empty((6, 6))
    for i in range(6):
        out[i] = wrench[i]
        for j in range(6):
            out[i] += rates[i, j] * wrench[j]
            a[i, j] = rates[i, j] + (1.0 if i == j else 0.0)
            for k in range(6):
                a[i, j] += rates[i, k] * rates[k, j]
    _solve(a, out)


@njit(cache=True, error_model="numpy")
def _take_back(damping, mobility, rates, velocity, half, wrench, out):
    """Draw the held wrench `out` (6,) towards plain damping until it adds no energy.

    A wrench w adds w^T v + half w^T L w within a step, over the timestep. Plain damping is -D v,
    held as well, which never adds any. `wrench` is what it was, and is worked in.
    """
    power, limit = 0.0, 0.0
    for i in range(6):
        power += out[i] * velocity[i]
        limit += wrench[i] * velocity[i]
    gain = power - max(limit, 0.0) + half * quadratic(mobility, out)
    if not gain > 0.0:
        return

    # the way to plain damping
    way = np.empty(6)
    for i in range(6):
        wrench[i] = 0.0
        for j in range(6):
            wrench[i] -= damping[i, j] * velocity[j]
    _slow_down(rates, wrench, way)
    slope = 0.0
    for i in range(6):
        way[i] -= out[i]
        slope += way[i] * velocity[i]
    for i in range(6):
        for j in range(6):
            slope += 2.0 * half * out[i] * mobility[i, j] * way[j]
    bend = half * quadratic(mobility, way)

    # where on it nothing is added: the lesser root of gain + slope t + bend t^2
    root = math.sqrt(max(slope * slope - 4.0 * bend * gain, 0.0))
    t = min(2.0 * gain / max(root - slope, 2.0 * gain), 1.0)
    for i in range(6):
        out[i] += t * way[i]


@njit(cache=True, error_model="numpy")
def _solve(a, x):
    """Solve a y = x for a matrix (6, 6) by elimination, y in the place of x; both are changed."""
    for k in range(6):
        # the largest of what is left leads
        best = k
        for i in range(k + 1, 6):
            if abs(a[i, k]) > abs(a[best, k]):
                best = i
        for j in range(6):
            a[k, j], a[best, j] = a[best, j], a[k, j]
        x[k], x[best] = x[best], x[k]
        for i in range(k + 1, 6):
            factor = a[i, k] / a[k, k]
            for j in range(k, 6):
                a[i, j] -= factor * a[k, j]
            x[i] -= factor * x[k]
    for k in range(5, -1, -1):
        for j in range(k + 1, 6):
            x[k] -= a[k, j] * x[j]
        x[k] /= a[k, k]

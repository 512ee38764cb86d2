"""What slows bodies down in water, by coefficients: damping, and the waves that they make."""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.waves import add_velocity


class Moving(NamedTuple):
    """The bodies that water slows down, how all bodies move, as MuJoCo has it, and the water around them."""

    bodies: Any
    """(n,) those with hulls."""
    members: Any
    """(m,) those and what is welded to each, one after the other."""
    member_starts: Any
    """(n + 1,)."""
    body_mass: Any
    """(nbody,)."""
    body_inertia: Any
    """(nbody, 3)."""
    xpos: Any
    """(nbody, 3)."""
    xipos: Any
    """(nbody, 3)."""
    ximat: Any
    """(nbody, 9)."""
    xmat: Any
    """(nbody, 9)."""
    cvel: Any
    """(nbody, 6) rotation, then translation at the root's centre of mass."""
    subtree_com: Any
    """(nbody, 3)."""
    roots: Any
    """(nbody,)."""
    level: Any
    """Of the water [m]."""
    waves: Any
    """(w, 6), see `waves`."""
    current: Any
    """(c, 5), see `currents`."""
    time: Any
    """[s]."""
    timestep: Any
    """[s]."""


@njit(cache=True, error_model="numpy")
def add_drag(
    moving,  # `Moving`
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    volumes,  # (n,) whole volumes
    linear,  # (n, 6) force and torque per velocity along the body's axes
    quadratic,  # (n, 6) the same per velocity squared
    coupled,  # (n,) 1 where instead both are matrices, about the body's origin
    matrices,  # (n, 72) those, row by row: linear, quadratic
    out,  # (nbody, 6)
):
    """Add linear and quadratic damping along each body's axes, scaled with the wet fraction of its volume.

    The force acts at the centroid of what is wet, on the velocity there relative to the water, or as
    Fossen (2021, sec. 6.4) has it, with matrices, at the body's origin. An explicit force must not turn
    the motion round within a timestep, so each coefficient is held below the body's apparent mass
    there divided by the timestep; and of matrices, scaled by those masses, the norm.
    """
    water, v, m = np.empty(3), np.empty(6), np.empty(6)
    rate = 1.0 / moving.timestep if moving.timestep > 0.0 else math.inf
    for n in range(moving.bodies.shape[0]):
        b = moving.bodies[n]
        volume = centres[b, 0]
        if not volume > 0.0:
            continue
        wet = min(volume / volumes[n], 1.0)
        r = moving.xmat[b]
        whole = coupled[n] != 0
        at = moving.xpos[b] if whole else centres[b, 1:]
        set_current(moving.current, moving.level - centres[b, 3], moving.time, water)
        add_velocity(
            moving.waves,
            centres[b, 1],
            centres[b, 2],
            centres[b, 3] - moving.level,
            moving.time,
            water,
        )
        relative_velocity(moving, b, at, water, v)
        mass, inertias = rigid_body(moving, n)
        m[:3] = _apparent(mass, inertias, at, moving.xipos[b])
        m[3], m[4], m[5] = inertias
        if whole:
            norm = 0.0
            for i in range(6):
                for j in range(6):
                    d = wet * (matrices[n, 6 * i + j] + matrices[n, 36 + 6 * i + j] * abs(v[j]))
                    if d != 0.0:
                        norm += d * d / (m[i] * m[j])
            norm = math.sqrt(norm)
            held = wet * (rate / norm if norm > rate else 1.0)
            f = _product(matrices[n], v, held)
        else:
            for i in range(6):
                d = wet * (linear[n, i] + quadratic[n, i] * abs(v[i]))
                m[i] = -min(d, m[i] * rate) * v[i]
            f = m[0], m[1], m[2], m[3], m[4], m[5]
        _add(r, at, moving.xipos[b], f, out[b])


@njit(cache=True, error_model="numpy")
def add_radiation(
    moving,
    wet,  # (h, 6) submersion of the hulls
    owners,  # (h,) their bodies
    centres,
    radiation,  # (n, 4) force per velocity upward, torque per rate of roll and pitch; the waterplane they are of
    out,
):
    """Add what the waves that a body makes take from its heave, roll and pitch, scaled with its waterplane.

    At the centroid of what is wet, on the velocity there relative to the waves, held as for `add_drag`.
    """
    water, v = np.empty(3), np.empty(6)
    rate = 1.0 / moving.timestep if moving.timestep > 0.0 else math.inf
    for n in range(moving.bodies.shape[0]):
        b = moving.bodies[n]
        if not centres[b, 0] > 0.0 or not radiation[n, 3] > 0.0:
            continue
        area = 0.0
        for h in range(owners.shape[0]):
            if owners[h] == b:
                area += wet[h, 5]
        share = min(max(area / radiation[n, 3], 0.0), 1.0)
        if share == 0.0:
            continue
        r, at = moving.xmat[b], centres[b, 1:]
        water[:] = 0.0
        add_velocity(moving.waves, at[0], at[1], at[2] - moving.level, moving.time, water)
        relative_velocity(moving, b, at, water, v)
        mass, inertias = rigid_body(moving, n)
        heave = r[6] * v[0] + r[7] * v[1] + r[8] * v[2]
        up = (
            -min(share * radiation[n, 0], _apparent(mass, inertias, at, moving.xipos[b]) * rate)
            * heave
        )
        roll = -min(share * radiation[n, 1], inertias[0] * rate) * v[3]
        pitch = -min(share * radiation[n, 2], inertias[1] * rate) * v[4]
        _add(r, at, moving.xipos[b], (up * r[6], up * r[7], up * r[8], roll, pitch, 0.0), out[b])


@njit(cache=True, error_model="numpy", inline="always")
def relative_velocity(moving, b, at, water, out):
    """Velocity of a body at a place, relative to the water, and its rates, along its axes; written to `out` (6,)."""
    r, cvel, com = moving.xmat[b], moving.cvel[b], moving.subtree_com[moving.roots[b]]
    x, y, z = at[0] - com[0], at[1] - com[1], at[2] - com[2]
    ux = cvel[3] + cvel[1] * z - cvel[2] * y - water[0]
    uy = cvel[4] + cvel[2] * x - cvel[0] * z - water[1]
    uz = cvel[5] + cvel[0] * y - cvel[1] * x - water[2]
    for i in range(3):
        out[i] = ux * r[i] + uy * r[3 + i] + uz * r[6 + i]
        out[3 + i] = cvel[0] * r[i] + cvel[1] * r[3 + i] + cvel[2] * r[6 + i]


@njit(cache=True, error_model="numpy", inline="always")
def _apparent(mass, inertias, at, com):
    """The least mass that a body opposes to a force at a place; 0 without inertia, about which MuJoCo complains itself."""
    x, y, z = at[0] - com[0], at[1] - com[1], at[2] - com[2]
    least = min(inertias[0], inertias[1], inertias[2])
    opposing = least + mass * (x * x + y * y + z * z)
    return mass * least / opposing if opposing != 0.0 else 0.0


@njit(cache=True, error_model="numpy", inline="always")
def _product(matrices, v, held):
    """Minus damping (72,), linear and quadratic, times velocities (6,)."""
    return (
        -held * _row(matrices, 0, v), -held * _row(matrices, 1, v), -held * _row(matrices, 2, v),
        -held * _row(matrices, 3, v), -held * _row(matrices, 4, v), -held * _row(matrices, 5, v),
    )  # fmt: skip


@njit(cache=True, error_model="numpy", inline="always")
def _row(matrices, i, v):
    total = 0.0
    for j in range(6):
        total += (matrices[6 * i + j] + matrices[36 + 6 * i + j] * abs(v[j])) * v[j]
    return total


@njit(cache=True, error_model="numpy", inline="always")
def _add(r, at, com, f, out):
    """Add a wrench along the axes r, that acts at a place, to `out` (6,) about `com`, world frame."""
    fx, fy = r[0] * f[0] + r[1] * f[1] + r[2] * f[2], r[3] * f[0] + r[4] * f[1] + r[5] * f[2]
    fz = r[6] * f[0] + r[7] * f[1] + r[8] * f[2]
    x, y, z = at[0] - com[0], at[1] - com[1], at[2] - com[2]
    out[0] += fx
    out[1] += fy
    out[2] += fz
    out[3] += r[0] * f[3] + r[1] * f[4] + r[2] * f[5] + y * fz - z * fy
    out[4] += r[3] * f[3] + r[4] * f[4] + r[5] * f[5] + z * fx - x * fz
    out[5] += r[6] * f[3] + r[7] * f[4] + r[8] * f[5] + x * fy - y * fx


@njit(cache=True, error_model="numpy")
def rigid_body(moving, n):
    """Mass of a body and what is welded to it, and what they oppose to a torque about each of its axes.

    The latter is torque over angular acceleration: one over the diagonal of the inverse inertia.
    """
    r, xipos = moving.xmat[moving.bodies[n]], moving.xipos
    members = moving.members[moving.member_starts[n] : moving.member_starts[n + 1]]
    mass = x = y = z = 0.0
    for b in members:
        m = moving.body_mass[b]
        mass, x, y, z = mass + m, x + m * xipos[b, 0], y + m * xipos[b, 1], z + m * xipos[b, 2]
    if not mass > 0.0:
        return 0.0, (0.0, 0.0, 0.0)
    x, y, z = x / mass, y / mass, z / mass
    xx = yy = zz = xy = xz = yz = 0.0
    for b in members:
        m, q = moving.body_mass[b], moving.ximat[b]
        i0, i1, i2 = moving.body_inertia[b, 0], moving.body_inertia[b, 1], moving.body_inertia[b, 2]
        ax, ay, az = xipos[b, 0] - x, xipos[b, 1] - y, xipos[b, 2] - z
        xx += q[0] * q[0] * i0 + q[1] * q[1] * i1 + q[2] * q[2] * i2 + m * (ay * ay + az * az)
        yy += q[3] * q[3] * i0 + q[4] * q[4] * i1 + q[5] * q[5] * i2 + m * (ax * ax + az * az)
        zz += q[6] * q[6] * i0 + q[7] * q[7] * i1 + q[8] * q[8] * i2 + m * (ax * ax + ay * ay)
        xy += q[0] * q[3] * i0 + q[1] * q[4] * i1 + q[2] * q[5] * i2 - m * ax * ay
        xz += q[0] * q[6] * i0 + q[1] * q[7] * i1 + q[2] * q[8] * i2 - m * ax * az
        yz += q[3] * q[6] * i0 + q[4] * q[7] * i1 + q[5] * q[8] * i2 - m * ay * az
    # the inverse of the symmetric matrix, by its cofactors
    cxx, cyy, czz = yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy
    cxy, cxz, cyz = xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz
    determinant = xx * cxx + xy * cxy + xz * cxz
    i0 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[0], r[3], r[6])
    i1 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[1], r[4], r[7])
    i2 = _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, r[2], r[5], r[8])
    return mass, (i0, i1, i2)


@njit(cache=True, error_model="numpy", inline="always")
def _about(determinant, cxx, cyy, czz, cxy, cxz, cyz, x, y, z):
    """The determinant over the cofactors' quadratic form along an axis; 0 where there is no inertia."""
    form = cxx * x * x + cyy * y * y + czz * z * z + 2.0 * (cxy * x * y + cxz * x * z + cyz * y * z)
    return determinant / form if form > 0.0 else 0.0

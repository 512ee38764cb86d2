"""Wrenches on bodies from what is wet: buoyancy, and drag from velocity relative to the water."""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.waves import add_velocity


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def add_wave_pressure(heads, wet, owners, frames, positions, weight, xipos, out):
    """Add to rows of `out` (nbody, 6) what the pressure `weight` [N/m^3] times `heads` (h, 6) has beyond buoyancy.

    The heads are about the origin of each hull's frame, see `pressure.press_hulls`; the torque is about `xipos`.
    """
    for h in range(owners.shape[0]):
        b, o = owners[h], positions[frames[h]]
        fx, fy, fz = weight * heads[h, 0], weight * heads[h, 1], weight * heads[h, 2]
        x, y, z = o[0] - xipos[b, 0], o[1] - xipos[b, 1], o[2] - xipos[b, 2]
        lift = weight * wet[h, 0]
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz - lift
        out[b, 3] += weight * heads[h, 3] + y * fz - z * fy
        out[b, 4] += weight * heads[h, 4] + z * fx - x * fz
        out[b, 5] += weight * heads[h, 5] + x * fy - y * fx
        if lift != 0.0:
            out[b, 3] -= (wet[h, 2] - xipos[b, 1]) * lift
            out[b, 4] += (wet[h, 1] - xipos[b, 0]) * lift


@njit(cache=True, error_model="numpy")
def add_drag(
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    bodies,  # (n,) bodies that have drag
    volumes,  # (n,) their whole volumes
    linear,  # (n, 6) force and torque per velocity along the body's axes
    quadratic,  # (n, 6) the same per velocity squared
    members,  # (m,) those bodies and what is welded to each
    member_starts,  # (n + 1,)
    body_mass,  # (nbody,)
    body_inertia,  # (nbody, 3)
    xipos,  # (nbody, 3)
    ximat,  # (nbody, 9)
    xmat,  # (nbody, 9)
    cvel,  # (nbody, 6) MuJoCo's: rotation, then translation at the root's centre of mass
    subtree_com,  # (nbody, 3)
    roots,  # (nbody,)
    level,
    waves,
    current,  # (n, 5), see `currents`
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
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
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
        set_current(current, level - centres[b, 3], time, water)
        add_velocity(waves, centres[b, 1], centres[b, 2], centres[b, 3] - level, time, water)
        # velocity relative to the water, world frame
        ux = cvel[b, 3] + w[1] * far[2] - w[2] * far[1] - water[0]
        uy = cvel[b, 4] + w[2] * far[0] - w[0] * far[2] - water[1]
        uz = cvel[b, 5] + w[0] * far[1] - w[1] * far[0] - water[2]
        mass, inertias = _rigid_body(
            members[member_starts[n] : member_starts[n + 1]], body_mass, body_inertia, xipos, ximat, r
        )
        least_inertia = min(inertias[0], inertias[1], inertias[2])
        squared_arm = arm[0] * arm[0] + arm[1] * arm[1] + arm[2] * arm[2]
        # without inertia, about which MuJoCo complains itself, nothing is known to hold the motion
        opposing = least_inertia + mass * squared_arm
        apparent = mass * least_inertia / opposing if opposing != 0.0 else 0.0
        fx = fy = fz = tx = ty = tz = 0.0
        for i in range(3):
            ax, ay, az = r[i], r[3 + i], r[6 + i]
            speed = ux * ax + uy * ay + uz * az
            spin = w[0] * ax + w[1] * ay + w[2] * az
            push = wet * (linear[n, i] + quadratic[n, i] * abs(speed))
            twist = wet * (linear[n, 3 + i] + quadratic[n, 3 + i] * abs(spin))
            push = -min(push, apparent * rate) * speed
            twist = -min(twist, inertias[i] * rate) * spin
            fx, fy, fz = fx + push * ax, fy + push * ay, fz + push * az
            tx, ty, tz = tx + twist * ax, ty + twist * ay, tz + twist * az
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz
        out[b, 3] += tx + arm[1] * fz - arm[2] * fy
        out[b, 4] += ty + arm[2] * fx - arm[0] * fz
        out[b, 5] += tz + arm[0] * fy - arm[1] * fx


@njit(cache=True, error_model="numpy")
def _rigid_body(members, body_mass, body_inertia, xipos, ximat, r):
    """Mass of bodies that move as one, and what they oppose to a torque about each axis of the frame r (9,).

    The latter is torque over angular acceleration: one over the diagonal of the inverse inertia.
    """
    mass = x = y = z = 0.0
    for b in members:
        m = body_mass[b]
        mass, x, y, z = mass + m, x + m * xipos[b, 0], y + m * xipos[b, 1], z + m * xipos[b, 2]
    if not mass > 0.0:
        return 0.0, (0.0, 0.0, 0.0)
    x, y, z = x / mass, y / mass, z / mass
    xx = yy = zz = xy = xz = yz = 0.0
    for b in members:
        m, q, i0, i1, i2 = body_mass[b], ximat[b], body_inertia[b, 0], body_inertia[b, 1], body_inertia[b, 2]
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


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def project(
    wrench,  # (nbody, 6) force and torque about xipos, world frame
    bodies,  # (n,) those that have one
    xipos,  # (nbody, 3)
    subtree_com,  # (nbody, 3)
    roots,  # (nbody,)
    parents,  # (nbody,)
    dofnum,  # (nbody,)
    dofadr,  # (nbody,)
    dof_parents,  # (nv,)
    cdof,  # (nv, 6) MuJoCo's: rotation, then translation at the root's centre of mass
    qfrc,  # (nv,)
):
    """Add J^T w to the generalized forces `qfrc`, as MuJoCo's mj_applyFT does for each body."""
    for n in range(bodies.shape[0]):
        b = bodies[n]
        fx, fy, fz = wrench[b, 0], wrench[b, 1], wrench[b, 2]
        # the torque about the point that the joints' axes are given at
        root = roots[b]
        x, y, z = xipos[b, 0] - subtree_com[root, 0], xipos[b, 1] - subtree_com[root, 1], xipos[b, 2] - subtree_com[root, 2]
        tx = wrench[b, 3] + y * fz - z * fy
        ty = wrench[b, 4] + z * fx - x * fz
        tz = wrench[b, 5] + x * fy - y * fx
        while b > 0 and dofnum[b] == 0:
            b = parents[b]
        i = dofadr[b] + dofnum[b] - 1 if b > 0 else -1
        while i >= 0:
            c = cdof[i]
            qfrc[i] += c[0] * tx + c[1] * ty + c[2] * tz + c[3] * fx + c[4] * fy + c[5] * fz
            i = dof_parents[i]

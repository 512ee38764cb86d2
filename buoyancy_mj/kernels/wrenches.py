"""Wrenches on bodies from what is wet: buoyancy and the pressure of waves; and what all wrenches do to the joints."""

import math

from numba import njit

from buoyancy_mj.kernels.multibody import last_dof


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
    wet_bodies,  # (n,) those that have one
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    qfrc,  # (nv,)
):
    """Add J^T w to the generalized forces `qfrc`, as MuJoCo's mj_applyFT does for each body."""
    for n in range(wet_bodies.shape[0]):
        b = wet_bodies[n]
        fx, fy, fz = wrench[b, 0], wrench[b, 1], wrench[b, 2]
        # the torque about the point that the joints' axes are given at
        com, at = bodies.subtree_com[bodies.body_rootid[b]], bodies.xipos[b]
        x, y, z = at[0] - com[0], at[1] - com[1], at[2] - com[2]
        tx = wrench[b, 3] + y * fz - z * fy
        ty = wrench[b, 4] + z * fx - x * fz
        tz = wrench[b, 5] + x * fy - y * fx
        i = last_dof(joints, b)
        while i >= 0:
            c = joints.cdof[i]
            qfrc[i] += c[0] * tx + c[1] * ty + c[2] * tz + c[3] * fx + c[4] * fy + c[5] * fz
            i = joints.dof_parentid[i]

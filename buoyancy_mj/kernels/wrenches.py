"""Wrenches on bodies from what is wet, and what all wrenches do to the joints.

A wrench on a body is a row of force [N] and torque [N m] about `xipos`, the centre of mass of the
body, in the world's axes: what MuJoCo's xfrc_applied holds.
"""

import math

from buoyancy_mj.kernels.clip import CX, CY, CZ, VOLUME
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import difference, rotate


@njit(cache=True, error_model="numpy")
def merge(wet, owners, out):
    """Write volume and centroid of the hulls of each owner to rows of `out` (n, 4).

    The centroid is NaN where all is dry.

    The columns are those of `clip`, up to the centroid.
    """
    out[:, :] = 0.0
    for h in range(owners.shape[0]):
        if wet[h, VOLUME] == 0.0:
            continue
        row = out[owners[h]]
        row[VOLUME] += wet[h, VOLUME]
        for c in range(CX, CZ + 1):
            row[c] += wet[h, VOLUME] * wet[h, c]
    for n in range(out.shape[0]):
        for c in range(CX, CZ + 1):
            out[n, c] = out[n, c] / out[n, VOLUME] if out[n, VOLUME] != 0.0 else math.nan


@njit(cache=True, error_model="numpy")
def add_buoyancy(wet, owners, specific_weight, xipos, out):
    """Add the buoyancy of each hull, at the centroid of what is wet, to rows of `out` (nbody, 6).

    It is `specific_weight` [N/m^3] times volume, upward.
    """
    for h in range(owners.shape[0]):
        if wet[h, VOLUME] == 0.0:
            continue
        b = owners[h]
        force = specific_weight * wet[h, VOLUME]
        out[b, 2] += force
        out[b, 3] += (wet[h, CY] - xipos[b, 1]) * force
        out[b, 4] -= (wet[h, CX] - xipos[b, 0]) * force


@njit(cache=True, error_model="numpy")
def add_wave_pressure(heads, wet, owners, frames, positions, specific_weight, xipos, out):
    """Add what the pressure of waves has beyond buoyancy to rows of `out` (nbody, 6).

    The pressure is `specific_weight` [N/m^3] times `heads` (h, 6).

    The heads are about the origin of each hull's frame, see `pressure.press_hulls`.
    """
    for h in range(owners.shape[0]):
        b = owners[h]
        fx, fy, fz = (
            specific_weight * heads[h, 0],
            specific_weight * heads[h, 1],
            specific_weight * heads[h, 2],
        )
        x, y, z = difference(positions[frames[h]], xipos[b])
        lift = specific_weight * wet[h, VOLUME]
        out[b, 0] += fx
        out[b, 1] += fy
        out[b, 2] += fz - lift
        out[b, 3] += specific_weight * heads[h, 3] + y * fz - z * fy
        out[b, 4] += specific_weight * heads[h, 4] + z * fx - x * fz
        out[b, 5] += specific_weight * heads[h, 5] + x * fy - y * fx
        if lift != 0.0:
            out[b, 3] -= (wet[h, CY] - xipos[b, 1]) * lift
            out[b, 4] += (wet[h, CX] - xipos[b, 0]) * lift


@njit(cache=True, error_model="numpy", inline="always")
def add_wrench(r, at, com, f, out):
    """Add a wrench along the axes r at a place to `out` (6,), about `com` in the world's axes."""
    fx, fy, fz = rotate(r, f[0], f[1], f[2])
    tx, ty, tz = rotate(r, f[3], f[4], f[5])
    x, y, z = difference(at, com)
    out[0] += fx
    out[1] += fy
    out[2] += fz
    out[3] += tx + y * fz - z * fy
    out[4] += ty + z * fx - x * fz
    out[5] += tz + x * fy - y * fx


@njit(cache=True, error_model="numpy")
def project(
    wrenches,  # (nbody, 6)
    loaded,  # (n,) bodies that have one
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    qfrc,  # (nv,)
):
    """Add J^T w to the generalized forces `qfrc`, as MuJoCo's mj_applyFT does for each body."""
    for n in range(loaded.shape[0]):
        b = loaded[n]
        fx, fy, fz = wrenches[b, 0], wrenches[b, 1], wrenches[b, 2]
        # the torque about the point that the joints' axes are given at
        x, y, z = difference(bodies.xipos[b], bodies.subtree_com[bodies.body_rootid[b]])
        tx = wrenches[b, 3] + y * fz - z * fy
        ty = wrenches[b, 4] + z * fx - x * fz
        tz = wrenches[b, 5] + x * fy - y * fx
        i = last_dof(joints, b)
        while i >= 0:
            c = joints.cdof[i]
            qfrc[i] += c[0] * tx + c[1] * ty + c[2] * tz + c[3] * fx + c[4] * fy + c[5] * fz
            i = joints.dof_parentid[i]

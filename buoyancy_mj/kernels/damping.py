"""What slows bodies down in water, by coefficients: damping, and the waves that they make."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.clip import CX, VOLUME, WATERPLANE_AREA
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.vectors import difference, rotate, triple
from buoyancy_mj.kernels.waves import add_velocity

HEAVE, ROLL, PITCH, WATERPLANE = range(4)
"""Columns of `DampingArrays.radiation`: force [N s/m] and torques [N m s] per velocity, and the
waterplane [m^2] at which they are so."""
LINEAR, QUADRATIC = 0, 36
"""Columns of `DampingArrays.matrices` at which the two matrices begin."""


class DampingArrays(NamedTuple):
    """Damping of all bodies that have hulls, along the axes of each body."""

    bodies: Annotated[Words, ("n",)]
    """Indices of the bodies in the model."""
    volumes: Annotated[Doubles, ("n",)]
    """Volume of the hulls of each [m^3]."""
    linear: Annotated[Doubles, ("n", 6)]
    """Force [N s/m] and torque [N m s] per velocity, when fully wet."""
    quadratic: Annotated[Doubles, ("n", 6)]
    """Force [N s^2/m^2] and torque [N m s^2] per velocity squared, when fully wet."""
    coupled: Annotated[Words, ("n",)]
    """1 where both are matrices instead, about the origin of the body."""
    matrices: Annotated[Doubles, ("n", 72)]
    """Those matrices, linear and quadratic, row by row."""
    radiation: Annotated[Doubles, ("n", 4)]
    """Damping by the waves that a body makes, in columns `HEAVE` to `WATERPLANE`."""
    panels: Annotated[Doubles, ("n", 5)]
    """Drag by panels, in columns `panels.LEADING` to `DENSITY`; no rows if no body has it."""
    owners: Annotated[Words, ("h",)]
    """Body of each hull whose panels drag; -1 for a foil, which has drag of its own."""
    members: Annotated[Words, ("m",)]
    """The bodies and all that is welded to each, one after the other."""
    member_starts: Annotated[Words, ("n + 1",)]
    """Where those of each body begin, and the end of all."""

    @property
    def radiates(self) -> bool:
        """Whether any body loses the energy of the waves that it makes."""
        return bool(self.radiation.any())


@njit(cache=True, error_model="numpy")
def add_drag(
    damping,  # `DampingArrays`
    bodies,  # `multibody.Bodies`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    out,  # (nbody, 6)
):
    """Add linear and quadratic damping along each body's axes, scaled with its wet volume.

    The force acts at the centroid of what is wet, on the velocity there relative to the water, or
    as Fossen (2021, sec. 6.4) has it, with matrices, at the body's origin. An explicit force must
    not turn the motion round within a timestep, so each coefficient is held below the body's
    apparent mass there divided by the timestep; and of matrices, scaled by those masses, the norm.
    """
    water, v, m = np.empty(3), np.empty(6), np.empty(6)
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    for n in range(damping.bodies.shape[0]):
        b = damping.bodies[n]
        volume = centres[b, VOLUME]
        if not volume > 0.0:
            continue
        wet = min(volume / damping.volumes[n], 1.0)
        r = bodies.xmat[b]
        coupled = damping.coupled[n] != 0
        at = bodies.xpos[b] if coupled else centres[b, CX:]

        # the velocity relative to the water at the centroid
        x, y, z = triple(centres, b, CX)
        set_current(sea.current, sea.level - z, time, water)
        add_velocity(sea.waves, x, y, z - sea.level, time, water)
        relative_velocity(bodies, b, at, water, v)

        # the force against it, held
        mass, inertias = rigid_body(damping, bodies, n)
        m[:3] = _apparent(mass, inertias, at, bodies.xipos[b])
        m[3], m[4], m[5] = inertias
        if coupled:
            held = wet * _held(damping.matrices[n], wet, v, m, rate)
            f = _product(damping.matrices[n], v, held)
        else:
            for i in range(6):
                d = wet * (damping.linear[n, i] + damping.quadratic[n, i] * abs(v[i]))
                m[i] = -min(d, m[i] * rate) * v[i]
            f = m[0], m[1], m[2], m[3], m[4], m[5]
        _add(r, at, bodies.xipos[b], f, out[b])


@njit(cache=True, error_model="numpy", inline="always")
def _held(matrices, wet, v, masses, rate):
    """The factor that holds damping by matrices below a rate.

    The norm of the damping, scaled by masses (6,), must not exceed the rate.
    """
    norm = 0.0
    for i in range(6):
        for j in range(6):
            d = wet * _coefficient(matrices, i, j, v)
            if d != 0.0:
                norm += d * d / (masses[i] * masses[j])
    norm = math.sqrt(norm)
    return rate / norm if norm > rate else 1.0


@njit(cache=True, error_model="numpy", inline="always")
def _coefficient(matrices, i, j, v):
    """Damping (72,), linear and quadratic, of velocity j on force i."""
    return matrices[LINEAR + 6 * i + j] + matrices[QUADRATIC + 6 * i + j] * abs(v[j])


@njit(cache=True, error_model="numpy")
def add_radiation(
    damping,
    owners,  # (h,) body of each hull
    bodies,
    sea,
    time,
    timestep,
    wet,  # (h, 6) submersion of the hulls
    centres,
    out,
):
    """Add the damping of heave, roll and pitch by the waves that a body makes.

    It scales with the waterplane of the body.

    At the centroid of what is wet, on the velocity there relative to the waves, held as for
    `add_drag`.
    """
    water, v, radiation = np.empty(3), np.empty(6), damping.radiation
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    for n in range(damping.bodies.shape[0]):
        b = damping.bodies[n]
        if not centres[b, VOLUME] > 0.0 or not radiation[n, WATERPLANE] > 0.0:
            continue
        area = 0.0
        for h in range(owners.shape[0]):
            if owners[h] == b:
                area += wet[h, WATERPLANE_AREA]
        share = min(max(area / radiation[n, WATERPLANE], 0.0), 1.0)
        if share == 0.0:
            continue

        # the velocity relative to the waves
        r, at = bodies.xmat[b], centres[b, CX:]
        water[:] = 0.0
        add_velocity(sea.waves, at[0], at[1], at[2] - sea.level, time, water)
        relative_velocity(bodies, b, at, water, v)
        heave = r[6] * v[0] + r[7] * v[1] + r[8] * v[2]

        # the force against it, held
        mass, inertias = rigid_body(damping, bodies, n)
        apparent = _apparent(mass, inertias, at, bodies.xipos[b])
        up = -min(share * radiation[n, HEAVE], apparent * rate) * heave
        roll = -min(share * radiation[n, ROLL], inertias[0] * rate) * v[3]
        pitch = -min(share * radiation[n, PITCH], inertias[1] * rate) * v[4]
        f = up * r[6], up * r[7], up * r[8], roll, pitch, 0.0
        _add(r, at, bodies.xipos[b], f, out[b])


@njit(cache=True, error_model="numpy", inline="always")
def relative_velocity(bodies, b, at, water, out):
    """Write the velocity of a body relative to the water, and its rotation, to `out` (6,).

    The velocity is that at a place of the body; both are along the body's axes.
    """
    r, cvel, com = bodies.xmat[b], bodies.cvel[b], bodies.subtree_com[bodies.body_rootid[b]]
    x, y, z = difference(at, com)
    ux = cvel[3] + cvel[1] * z - cvel[2] * y - water[0]
    uy = cvel[4] + cvel[2] * x - cvel[0] * z - water[1]
    uz = cvel[5] + cvel[0] * y - cvel[1] * x - water[2]
    for i in range(3):
        out[i] = ux * r[i] + uy * r[3 + i] + uz * r[6 + i]
        out[3 + i] = cvel[0] * r[i] + cvel[1] * r[3 + i] + cvel[2] * r[6 + i]


@njit(cache=True, error_model="numpy", inline="always")
def _apparent(mass, inertias, at, com):
    """The least mass that a body opposes to a force at a place.

    It is 0 for a body without inertia, about which MuJoCo itself complains.
    """
    x, y, z = difference(at, com)
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
        total += _coefficient(matrices, i, j, v) * v[j]
    return total


@njit(cache=True, error_model="numpy", inline="always")
def _add(r, at, com, f, out):
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
def rigid_body(damping, bodies, n):
    """Mass of a body with all that is welded to it, and its inertia about each of its axes.

    The latter is torque over angular acceleration: one over the diagonal of the inverse inertia.
    """
    r, xipos = bodies.xmat[damping.bodies[n]], bodies.xipos
    members = damping.members[damping.member_starts[n] : damping.member_starts[n + 1]]
    mass = x = y = z = 0.0
    for b in members:
        m = bodies.body_mass[b]
        mass += m
        x += m * xipos[b, 0]
        y += m * xipos[b, 1]
        z += m * xipos[b, 2]
    if not mass > 0.0:
        return 0.0, (0.0, 0.0, 0.0)
    x, y, z = x / mass, y / mass, z / mass
    xx = yy = zz = xy = xz = yz = 0.0
    for b in members:
        m, q = bodies.body_mass[b], bodies.ximat[b]
        i0, i1, i2 = bodies.body_inertia[b, 0], bodies.body_inertia[b, 1], bodies.body_inertia[b, 2]
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
    """The determinant over the cofactors' quadratic form along an axis; 0 without inertia."""
    form = cxx * x * x + cyy * y * y + czz * z * z + 2.0 * (cxy * x * y + cxz * x * z + cyz * y * z)
    return determinant / form if form > 0.0 else 0.0

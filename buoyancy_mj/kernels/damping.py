"""What slows bodies down in water, by coefficients of bodies and of what welds hold together."""

import math
from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.clip import CX, VOLUME
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.rigid import (
    find_inertias,
    find_motion,
    gather_group,
    rigid_body,
    share,
)
from buoyancy_mj.kernels.vectors import difference, triple
from buoyancy_mj.kernels.waves import add_velocity
from buoyancy_mj.kernels.wrenches import add_wrench

HEAVE, ROLL, PITCH, WATERPLANE = range(4)
"""Columns of `DampingArrays.radiation`: force [N s/m] and torques [N m s] per velocity, and the
waterplane [m^2] at which they are so."""
LINEAR, QUADRATIC = 0, 36
"""Columns of `DampingArrays.matrices` at which the two matrices begin."""


class WeldedGroups(NamedTuple):
    """Drag of bodies that welds hold together, as of one body."""

    rows: Annotated[Words, ("k",)]
    """Rows of the members in `DampingArrays`, group after group."""
    starts: Annotated[Words, ("g + 1",)]
    """Where those of each group begin, and the end of all."""
    welds: Annotated[Words, ("w",)]
    """Equality constraints that hold each group, group after group."""
    weld_starts: Annotated[Words, ("g + 1",)]
    """Where those of each group begin, and the end of all."""
    linear: Annotated[Doubles, ("g", 6)]
    """As `DampingArrays.linear`, of all members as one body, along the axes of the first."""
    quadratic: Annotated[Doubles, ("g", 6)]
    """As `DampingArrays.quadratic`, likewise."""
    lengths: Annotated[Doubles, ("g",)]
    """Length of all members as one body [m], for drag by panels."""


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
    hulls: Annotated[Words, ("k",)]
    """Indices of the hulls of each body, one body after the other."""
    hull_starts: Annotated[Words, ("n + 1",)]
    """Where those of each body begin, and the end of all."""
    group: Annotated[Words, ("n",)]
    """Which of the welded groups each belongs to; -1 for none."""
    welded: WeldedGroups
    """The groups. While all its welds act, a group has the drag of one body, not of its members."""
    faces: Annotated[Doubles, (8, "f")]
    """The faces of all hulls as `facets` takes them; none if no body has drag by panels. In the
    order of the faces, and behind them those of hulls that share their faces with others."""
    shifts: Annotated[Words, ("h",)]
    """How far behind a face that of each hull stands there."""

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
    active,  # (neq,) whether each equality constraint acts
    centres,  # (nbody, 4) submerged volume and its centroid, of each body
    out,  # (nbody, 6)
    first,  # of the welded groups, and behind them of the rows of `damping`; and one past the last
    last,
):
    """Add linear and quadratic damping along each body's axes, scaled with its wet volume.

    The force acts at the centroid of what is wet, on the velocity there relative to the water, or
    as Fossen (2021, sec. 6.4) has it, with matrices, at the body's origin. An explicit force must
    not turn the motion round within a timestep, so each coefficient is held below the body's
    apparent mass there divided by the timestep; and of matrices, scaled by those masses, the norm.

    Bodies that welds hold together are one body here.
    """
    water, v, m = np.empty(3), np.empty(6), np.empty(6)
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    groups = damping.welded.linear.shape[0]
    for g in range(first, min(last, groups)):
        if holds(damping.welded, g, active):
            _add_group(damping, g, bodies, sea, time, rate, centres, out)
    for n in range(max(first - groups, 0), last - groups):
        b = damping.bodies[n]
        volume = centres[b, VOLUME]
        if not volume > 0.0:
            continue
        if damping.group[n] >= 0 and holds(damping.welded, damping.group[n], active):
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
        m[:3] = apparent_mass(mass, inertias, at, bodies.xipos[b])
        m[3], m[4], m[5] = inertias
        if coupled:
            held = wet * _held(damping.matrices[n], wet, v, m, rate)
            f = _product(damping.matrices[n], v, held)
        else:
            f = _resist(damping.linear[n], damping.quadratic[n], wet, v, m, rate)
        add_wrench(r, at, bodies.xipos[b], f, out[b])


@njit(cache=True, error_model="numpy")
def _add_group(damping, g, bodies, sea, time, rate, centres, out):
    """Add the drag of bodies that welds hold together, as of one body.

    Their velocity is that of the rigid body with their momentum, and each gets of the force what it
    needs to move along: so the drag neither loads the welds nor takes from motion against them.
    """
    rows = damping.welded.rows[damping.welded.starts[g] : damping.welded.starts[g + 1]]
    water, v, m = np.empty(3), np.empty(6), np.empty(6)
    at, com, f = np.zeros(3), np.empty(3), np.empty(6)

    # what is wet of it
    volume = displaced = 0.0
    for n in rows:
        b = damping.bodies[n]
        displaced += damping.volumes[n]
        if centres[b, VOLUME] > 0.0:
            volume += centres[b, VOLUME]
            for c in range(3):
                at[c] += centres[b, VOLUME] * centres[b, CX + c]
    if not volume > 0.0:
        return
    at /= volume
    wet = min(volume / displaced, 1.0)

    # the velocity relative to the water at that centroid, along the axes of the first
    parts = np.empty((rows.shape[0], 10))
    whole = gather_group(damping, bodies, rows, parts)
    com[0], com[1], com[2] = whole[1], whole[2], whole[3]
    set_current(sea.current, sea.level - at[2], time, water)
    add_velocity(sea.waves, at[0], at[1], at[2] - sea.level, time, water)
    find_motion(damping, bodies, rows, parts, whole, v)
    x, y, z = difference(at, com)
    r = bodies.xmat[damping.bodies[rows[0]]]
    ux = v[0] + v[4] * z - v[5] * y - water[0]
    uy = v[1] + v[5] * x - v[3] * z - water[1]
    uz = v[2] + v[3] * y - v[4] * x - water[2]
    wx, wy, wz = v[3], v[4], v[5]
    for i in range(3):
        v[i] = ux * r[i] + uy * r[3 + i] + uz * r[6 + i]
        v[3 + i] = wx * r[i] + wy * r[3 + i] + wz * r[6 + i]

    # the force against it, held, and shared
    inertias = find_inertias(whole, r)
    m[:3] = apparent_mass(whole[0], inertias, at, com)
    m[3], m[4], m[5] = inertias
    f[:] = 0.0
    resistance = _resist(damping.welded.linear[g], damping.welded.quadratic[g], wet, v, m, rate)
    add_wrench(r, at, com, resistance, f)
    share(damping, bodies, rows, parts, whole, f, out)


@njit(cache=True, error_model="numpy", inline="always")
def _resist(linear, quadratic, wet, v, masses, rate):
    """Minus damping, linear and quadratic, times velocities, each held below masses times a rate.

    All are (6,).
    """
    for i in range(6):
        d = wet * (linear[i] + quadratic[i] * abs(v[i]))
        masses[i] = -min(d, masses[i] * rate) * v[i]
    return masses[0], masses[1], masses[2], masses[3], masses[4], masses[5]


@njit(cache=True, error_model="numpy")
def holds(welded, g, active):
    """Whether all welds of a group act."""
    for w in range(welded.weld_starts[g], welded.weld_starts[g + 1]):
        if not active[welded.welds[w]]:
            return False
    return True


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
def apparent_mass(mass, inertias, at, com):
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

"""Drag triangle by triangle: pressure and skin friction on what is wet of a mesh."""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.clip import CX, CZ, VOLUME
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.damping import holds, relative_velocity
from buoyancy_mj.kernels.hulls import WHOLE_MIDDLE
from buoyancy_mj.kernels.rigid import (
    find_inertias,
    find_motion,
    gather_group,
    rigid_body,
    share,
)
from buoyancy_mj.kernels.triangles import lone_corner, turn
from buoyancy_mj.kernels.vectors import place, rotate, triple
from buoyancy_mj.kernels.waves import add_velocity, tangent

LEADING, TRAILING, LENGTH, VISCOSITY, DENSITY = range(5)
"""Columns of `DampingArrays.panels`: drag coefficients of faces that lead and that trail, length of
the body [m], kinematic viscosity [m^2/s], and density [kg/m^3], 0 for a body without panels."""
ALONE, TOGETHER = np.int64(0), np.int64(1)
"""Columns of `DampingArrays.exposed`: of a body by itself, and of what welds hold together."""
LEAST_REYNOLDS = 1e4
"""Below it the line of the ITTC is taken no further: flow there is not turbulent."""


@njit(cache=True, error_model="numpy")
def add_panels(
    damping,  # `damping.DampingArrays`
    hulls,  # `hulls.Hulls`
    owners,  # (h,) body of each hull that drags
    bodies,  # `multibody.Bodies`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    active,  # (neq,) whether each equality constraint acts
    wet,  # (h, 8) submersion of the hulls
    out,  # (nbody, 6)
    first,  # of the welded groups, and behind them of the rows of `damping`; and one past the last
    last,
):
    """Add the drag of each wet triangle: pressure across it, and skin friction along it.

    Of pressure, 1/2 rho C A (u.n)^2 against the normal on faces that lead, away from it on those
    that trail. Of friction, 1/2 rho C_F A |t| t along the face, t the velocity there, C_F of a
    smooth plate as long as the body, 0.075 / (log10 Re - 2)^2 (ITTC 1957). The surface is the plane
    that touches it over the middle of the hull. All is held so that its power stops no more than
    the motion there is. Bodies that welds hold together are one body here.
    """
    f, welded = np.empty(6), damping.welded
    groups = welded.linear.shape[0]
    for g in range(first, min(last, groups)):
        if holds(welded, g, active):
            _add_group(damping, g, hulls, owners, bodies, geoms, sea, time, timestep, wet, out)
    for n in range(max(first - groups, 0), last - groups):
        if damping.group[n] >= 0 and holds(welded, damping.group[n], active):
            continue
        length = damping.panels[n, LENGTH]
        fastest = _sum_body(
            damping, n, ALONE, length, hulls, owners, bodies, geoms, sea, time, wet, f
        )
        if fastest >= 0.0:
            b = damping.bodies[n]
            spin = bodies.cvel[b]
            mass, inertias = rigid_body(damping, bodies, n)
            held = _held(mass, inertias, timestep, fastest, spin[0], spin[1], spin[2], f)
            for c in range(6):
                out[b, c] += held * f[c]


@njit(cache=True, error_model="numpy")
def _add_group(damping, g, hulls, owners, bodies, geoms, sea, time, timestep, wet, out):
    """Add the drag of bodies that welds hold together, shared as `rigid.share` does."""
    rows = damping.welded.rows[damping.welded.starts[g] : damping.welded.starts[g + 1]]
    part, f, motion, parts = np.empty(6), np.zeros(6), np.empty(6), np.empty((rows.shape[0], 10))
    whole = gather_group(damping, bodies, rows, parts)
    length, fastest = damping.welded.lengths[g], -1.0
    for n in rows:
        speed = _sum_body(
            damping, n, TOGETHER, length, hulls, owners, bodies, geoms, sea, time, wet, part
        )
        if speed < 0.0:
            continue
        fastest = max(fastest, speed)
        at = bodies.xipos[damping.bodies[n]]
        x, y, z = at[0] - whole[1], at[1] - whole[2], at[2] - whole[3]
        f[0] += part[0]
        f[1] += part[1]
        f[2] += part[2]
        f[3] += part[3] + y * part[2] - z * part[1]
        f[4] += part[4] + z * part[0] - x * part[2]
        f[5] += part[5] + x * part[1] - y * part[0]
    if fastest >= 0.0:
        find_motion(damping, bodies, rows, parts, whole, motion)
        inertias = find_inertias(whole, bodies.xmat[damping.bodies[rows[0]]])
        f *= _held(whole[0], inertias, timestep, fastest, motion[3], motion[4], motion[5], f)
        share(damping, bodies, rows, parts, whole, f, out)


@njit(cache=True, error_model="numpy")
def _sum_body(damping, n, company, length, hulls, owners, bodies, geoms, sea, time, wet, f):
    """Write the force on a body, and the torque about its centre of mass, to `f` (6,).

    Returns the greatest speed of its hulls relative to the water; -1 if it has no wet panels.
    """
    fastest = -1.0
    f[:] = 0.0
    if not damping.panels[n, DENSITY] > 0.0:
        return fastest
    water, v, b = np.zeros(3), np.empty(6), damping.bodies[n]
    relative_velocity(bodies, b, bodies.xipos[b], water, v)
    velocity = rotate(bodies.xmat[b], v[0], v[1], v[2])

    # each hull of the body, in the flow at its own centroid
    for h in damping.hulls[damping.hull_starts[n] : damping.hull_starts[n + 1]]:
        if owners[h] != b or not wet[h, VOLUME] > 0.0:
            continue
        x, y, z = triple(wet, h, CX)
        set_current(sea.current, sea.level - wet[h, CZ], time, water)
        add_velocity(sea.waves, x, y, z - sea.level, time, water)
        speed = math.sqrt(
            (velocity[0] - water[0]) ** 2
            + (velocity[1] - water[1]) ** 2
            + (velocity[2] - water[2]) ** 2
        )
        fastest = max(fastest, speed)
        reynolds = speed * length / damping.panels[n, VISCOSITY]
        friction = 0.075 / (math.log10(max(reynolds, LEAST_REYNOLDS)) - 2.0) ** 2
        _add_hull(
            damping.panels[n],
            damping.exposed,
            damping.shifts[h],
            company,
            hulls,
            h,
            bodies,
            b,
            geoms,
            sea,
            time,
            water,
            velocity,
            friction,
            f,
        )
    return fastest


@njit(cache=True, error_model="numpy", inline="always")
def _add_hull(
    panels, exposed, shift, company, hulls, h, bodies, b, geoms, sea, time, water, velocity,
    friction, f,
):  # fmt: skip
    """Add force and torque on the wet triangles of a hull to `f` (6,).

    The torque is about the centre of mass of the body.
    """
    origin, r = geoms.geom_xpos[hulls.frames[h]], geoms.geom_xmat[hulls.frames[h]]
    at, spin, node = bodies.xipos[b], bodies.cvel[b], hulls.nodes[h]
    c0, c1, c2 = triple(hulls.whole, h, WHOLE_MIDDLE)
    x, y, _ = place(origin, r, c0, c1, c2)
    eta, gx, gy = tangent(sea.waves, x, y, time)
    vertices, faces, areas = hulls.vertices, hulls.faces, hulls.areas
    for t in range(hulls.spans[node, tree.FIRST_FACE], hulls.spans[node, tree.END_FACE]):
        # what of the triangle is wet
        px, py, pz = _corner(vertices, faces, t, 0, origin, r)
        qx, qy, qz = _corner(vertices, faces, t, 1, origin, r)
        ox, oy, oz = _corner(vertices, faces, t, 2, origin, r)
        dp = sea.level + eta + gx * (px - x) + gy * (py - y) - pz
        dq = sea.level + eta + gx * (qx - x) + gy * (qy - y) - qz
        do = sea.level + eta + gx * (ox - x) + gy * (oy - y) - oz
        part = _wet_share(dp, dq, do) * exposed[t + shift, company]
        nx, ny, nz = rotate(r, areas[t, 0], areas[t, 1], areas[t, 2])
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        if part == 0.0 or size == 0.0:
            continue

        # the flow past its middle, along the normal and along the face
        nx, ny, nz = nx / size, ny / size, nz / size
        cx = (px + qx + ox) / 3.0 - at[0]
        cy = (py + qy + oy) / 3.0 - at[1]
        cz = (pz + qz + oz) / 3.0 - at[2]
        wx, wy, wz = spin[0], spin[1], spin[2]
        ux = velocity[0] + wy * cz - wz * cy - water[0]
        uy = velocity[1] + wz * cx - wx * cz - water[1]
        uz = velocity[2] + wx * cy - wy * cx - water[2]
        into = ux * nx + uy * ny + uz * nz
        tx, ty, tz = ux - into * nx, uy - into * ny, uz - into * nz

        # friction, and pressure
        wet_half = 0.5 * panels[DENSITY] * size * part
        along = wet_half * friction * math.sqrt(tx * tx + ty * ty + tz * tz)
        coefficient = panels[LEADING] if into > 0.0 else panels[TRAILING]
        square = wet_half * coefficient * abs(into) * into
        fx, fy, fz = -along * tx - square * nx, -along * ty - square * ny, -along * tz - square * nz
        f[0] += fx
        f[1] += fy
        f[2] += fz
        f[3] = f[3] + cy * fz - cz * fy
        f[4] = f[4] + cz * fx - cx * fz
        f[5] = f[5] + cx * fy - cy * fx


@njit(cache=True, error_model="numpy", inline="always")
def _held(mass, inertias, timestep, fastest, wx, wy, wz, f):
    """The factor that holds the power of `f` over a timestep.

    It may stop no more than the body's motion relative to the water.
    """
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    least = min(inertias[0], inertias[1], inertias[2])
    push = f[0] * f[0] + f[1] * f[1] + f[2] * f[2]
    twist = f[3] * f[3] + f[4] * f[4] + f[5] * f[5]
    motion = mass * fastest * fastest + least * (wx**2 + wy**2 + wz**2)
    change = math.inf
    if least > 0.0 and mass > 0.0:
        change = (push / mass + twist / least) / (rate * rate)
    return math.sqrt(motion / change) if change > motion else 1.0


@njit(cache=True, error_model="numpy", inline="always")
def _corner(vertices, faces, t, k, origin, r):
    """Corner k of a triangle, in the world."""
    x, y, z = triple(vertices, faces[t, k], 0)
    return place(origin, r, x, y, z)


@njit(cache=True, error_model="numpy", inline="always")
def _wet_share(p, q, o):
    """The part of a triangle's area that is wet, by the depths of its corners."""
    count = int(p > 0.0) + int(q > 0.0) + int(o > 0.0)
    if count == 0 or count == 3:
        return 0.0 if count == 0 else 1.0
    # turn it so that the first corner is alone on its side
    p, q, o = turn(lone_corner(p > 0.0, q > 0.0, o > 0.0), p, q, o)
    cut = p / (p - q) * (p / (p - o))
    return cut if count == 1 else 1.0 - cut

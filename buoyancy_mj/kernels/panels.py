"""Drag triangle by triangle: pressure and skin friction on what is wet of a mesh."""

import math

import numpy as np

from buoyancy_mj.kernels import tree
from buoyancy_mj.kernels.clip import CX, CZ, VOLUME
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.damping import holds, relative_velocity
from buoyancy_mj.kernels.facets import AREAS, BLOCK, PUSHES, add_push, total
from buoyancy_mj.kernels.hulls import WHOLE_MIDDLE
from buoyancy_mj.kernels.rigid import (
    find_inertias,
    find_motion,
    gather_group,
    rigid_body,
    share,
)
from buoyancy_mj.kernels.triangles import lone_corner, turn
from buoyancy_mj.kernels.vectors import difference, place, rotate, rotate_back, triple
from buoyancy_mj.kernels.waves import add_velocity, tangent

LEADING, TRAILING, LENGTH, VISCOSITY, DENSITY = range(5)
"""Columns of `DampingArrays.panels`: drag coefficients of faces that lead and that trail, length of
the body [m], kinematic viscosity [m^2/s], and density [kg/m^3], 0 for a body without panels."""
ALONE, TOGETHER = np.int64(0), np.int64(1)
"""Whose other hulls cover a face: those of a body by itself, or of all that welds hold together."""
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
    sums = np.empty((PUSHES, BLOCK))
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
            damping.faces,
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
            sums,
            f,
        )
    return fastest


@njit(cache=True, error_model="numpy", inline="always")
def _add_hull(
    panels,
    faces,
    shift,
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
    sums,
    f,
):
    """Add force and torque on the wet triangles of a hull to `f` (6,).

    The torque is about the centre of mass of the body.
    """
    # the plane that touches the surface, and the flow, in the frame of the hull
    origin, r = geoms.geom_xpos[hulls.frames[h]], geoms.geom_xmat[hulls.frames[h]]
    middle = triple(hulls.whole, h, WHOLE_MIDDLE)
    x, y, z = place(origin, r, middle[0], middle[1], middle[2])
    eta, gx, gy = tangent(sea.waves, x, y, time)
    plane = sea.level + eta - z, middle, rotate_back(r, gx, gy, -1.0)
    arm, spin = difference(origin, bodies.xipos[b]), bodies.cvel[b]
    ux = velocity[0] + spin[1] * arm[2] - spin[2] * arm[1] - water[0]
    uy = velocity[1] + spin[2] * arm[0] - spin[0] * arm[2] - water[1]
    uz = velocity[2] + spin[0] * arm[1] - spin[1] * arm[0] - water[2]
    flow = rotate_back(r, ux, uy, uz), rotate_back(r, spin[0], spin[1], spin[2])

    # the sum over the triangles, about the origin of the hull
    coefficients = panels[LEADING], panels[TRAILING], friction
    sums[:] = 0.0
    _walk(hulls, h, faces, shift, AREAS + company, plane, flow, coefficients, sums)
    fx, fy, fz, tx, ty, tz = total(sums)

    # in the world, about the centre of mass
    half = 0.5 * panels[DENSITY]
    fx, fy, fz = rotate(r, half * fx, half * fy, half * fz)
    tx, ty, tz = rotate(r, half * tx, half * ty, half * tz)
    f[0] += fx
    f[1] += fy
    f[2] += fz
    f[3] += tx + arm[1] * fz - arm[2] * fy
    f[4] += ty + arm[2] * fx - arm[0] * fz
    f[5] += tz + arm[0] * fy - arm[1] * fx


@njit(cache=True, error_model="numpy")
def _walk(hulls, h, faces, shift, row, plane, flow, coefficients, sums):
    """Add the push on all wet faces of a hull to `sums`, by its tree.

    The corners of triangles are looked at where the plane cuts them, and nowhere else.
    """
    vertices, corners, spans, boxes = hulls.vertices, hulls.faces, hulls.spans, hulls.boxes
    wet_areas = np.empty(BLOCK)
    under, middle, slope = plane
    i = hulls.nodes[h]
    end = spans[i, tree.BEHIND]
    while i < end:
        away = difference(triple(boxes, i, tree.MIDDLE), middle)
        depth = under + slope[0] * away[0] + slope[1] * away[1] + slope[2] * away[2]
        spread = tree.spread_in_box(triple(boxes, i, tree.HALF), slope, 0.0)
        dry, wet = depth <= -spread, depth >= spread
        first, last = spans[i, tree.FIRST_FACE], spans[i, tree.END_FACE]
        if wet and not dry:
            for start in range(first + shift, last + shift, BLOCK):
                stop = min(start + BLOCK, last + shift)
                add_push(faces, start, stop, faces[row, start:stop], flow, coefficients, sums)
        elif not dry and tree.is_leaf(spans, i):
            for start in range(first, last, BLOCK):
                stop = min(start + BLOCK, last)
                for t in range(start, stop):
                    p = _depth(vertices, corners[t, 0], plane)
                    q = _depth(vertices, corners[t, 1], plane)
                    o = _depth(vertices, corners[t, 2], plane)
                    wet_areas[t - start] = _wet_share(p, q, o) * faces[row, t + shift]
                add_push(
                    faces, start + shift, stop + shift, wet_areas[: stop - start],
                    flow, coefficients, sums,
                )  # fmt: skip
        i = tree.node_after(spans, i, dry or wet)


@njit(cache=True, error_model="numpy", inline="always")
def _depth(vertices, n, plane):
    """Depth of a vertex under a plane."""
    under, middle, slope = plane
    x, y, z = difference(triple(vertices, n, 0), middle)
    return under + slope[0] * x + slope[1] * y + slope[2] * z


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
def _wet_share(p, q, o):
    """The part of a triangle's area that is wet, by the depths of its corners."""
    count = int(p > 0.0) + int(q > 0.0) + int(o > 0.0)
    if count == 0 or count == 3:
        return 0.0 if count == 0 else 1.0
    # turn it so that the first corner is alone on its side
    p, q, o = turn(lone_corner(p > 0.0, q > 0.0, o > 0.0), p, q, o)
    cut = p / (p - q) * (p / (p - o))
    return cut if count == 1 else 1.0 - cut

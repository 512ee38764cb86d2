"""Drag triangle by triangle: pressure and skin friction on what is wet of a mesh."""

import math

import numpy as np
from numba import njit

from buoyancy_mj.kernels.clip import placed
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.damping import relative_velocity, rigid_body
from buoyancy_mj.kernels.hulls import BOX
from buoyancy_mj.kernels.waves import add_velocity, tangent

LEADING, TRAILING, LENGTH, VISCOSITY, DENSITY = range(5)
"""Columns of `DampingArrays.panels`: drag coefficients of faces that lead and that trail, length of the body [m], kinematic
viscosity [m^2/s], and density [kg/m^3], 0 for a body without panels."""
LEAST_REYNOLDS = 1e4
"""Below it the line of the ITTC is taken no further: flow there is not turbulent."""


@njit(cache=True, error_model="numpy")
def add_panels(
    damping,  # `damping.DampingArrays`
    hulls,  # `hulls.Hulls`
    owners,  # (h,) body of each hull
    bodies,  # `multibody.Bodies`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    wet,  # (h, 6) submersion of the hulls
    out,  # (nbody, 6)
):
    """Add the drag of each wet triangle: pressure by how squarely it meets the flow, and skin friction along it.

    Of pressure, 1/2 rho C A (u.n)^2 against the normal on faces that lead, away from it on those that
    trail. Of friction, 1/2 rho C_F A |t| t along the face, t the velocity there, C_F of a smooth plate as
    long as the body, 0.075 / (log10 Re - 2)^2 (ITTC 1957). The surface is the plane that touches it over
    the middle of the hull. All is held so that its power stops no more than the motion there is.
    """
    water, v, f = np.empty(3), np.empty(6), np.empty(6)
    rate = 1.0 / timestep if timestep > 0.0 else math.inf
    level, waves, panels = sea.level, sea.waves, damping.panels
    vertices, faces, areas = hulls.vertices, hulls.faces, hulls.areas
    for n in range(damping.bodies.shape[0]):
        density = panels[n, DENSITY]
        if not density > 0.0:
            continue
        b = damping.bodies[n]
        r, at, spin = bodies.xmat[b], bodies.xipos[b], bodies.cvel[b]
        f[:] = 0.0
        water[:] = 0.0
        relative_velocity(bodies, b, at, water, v)
        vx, vy, vz = placed((0.0, 0.0, 0.0), r, v[0], v[1], v[2])
        fastest = -1.0
        for h in range(owners.shape[0]):
            if owners[h] != b or not wet[h, 0] > 0.0:
                continue
            origin, turn = geoms.geom_xpos[hulls.frames[h]], geoms.geom_xmat[hulls.frames[h]]
            x, y, _ = placed(
                origin, turn, hulls.whole[h, BOX], hulls.whole[h, BOX + 1], hulls.whole[h, BOX + 2]
            )
            eta, gx, gy = tangent(waves, x, y, time)
            set_current(sea.current, level - wet[h, 3], time, water)
            add_velocity(waves, wet[h, 1], wet[h, 2], wet[h, 3] - level, time, water)
            speed = math.sqrt((vx - water[0]) ** 2 + (vy - water[1]) ** 2 + (vz - water[2]) ** 2)
            fastest = max(fastest, speed)
            reynolds = max(speed * panels[n, LENGTH] / panels[n, VISCOSITY], LEAST_REYNOLDS)
            friction = 0.075 / (math.log10(reynolds) - 2.0) ** 2
            i = hulls.nodes[h]
            for t in range(hulls.spans[i, 0], hulls.spans[i, 1]):
                px, py, pz = placed(
                    origin,
                    turn,
                    vertices[faces[t, 0], 0],
                    vertices[faces[t, 0], 1],
                    vertices[faces[t, 0], 2],
                )
                qx, qy, qz = placed(
                    origin,
                    turn,
                    vertices[faces[t, 1], 0],
                    vertices[faces[t, 1], 1],
                    vertices[faces[t, 1], 2],
                )
                ox, oy, oz = placed(
                    origin,
                    turn,
                    vertices[faces[t, 2], 0],
                    vertices[faces[t, 2], 1],
                    vertices[faces[t, 2], 2],
                )
                dp = level + eta + gx * (px - x) + gy * (py - y) - pz
                dq = level + eta + gx * (qx - x) + gy * (qy - y) - qz
                do = level + eta + gx * (ox - x) + gy * (oy - y) - oz
                share = _wet_share(dp, dq, do)
                nx, ny, nz = placed((0.0, 0.0, 0.0), turn, areas[t, 0], areas[t, 1], areas[t, 2])
                size = math.sqrt(nx * nx + ny * ny + nz * nz)
                if share == 0.0 or size == 0.0:
                    continue
                nx, ny, nz = nx / size, ny / size, nz / size
                cx, cy, cz = (
                    (px + qx + ox) / 3.0 - at[0],
                    (py + qy + oy) / 3.0 - at[1],
                    (pz + qz + oz) / 3.0 - at[2],
                )
                wx, wy, wz = spin[0], spin[1], spin[2]
                ux = vx + wy * cz - wz * cy - water[0]
                uy = vy + wz * cx - wx * cz - water[1]
                uz = vz + wx * cy - wy * cx - water[2]
                into = ux * nx + uy * ny + uz * nz
                tx, ty, tz = ux - into * nx, uy - into * ny, uz - into * nz
                along = (
                    0.5 * density * size * share * friction * math.sqrt(tx * tx + ty * ty + tz * tz)
                )
                square = (
                    0.5
                    * density
                    * size
                    * share
                    * (panels[n, LEADING] if into > 0.0 else panels[n, TRAILING])
                    * abs(into)
                    * into
                )
                fx, fy, fz = (
                    -along * tx - square * nx,
                    -along * ty - square * ny,
                    -along * tz - square * nz,
                )
                f[0], f[1], f[2] = f[0] + fx, f[1] + fy, f[2] + fz
                f[3], f[4], f[5] = (
                    f[3] + cy * fz - cz * fy,
                    f[4] + cz * fx - cx * fz,
                    f[5] + cx * fy - cy * fx,
                )
        if fastest < 0.0:
            continue
        # its power over a timestep, beside what the body's motion relative to the water holds
        mass, inertias = rigid_body(damping, bodies, n)
        least = min(inertias[0], inertias[1], inertias[2])
        push = f[0] * f[0] + f[1] * f[1] + f[2] * f[2]
        twist = f[3] * f[3] + f[4] * f[4] + f[5] * f[5]
        motion = mass * fastest * fastest + least * (spin[0] ** 2 + spin[1] ** 2 + spin[2] ** 2)
        change = (
            (push / mass + twist / least) / (rate * rate)
            if least > 0.0 and mass > 0.0
            else math.inf
        )
        held = math.sqrt(motion / change) if change > motion else 1.0
        for c in range(6):
            out[b, c] += held * f[c]


@njit(cache=True, error_model="numpy", inline="always")
def _wet_share(p, q, o):
    """The part of a triangle's area that is wet, by the depths of its corners."""
    count = int(p > 0.0) + int(q > 0.0) + int(o > 0.0)
    if count == 0 or count == 3:
        return 0.0 if count == 0 else 1.0
    # turn it so that the first corner is alone on its side
    if (q > 0.0) == (count == 1) and (p > 0.0) != (count == 1):
        p, q = q, p
    elif (o > 0.0) == (count == 1) and (p > 0.0) != (count == 1):
        p, o = o, p
    cut = p / (p - q) * (p / (p - o))
    return cut if count == 1 else 1.0 - cut

"""Lift and drag of foils: fins, rudders, keels and wings, strip by strip along their span.

The frame of a foil has its origin in the middle, x along the chord towards the leading edge, y
along the span and z along the normal.
"""

import math
from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels import holding
from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.polar import PLATE, PROFILE, SECTION, SLOPE, arm, coefficients
from buoyancy_mj.kernels.vectors import difference, place, rotate, rotate_back, triple
from buoyancy_mj.kernels.waves import add_velocity, tangent
from buoyancy_mj.kernels.wrenches import add_wrench

SPAN, CHORD, THICKNESS = range(3)
"""Columns of `Foils.sizes`: span, longest chord and thickness [m]."""
ALONG, STRIP_CHORD, WIDTH = range(3)
"""Columns of `Foils.strips`: place along the span, chord and width [m]."""
CORNERS = 4
"""Places over a foil that stand for all of it where it is held."""
GAUSS = 0.5 / math.sqrt(3.0)
"""Two places this part of the span from the middle have the mean of any cubic over it."""


class Foils(NamedTuple):
    """All foils of a model."""

    bodies: Annotated[Words, ("n",)]
    """Index of the body that each moves with."""
    middles: Annotated[Doubles, ("n", 3)]
    """Middle of each in the frame of its body [m]."""
    turns: Annotated[Doubles, ("n", 9)]
    """body_from_foil, row-major."""
    sizes: Annotated[Doubles, ("n", 3)]
    """In columns `SPAN` to `THICKNESS`."""
    sections: Annotated[Doubles, ("n", SECTION)]
    """Lift and drag of each, see `kernels.polar`."""
    strips: Annotated[Doubles, ("s", 3)]
    """The strips of all, one after the other, in columns `ALONG` to `WIDTH`."""
    starts: Annotated[Words, ("n + 1",)]
    """Where those of each foil begin, and the end of all."""


@njit(cache=True, error_model="numpy")
def add_foils(
    foils,  # `Foils`
    bodies,  # `multibody.Bodies`
    joints,  # `multibody.Joints`
    mass_matrix,  # `multibody.MassMatrix`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    out,  # (nbody, 6), of this load alone
):
    """Write the lift and drag of foils to rows of `out`.

    Each strip meets the water at its own velocity, and its force acts where that velocity is taken:
    it takes energy from the motion relative to the water and gives none, but for the couple of
    camber. What is out of the water has no force. All is held so that no motion of a tree of bodies
    is slowed down at a higher rate than one over the timestep, see `holding`.
    """
    r, flow, water, wrench, push = np.empty(9), np.empty(9), np.empty(3), np.empty(6), np.empty(6)
    mobility, rows = np.empty((6, 6)), np.empty((6, joints.qvel.shape[0]))
    steepness = np.zeros((foils.bodies.shape[0], 5))
    body_rates, tree_rates = np.zeros(out.shape[0]), np.zeros(out.shape[0])
    motions = np.zeros((out.shape[0], 4))
    sizes, sections, strips, starts = foils.sizes, foils.sections, foils.strips, foils.starts
    owners, roots, xipos, coms = foils.bodies, bodies.body_rootid, bodies.xipos, bodies.subtree_com
    last = -1
    for n in range(owners.shape[0]):
        b = owners[n]
        middle = _set_frame(foils, n, bodies, b, r)

        # how deep its middle is, and how that changes along the span
        eta, gx, gy = tangent(sea.waves, middle[0], middle[1], time)
        depth = sea.level + eta - middle[2]
        deeper = gx * r[1] + gy * r[4] - r[7]
        span, thickness = sizes[n, SPAN], sizes[n, THICKNESS]
        tallest = _height(sizes[n, CHORD], thickness, r)
        if depth + 0.5 * (abs(deeper) * span + tallest) <= 0.0:
            continue

        # its motion through the water, and what the water does to each strip
        _set_flow(span, bodies, b, middle, r, sea, time, water, flow)
        wrench[:] = 0.0
        section, steep = sections[n], steepness[n]
        for i in range(starts[n], starts[n + 1]):
            along, chord, width = triple(strips, i, 0)
            tall = _height(chord, thickness, r) + width * abs(deeper)
            wet = min(max(0.5 + (depth + along * deeper) / tall, 0.0), 1.0)
            if wet > 0.0:
                area = wet * chord * width
                _add_strip(section, flow, along, chord, area, sea.density, timestep, wrench, steep)
        add_wrench(r, middle, xipos[b], wrench, out[b])
        _weigh_motion(middle, r, bodies.cvel[b], coms[roots[b]], flow, steep[0], motions[b])

        # how fast it slows its body down
        if b != last:
            holding.set_mobility(joints, mass_matrix, b, rows, mobility)
            last = b
        for k in range(CORNERS):
            weight = _set_corner(steep, k, middle, r, coms[roots[b]], push)
            rate = weight * holding.quadratic(mobility, push)
            body_rates[b] += rate
            tree_rates[roots[b]] += rate

    # held
    for b in range(out.shape[0]):
        tree_rate = tree_rates[roots[b]]
        if body_rates[b] > 0.0 and tree_rate * timestep > 1.0:
            # each body has its share of the rate that all may have
            held = holding.excess(tree_rate * timestep) / body_rates[b]
            step = timestep * tree_rate / body_rates[b]
            holding.set_mobility(joints, mass_matrix, b, rows, mobility)
            _hold(foils, bodies, b, steepness, motions[b], held, step, mobility, push, r, out[b])


@njit(cache=True, error_model="numpy")
def _hold(foils, bodies, b, steepness, motion, time, step, mobility, push, r, out):
    """Hold the wrench `out` (6,) of the foils of one body, see `holding.hold`."""
    damping = np.zeros((6, 6))
    com = bodies.subtree_com[bodies.body_rootid[b]]
    for n in range(foils.bodies.shape[0]):
        if foils.bodies[n] != b:
            continue
        middle = _set_frame(foils, n, bodies, b, r)
        for k in range(CORNERS):
            weight = _set_corner(steepness[n], k, middle, r, com, push)
            for i in range(6):
                for j in range(6):
                    damping[i, j] += weight * push[i] * push[j]
    # its rotation, and the velocity through the water of what moves along at the centre of mass
    for i in range(3):
        push[i], push[3 + i] = bodies.cvel[b, i], motion[1 + i] / motion[0]
    holding.hold(damping, mobility, push, time, step, bodies.xipos[b], com, out)


@njit(cache=True, error_model="numpy", inline="always")
def _weigh_motion(middle, r, cvel, com, flow, weight, out):
    """Add a weight, and that times the velocity (3,) at a centre of mass, to `out` (4,).

    The velocity is that relative to the water around a foil.
    """
    vx, vy, vz = rotate(r, flow[0], flow[1], flow[2])
    x, y, z = difference(middle, com)
    out[0] += weight
    out[1] += weight * (vx - cvel[1] * z + cvel[2] * y)
    out[2] += weight * (vy - cvel[2] * x + cvel[0] * z)
    out[3] += weight * (vz - cvel[0] * y + cvel[1] * x)


@njit(cache=True, error_model="numpy", inline="always")
def _set_frame(foils, n, bodies, b, out):
    """Write world_from_foil to `out` (9,); returns the middle of the foil in the world."""
    r, turn = bodies.xmat[b], foils.turns[n]
    for i in range(3):
        for j in range(3):
            out[3 * i + j] = (
                r[3 * i] * turn[j] + r[3 * i + 1] * turn[3 + j] + r[3 * i + 2] * turn[6 + j]
            )
    x, y, z = triple(foils.middles, n, 0)
    return place(bodies.xpos[b], r, x, y, z)


@njit(cache=True, error_model="numpy", inline="always")
def _set_corner(steepness, k, middle, r, com, out):
    """Write the push (6,) of a unit force along the normal at one of four corners.

    The four together have the sum and the moments of how steeply the force grows over the foil.
    Returns the weight of the corner, the force per velocity that it stands for.
    """
    total = steepness[0]
    if not total > 0.0:
        out[:] = 0.0
        return 0.0
    along, x = steepness[1] / total, steepness[3] / total
    spread = math.sqrt(max(steepness[2] / total - along * along, 0.0))
    depth = math.sqrt(max(steepness[4] / total - x * x, 0.0))
    y = along + spread if k % 2 == 0 else along - spread
    x = x + depth if k < 2 else x - depth
    holding.set_push(place(middle, r, x, y, 0.0), com, (r[2], r[5], r[8]), out)
    return total / CORNERS


@njit(cache=True, error_model="numpy", inline="always")
def _height(chord, thickness, r):
    """How tall a cut across the span stands in the world [m]; never 0."""
    return max(chord * abs(r[6]) + thickness * abs(r[8]), 1e-9)


@njit(cache=True, error_model="numpy")
def _set_flow(span, bodies, b, middle, r, sea, time, water, out):
    """Write the motion of a foil through the water to `out` (9,), in the axes of the foil.

    That is the velocity of its middle relative to the water there, its rotation, and how the
    water's velocity changes along the span.
    """
    # the foil
    cvel = bodies.cvel[b]
    x, y, z = difference(middle, bodies.subtree_com[bodies.body_rootid[b]])
    vx = cvel[3] + cvel[1] * z - cvel[2] * y
    vy = cvel[4] + cvel[2] * x - cvel[0] * z
    vz = cvel[5] + cvel[0] * y - cvel[1] * x
    v0, v1, v2 = rotate_back(r, vx, vy, vz)
    out[3], out[4], out[5] = rotate_back(r, cvel[0], cvel[1], cvel[2])

    # the water on both sides of the middle
    half = GAUSS * span
    x, y, z = place(middle, r, 0.0, -half, 0.0)
    set_current(sea.current, sea.level - z, time, water)
    add_velocity(sea.waves, x, y, z - sea.level, time, water)
    a0, a1, a2 = rotate_back(r, water[0], water[1], water[2])
    x, y, z = place(middle, r, 0.0, half, 0.0)
    set_current(sea.current, sea.level - z, time, water)
    add_velocity(sea.waves, x, y, z - sea.level, time, water)
    b0, b1, b2 = rotate_back(r, water[0], water[1], water[2])
    out[0], out[1], out[2] = v0 - 0.5 * (a0 + b0), v1 - 0.5 * (a1 + b1), v2 - 0.5 * (a2 + b2)
    out[6], out[7], out[8] = b0 - a0, b1 - a1, b2 - a2
    for i in range(6, 9):
        out[i] /= 2.0 * half


@njit(cache=True, error_model="numpy")
def _add_strip(section, flow, along, chord, area, density, timestep, wrench, steepness):
    """Add the force on a strip, and its torque about the middle, to `wrench` (6,).

    Both are in the axes of the foil. `steepness` (5,) gets the force per velocity along the normal,
    its first and second moment along the span, and those along the chord.
    """
    # the velocity at the middle of the chord, and the place of the force
    spin = flow[4] * 0.25 * chord
    vx = flow[0] - (flow[5] + flow[6]) * along
    vz = flow[2] + (flow[3] - flow[8]) * along
    square = vx * vx + vz * vz + spin * spin
    if not square > 0.0:
        return
    speed = math.sqrt(square)
    x = chord * arm(section, vx / speed, -vz / speed, spin * spin / square)

    # the velocity there
    vz -= flow[4] * x
    vy = flow[1] + flow[5] * x - flow[7] * along
    speed = math.sqrt(vx * vx + vz * vz)
    pressure = 0.5 * density * area * speed
    lift = drag = cambered = 0.0
    if speed > 0.0:
        lift, drag, cambered = coefficients(section, vx / speed, -vz / speed)

    # lift across it, drag along it, friction along the span
    fx = -pressure * (lift * vz + drag * vx)
    fz = pressure * (lift * vx - drag * vz)
    fy = -0.5 * density * area * section[PROFILE] * math.sqrt(speed * speed + vy * vy) * vy
    # camber's force acts at the middle of the chord, and a plate that turns is braked
    couple = pressure * speed * cambered * x
    brake = 0.5 * density * section[PLATE] * area * chord**3 / 32.0 * abs(flow[4])
    couple -= brake * flow[4]
    wrench[0] += fx
    wrench[1] += fy
    wrench[2] += fz
    wrench[3] += along * fz
    wrench[4] += couple - x * fz
    wrench[5] += x * fy - along * fx

    # how steeply the force grows with the velocity, and with the angle that a step may bring: a
    # strip that turns about a point a quarter of its chord away is a spring of speed over that
    quarter = 0.25 * chord
    steep = pressure * (section[SLOPE] + section[PLATE]) * (1.0 + timestep * speed / quarter)
    # the brake as forces there
    pair = brake / (quarter * quarter)
    steepness[0] += steep + pair
    steepness[1] += (steep + pair) * along
    steepness[2] += (steep + pair) * along * along
    steepness[3] += steep * x
    steepness[4] += steep * x * x + brake

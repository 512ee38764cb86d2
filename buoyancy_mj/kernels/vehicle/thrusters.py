"""What a thruster does at one instant: from its command and the water at its disc to its thrust."""

import math
from typing import NamedTuple

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.vehicle.immersion import ventilated_share, wet_share
from buoyancy_mj.kernels.vehicle.motion import find_velocity, set_water_velocity
from buoyancy_mj.kernels.vehicle.open_water import drag_blades, meet_flow
from buoyancy_mj.kernels.vehicle.rotor import (
    COMMAND,
    CURRENT,
    SQUARE,
    THRUST,
    TORQUE,
    demand_speed,
    hold_rate,
    signed_square,
    spin,
)
from buoyancy_mj.kernels.vehicle.tables import interpolate
from buoyancy_mj.kernels.waves import tangent

NO_CLAMP = 1 << 8
"""MuJoCo's mjDSBL_CLAMPCTRL."""
TORQUE_LOSS = 0.85
"""Power of the share of thrust that is left, which gives that of torque (Minsaas et al. 1983)."""
(READ_THRUST, READ_TORQUE, READ_SPEED, READ_INFLOW, READ_WET, READ_LOST, READ_CURRENT, READINGS) = (
    range(8)
)
"""What a thruster leaves to be read, and how many numbers: thrust [N], torque of the water against
the rotor [N m], speed of the rotor [rev/s] and of the flow into it [m/s], wet share, share of the
thrust that air takes, current [A]."""


class Moment(NamedTuple):
    """What a thruster does at one instant."""

    speed: float
    """Of the rotor [rev/s]."""
    thrust: float
    """[N]."""
    torque: float
    """Of the water against the rotor [N m]."""
    inflow: float
    """Velocity of the disc through the water along its thrust [m/s]."""
    wet: float
    """Share of the disc under water."""
    lost: float
    """Share of the thrust of the wet part that air takes."""
    airy: float
    """The same where it would stay."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def is_disabled(p, around):
    """Whether the group of the actuator is switched off."""
    group = around.actuator_group[p.actuator]
    return 0 <= group < 31 and (around.disableactuator >> group) & 1 != 0


@inner
def hear(p, around):
    """The command, from the one at which the rotor stands; 0 for none."""
    command = around.ctrl[p.address]
    # no number is no command, as for MuJoCo's own actuators
    if not math.isfinite(command) or command < p.absent:
        return 0.0
    clamps = around.disableflags & NO_CLAMP == 0
    if clamps and around.actuator_ctrllimited[p.address]:
        bounds = around.actuator_ctrlrange[p.address]
        command = min(max(command, bounds[0]), bounds[1])

    # what it has not is not followed either, which would take long to come back from
    command -= p.neutral
    last = p.demands.shape[0] - 1
    if last < 0:
        return min(max(command, p.curve[0, THRUST]), p.curve[p.curve.shape[0] - 1, THRUST])
    return min(max(command, p.demands[0, COMMAND]), p.demands[last, COMMAND])


@inner
def find_speed(p, around):
    """The speed of the rotor now [rev/s]."""
    if p.state < 0:
        return demand_speed(hear(p, around), p.deadband, p.demands, p.curve)
    followed = around.act[p.state]
    if p.inertia > 0.0:
        return followed / (2.0 * math.pi)
    return demand_speed(followed, p.deadband, p.demands, p.curve)


@inner
def find_inflow(p, around, sea, at, axis):
    """Velocity of the disc through the water along its thrust [m/s]."""
    body = around.site_bodyid[p.site]
    u, v, w = find_velocity(around, body, at)
    water = p.water
    set_water_velocity(sea, at, around.time, water)
    along = (u - water[0]) * axis[0] + (v - water[1]) * axis[1] + (w - water[2]) * axis[2]
    return (1.0 - p.wake) * along


@inner
def look(p, around, sea):
    """The `Moment` of a thruster."""
    at = triple(around.site_xpos, p.site, 0)
    frame = around.site_xmat[p.site]
    axis = (frame[2], frame[5], frame[8])
    speed = find_speed(p, around)

    # the plane of the surface over the disc, and how it cuts the disc
    eta, gx, gy = tangent(sea.waves, at[0], at[1], around.time)
    steep = math.sqrt(1.0 + gx * gx + gy * gy)
    depth = (sea.level + eta - at[2]) / steep
    along = (axis[2] - gx * axis[0] - gy * axis[1]) / steep
    radius = 0.5 * p.diameter
    wet = wet_share(depth, math.sqrt(max(1.0 - along * along, 0.0)), radius)
    lost = airy = 0.0
    if p.air >= 0:
        airy = 1.0 - ventilated_share(depth, radius, wet)
        lost = min(max(around.act[p.air], 0.0), 1.0)
    if wet == 0.0:
        return Moment(speed, 0.0, 0.0, 0.0, 0.0, lost, airy)

    # bollard pull, what the flow leaves of it, and what the flow does to the blades
    square = signed_square(speed)
    last = p.curve.shape[0] - 1
    known = min(max(square, p.curve[0, SQUARE]), p.curve[last, SQUARE])
    beyond = square / known if known != 0.0 else 1.0
    thrust = beyond * interpolate(p.curve, SQUARE, THRUST, known)
    torque = beyond * interpolate(p.curve, SQUARE, TORQUE, known)
    inflow = drag = 0.0
    if p.advance.shape[0] > 0:
        inflow = find_inflow(p, around, sea, at, axis)
        of_thrust, of_torque, braking = meet_flow(p.advance, speed, inflow, p.diameter)
        thrust, torque = thrust * of_thrust, torque * of_torque
        drag = drag_blades(p.drag, sea.density, p.diameter, braking)

    # out of the water and in air
    denser, left = sea.density / p.density, wet * (1.0 - lost)
    thrust = denser * left * thrust + wet * drag
    torque *= denser * left**TORQUE_LOSS
    return Moment(speed, thrust, torque, inflow, wet, lost, airy)


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def advance(p, around, sea):
    """Write how fast the rotor follows, and how fast the share that air takes grows [1/s]."""
    if is_disabled(p, around):
        if p.state >= 0:
            around.act_dot[p.state] = 0.0
        if p.air >= 0:
            around.act_dot[p.air] = 0.0
        return
    now = look(p, around, sea)
    command = hear(p, around)
    if p.state >= 0 and p.inertia > 0.0:
        around.act_dot[p.state] = spin(
            around.act[p.state],
            2.0 * math.pi * demand_speed(command, p.deadband, p.demands, p.curve),
            now.torque,
            p.lag,
            p.inertia,
            p.limit,
            around.timestep,
            around.integrator,
        )
    elif p.state >= 0:
        rate = (command - around.act[p.state]) / p.lag
        around.act_dot[p.state] = hold_rate(rate, 1.0 / p.lag, around.timestep, around.integrator)
    if p.air >= 0:
        gap = now.airy - now.lost
        pace = abs(now.speed) / (1.0 if gap > 0.0 else p.recovery)
        around.act_dot[p.air] = hold_rate(gap * pace, pace, around.timestep, around.integrator)


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def push(p, around, sea):
    """Write the thrust to `actuator_force`, and to `qfrc_passive` the rest of the torque."""
    readings = p.device.readings
    if is_disabled(p, around):
        around.actuator_force[p.output] = 0.0
        readings[:] = 0.0
        turn_by(p, around, 0.0, 0.0, 0.0)
        return
    now = look(p, around, sea)
    around.actuator_force[p.output] = now.thrust
    if p.hand != 0.0:
        turn_hull(p, around, now)

    readings[READ_THRUST], readings[READ_TORQUE] = now.thrust, now.torque
    readings[READ_SPEED], readings[READ_INFLOW] = now.speed, now.inflow
    readings[READ_WET], readings[READ_LOST] = now.wet, now.lost
    square = signed_square(now.speed)
    bollard = interpolate(p.curve, SQUARE, TORQUE, square)
    current = interpolate(p.curve, SQUARE, CURRENT, square)
    readings[READ_CURRENT] = current * max(now.torque / bollard, 0.0) if bollard != 0.0 else 0.0


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def turn_hull(p, around, now):
    """Add the torque of the motor's reaction, and of the gyroscope that the rotor is.

    The rotor takes up the water's torque and what speeds it up; the hull gets the opposite, less
    what the transmission has put there already. H = I w z turns with the hull: -W x H.
    """
    frame = around.site_xmat[p.site]
    x, y, z = frame[2], frame[5], frame[8]
    rate = around.act_dot[p.state] if p.inertia > 0.0 else 0.0
    about = -p.hand * (now.torque + p.inertia * rate) - p.gear * now.thrust
    body = around.site_bodyid[p.site]
    turn = around.cvel[body]
    h = p.hand * p.inertia * 2.0 * math.pi * now.speed
    tx = about * x - h * (turn[1] * z - turn[2] * y)
    ty = about * y - h * (turn[2] * x - turn[0] * z)
    tz = about * z - h * (turn[0] * y - turn[1] * x)
    turn_by(p, around, tx, ty, tz)


@inner
def turn_by(p, around, tx, ty, tz):
    """Add a torque [N m] to `qfrc_passive`, in place of what it has added before.

    The engine may go over the actuators again without computing passive forces anew.
    """
    added = p.device.added
    dx, dy, dz = tx - added[0], ty - added[1], tz - added[2]
    added[0], added[1], added[2] = tx, ty, tz
    i = last_dof(around, around.site_bodyid[p.site])
    while i >= 0:
        c = around.cdof[i]
        around.qfrc_passive[i] += c[0] * dx + c[1] * dy + c[2] * dz
        i = around.dof_parentid[i]

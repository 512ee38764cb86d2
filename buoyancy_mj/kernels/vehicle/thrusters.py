"""What a thruster does at one instant: from its command and the water at its disc to its thrust."""

import math
from typing import Annotated, NamedTuple

from numba import njit

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.multibody import last_dof
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.immersion import ventilated_share, wet_share
from buoyancy_mj.kernels.vehicle.motion import find_velocity, set_water_velocity
from buoyancy_mj.kernels.vehicle.open_water import drag_blades, meet_flow
from buoyancy_mj.kernels.vehicle.rotor import (
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


class Propulsor(NamedTuple):
    """One thruster of one mjData."""

    device: Device
    site: int
    """Index of the site at the middle of its disc, whose z it pushes along."""
    actuator: int
    """Index of its actuator."""
    address: int
    """Index of its command in `ctrl`."""
    output: int
    """Index of its thrust in `actuator_force`."""
    state: int
    """Index in `act` of what follows the command with a lag: the speed [rad/s] of a rotor that has
    inertia, or else the command, from the one at which the rotor stands; -1 for no lag."""
    air: int
    """Index in `act` of the share of thrust that air takes; -1 for none."""
    neutral: float
    """The command at which the rotor stands."""
    deadband: float
    """From there to the first command that is heard."""
    absent: float
    """Commands below this are none."""
    diameter: float
    """[m]."""
    density: float
    """Of the water that the curve is for [kg/m^3]."""
    lag: float
    """[s]."""
    inertia: float
    """Of the rotor and the water that turns with it [kg m^2]."""
    limit: float
    """Torque of the motor at most [N m]."""
    hand: float
    """1 for a rotor that turns about +z to push ahead, -1 for the other way, 0 for no torque."""
    gear: float
    """Torque about z that the transmission of the actuator has for each newton [m]."""
    wake: float
    """Wake fraction."""
    recovery: float
    """Revolutions in which air leaves the disc."""
    drag: float
    """See `open_water.drag_blades`."""
    demands: Annotated[Doubles, ("k", 2)]
    """See `rotor.demand_speed`."""
    curve: Annotated[Doubles, ("m", 4)]
    """See `rotor`."""
    advance: Annotated[Doubles, ("j", 3)]
    """See `open_water`; no rows for a thrust that no flow changes."""
    water: Annotated[Doubles, (3,)]
    """Room for the water's velocity [m/s]."""


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


@njit(cache=True, error_model="numpy")
def is_disabled(p, equipment):
    """Whether the group of the actuator is switched off."""
    group = equipment.actuators.actuator_group[p.actuator]
    return 0 <= group < 31 and (equipment.disableactuator >> group) & 1 != 0


@njit(cache=True, error_model="numpy")
def hear(p, equipment):
    """The command, from the one at which the rotor stands; 0 for none."""
    actuators = equipment.actuators
    command = actuators.ctrl[p.address]
    # no number is no command, as for MuJoCo's own actuators
    if not math.isfinite(command) or command < p.absent:
        return 0.0
    clamps = equipment.option.disableflags & NO_CLAMP == 0
    if clamps and actuators.actuator_ctrllimited[p.address]:
        bounds = actuators.actuator_ctrlrange[p.address]
        command = min(max(command, bounds[0]), bounds[1])
    return command - p.neutral


@njit(cache=True, error_model="numpy")
def find_speed(p, equipment):
    """The speed of the rotor now [rev/s]."""
    if p.state < 0:
        return demand_speed(hear(p, equipment), p.deadband, p.demands, p.curve)
    followed = equipment.actuators.act[p.state]
    if p.inertia > 0.0:
        return followed / (2.0 * math.pi)
    return demand_speed(followed, p.deadband, p.demands, p.curve)


@njit(cache=True, error_model="numpy")
def find_inflow(p, equipment, sea, at, axis):
    """Velocity of the disc through the water along its thrust [m/s]."""
    body = equipment.sites.site_bodyid[p.site]
    u, v, w = find_velocity(equipment.bodies, body, at)
    water = p.water
    set_water_velocity(sea, at, equipment.time, water)
    along = (u - water[0]) * axis[0] + (v - water[1]) * axis[1] + (w - water[2]) * axis[2]
    return (1.0 - p.wake) * along


@njit(cache=True, error_model="numpy")
def look(p, equipment, sea):
    """The `Moment` of a thruster."""
    at = triple(equipment.sites.site_xpos, p.site, 0)
    frame = equipment.sites.site_xmat[p.site]
    axis = (frame[2], frame[5], frame[8])
    speed = find_speed(p, equipment)

    # the plane of the surface over the disc, and how it cuts the disc
    eta, gx, gy = tangent(sea.waves, at[0], at[1], equipment.time)
    steep = math.sqrt(1.0 + gx * gx + gy * gy)
    depth = (sea.level + eta - at[2]) / steep
    along = (axis[2] - gx * axis[0] - gy * axis[1]) / steep
    radius = 0.5 * p.diameter
    wet = wet_share(depth, math.sqrt(max(1.0 - along * along, 0.0)), radius)
    if wet == 0.0:
        return Moment(speed, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    lost = airy = 0.0
    if p.air >= 0:
        airy = 1.0 - ventilated_share(depth, radius, wet)
        lost = min(max(equipment.actuators.act[p.air], 0.0), 1.0)

    # bollard pull, what the flow leaves of it, and what the flow does to the blades
    square = signed_square(speed)
    last = p.curve.shape[0] - 1
    known = min(max(square, p.curve[0, SQUARE]), p.curve[last, SQUARE])
    beyond = square / known if known != 0.0 else 1.0
    thrust = beyond * interpolate(p.curve, SQUARE, THRUST, known)
    torque = beyond * interpolate(p.curve, SQUARE, TORQUE, known)
    inflow = drag = 0.0
    if p.advance.shape[0] > 0:
        inflow = find_inflow(p, equipment, sea, at, axis)
        of_thrust, of_torque, braking = meet_flow(p.advance, speed, inflow, p.diameter)
        thrust, torque = thrust * of_thrust, torque * of_torque
        drag = drag_blades(p.drag, sea.density, p.diameter, braking)

    # out of the water and in air
    denser, left = sea.density / p.density, wet * (1.0 - lost)
    thrust = denser * left * thrust + wet * drag
    torque *= denser * left**TORQUE_LOSS
    return Moment(speed, thrust, torque, inflow, wet, lost, airy)


@njit(cache=True, error_model="numpy")
def advance(p, equipment, sea):
    """Write how fast the rotor follows, and how fast the share that air takes grows [1/s]."""
    actuators, option = equipment.actuators, equipment.option
    if is_disabled(p, equipment):
        if p.state >= 0:
            actuators.act_dot[p.state] = 0.0
        if p.air >= 0:
            actuators.act_dot[p.air] = 0.0
        return
    now = look(p, equipment, sea)
    command = hear(p, equipment)
    if p.state >= 0 and p.inertia > 0.0:
        actuators.act_dot[p.state] = spin(
            actuators.act[p.state],
            2.0 * math.pi * demand_speed(command, p.deadband, p.demands, p.curve),
            now.torque,
            p.lag,
            p.inertia,
            p.limit,
            option.timestep,
            equipment.integrator,
        )
    elif p.state >= 0:
        rate = (command - actuators.act[p.state]) / p.lag
        actuators.act_dot[p.state] = hold_rate(
            rate, 1.0 / p.lag, option.timestep, equipment.integrator
        )
    if p.air >= 0:
        gap = now.airy - now.lost
        pace = abs(now.speed) / (1.0 if gap > 0.0 else p.recovery)
        actuators.act_dot[p.air] = hold_rate(
            gap * pace, pace, option.timestep, equipment.integrator
        )


@njit(cache=True, error_model="numpy")
def push(p, equipment, sea):
    """Write the thrust to `actuator_force`, and to `qfrc_passive` the rest of the torque."""
    readings = p.device.readings
    actuators = equipment.actuators
    if is_disabled(p, equipment):
        actuators.actuator_force[p.output] = 0.0
        readings[:] = 0.0
        return
    now = look(p, equipment, sea)
    actuators.actuator_force[p.output] = now.thrust
    if p.hand != 0.0:
        turn_hull(p, equipment, now)

    readings[READ_THRUST], readings[READ_TORQUE] = now.thrust, now.torque
    readings[READ_SPEED], readings[READ_INFLOW] = now.speed, now.inflow
    readings[READ_WET], readings[READ_LOST] = now.wet, now.lost
    square = signed_square(now.speed)
    bollard = interpolate(p.curve, SQUARE, TORQUE, square)
    current = interpolate(p.curve, SQUARE, CURRENT, square)
    readings[READ_CURRENT] = current * max(now.torque / bollard, 0.0) if bollard != 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def turn_hull(p, equipment, now):
    """Add the torque of the motor's reaction, and of the gyroscope that the rotor is.

    The rotor takes up the water's torque and what speeds it up; the hull gets the opposite, less
    what the transmission has put there already. H = I w z turns with the hull: -W x H.
    """
    frame = equipment.sites.site_xmat[p.site]
    x, y, z = frame[2], frame[5], frame[8]
    rate = equipment.actuators.act_dot[p.state] if p.inertia > 0.0 else 0.0
    about = -p.hand * (now.torque + p.inertia * rate) - p.gear * now.thrust
    body = equipment.sites.site_bodyid[p.site]
    turn = equipment.bodies.cvel[body]
    h = p.hand * p.inertia * 2.0 * math.pi * now.speed
    tx = about * x - h * (turn[1] * z - turn[2] * y)
    ty = about * y - h * (turn[2] * x - turn[0] * z)
    tz = about * z - h * (turn[0] * y - turn[1] * x)

    joints = equipment.joints
    i = last_dof(joints, body)
    while i >= 0:
        c = joints.cdof[i]
        equipment.qfrc_passive[i] += c[0] * tx + c[1] * ty + c[2] * tz
        i = joints.dof_parentid[i]

"""The rotor of a thruster: what it is told, and how fast it follows."""

import math

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.vehicle.tables import interpolate

SQUARE, THRUST, TORQUE, CURRENT = range(4)
"""Columns of a bollard curve: n |n| [rev^2/s^2]; thrust [N], torque [N m] and current [A] at that
speed n without inflow."""
COMMAND, SPEED = range(2)
"""Columns of a table of demands: the command, from the one at which the rotor stands, and the speed
n [rev/s] that it asks for."""
RK4 = 1
"""MuJoCo's mjINT_RK4."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def signed_square(n):
    """The square of a number with its sign."""
    return n * abs(n)


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def signed_root(square):
    """The number whose signed square this is."""
    return math.copysign(math.sqrt(abs(square)), square)


@inner
def demand_speed(
    command,  # from the one at which the rotor stands
    deadband,  # to the first command that is heard
    demands,  # (k, 2); without rows the command is a thrust
    curve,  # (m, 4)
):
    """The speed of the rotor [rev/s] that a command asks for."""
    if abs(command) < deadband:
        return 0.0
    if demands.shape[0] == 0:
        return signed_root(interpolate(curve, THRUST, SQUARE, command))
    return interpolate(demands, COMMAND, SPEED, command)


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def hold_rate(
    rate,  # of a number at the beginning of a step
    decay,  # by which the rate falls as the number grows [1/s]
    timestep,  # [s]
    integrator,  # one of mjtIntegrator
):
    """The rate with which MuJoCo's integrator brings a number to where it is after a step.

    Euler's step needs the mean rate of the exponential, (1 - e^-x) / x of it with x = decay times
    timestep. Runge and Kutta's four passes find it by themselves up to x = 1; beyond, the number
    follows within a few steps.
    """
    x = decay * timestep
    if integrator == RK4:
        return rate / max(x, 1.0)
    return rate if x < 1e-9 else -rate * math.expm1(-x) / x


@njit(cache=True, error_model="numpy", _nrt=False)
def spin(
    speed,  # [rad/s]
    target,  # [rad/s]
    load,  # torque of the water against the rotor [N m]
    lag,  # with which the drive follows [s]
    inertia,  # of the rotor and the water that turns with it, I [kg m^2]
    limit,  # torque of the motor at most [N m]
    timestep,  # [s]
    integrator,  # one of mjtIntegrator
):
    """How fast the speed of a rotor changes [rad/s^2].

    A governor closes the gap to the target with a lag. It needs the motor's torque I dw/dt + Q;
    where that is beyond the motor's limit, the rest of it turns the rotor, with the water's torque
    as the square of the speed.
    """
    rate = (target - speed) / lag
    governed = hold_rate(rate, 1.0 / lag, timestep, integrator)
    torque = inertia * rate + load
    if abs(torque) <= limit:
        return governed
    bound = math.copysign(limit, torque)
    decay = 2.0 * abs(load) / (inertia * max(abs(speed), 1.0))
    driven = hold_rate((bound - load) / inertia, decay, timestep, integrator)
    # the motor stops pushing where the gap is closed within the step
    return min(governed, driven) if torque > 0.0 else max(governed, driven)

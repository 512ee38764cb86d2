"""How thrust and torque of a propeller change with the flow into it, in all four quadrants."""

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.vehicle.tables import interpolate

ADVANCE, THRUST, TORQUE = range(3)
"""Columns of a curve: J = V / (n D), and K_T and K_Q over those at J = 0."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _share(curve, column, j):
    """A column of a curve at J: that at J = 0 below, and straight on beyond the end."""
    last = curve.shape[0] - 1
    if j <= curve[last, ADVANCE]:
        return interpolate(curve, ADVANCE, column, j)
    slope = (curve[last, column] - curve[last - 1, column]) / (
        curve[last, ADVANCE] - curve[last - 1, ADVANCE]
    )
    return curve[last, column] + slope * (j - curve[last, ADVANCE])


@njit(cache=True, error_model="numpy", _nrt=False)
def meet_flow(
    curve,  # (k, 3), from J = 0 on
    speed,  # of the rotor, n [rev/s]
    inflow,  # velocity of the disc through the water along its thrust, V [m/s]
    diameter,  # D [m]
):
    """Shares of bollard thrust and torque that a flow leaves, and the flow that brakes [m/s].

    The flow that brakes is that beyond the end of the curve, or from behind: there the blades are
    dragged like those of a screw that stands, which is all that there is at n = 0.
    """
    advance = inflow if speed >= 0.0 else -inflow
    turning = abs(speed) * diameter
    if turning < 1e-6:
        return 0.0, 0.0, inflow
    j = advance / turning
    end = curve[curve.shape[0] - 1, ADVANCE]
    braking = advance if j < 0.0 else max(advance - end * turning, 0.0)
    braking = braking if speed >= 0.0 else -braking
    return _share(curve, THRUST, j), _share(curve, TORQUE, j), braking


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def drag_blades(drag, density, diameter, braking):
    """Force [N] along the thrust on blades that a flow drags.

    `drag` is half the drag coefficient, of the blades' area over D^2.
    """
    return -drag * density * diameter * diameter * braking * abs(braking)

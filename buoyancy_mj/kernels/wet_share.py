"""The wet share of a body: what part of its volume is under water, its gradient and its rate.

A body that moves by dx takes in water over its waterplane alone, so that with the elevation eta

    dV = int (eta_x dx_x + eta_y dx_y - dx_z) dxdy,   dV/dt at rest = int eta_t dxdy

over the waterplane. On still water the gradient is the waterplane's area, downward at its centroid.
In waves slope and rate of the surface are taken at that centroid.
"""

import math

from buoyancy_mj.kernels.clip import VOLUME, WATERPLANE_AREA, WATERPLANE_X, WATERPLANE_Y
from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.vectors import rotate_back
from buoyancy_mj.kernels.waves import AMPLITUDE, KX, KY, OMEGA, phase_at


@njit(cache=True, error_model="numpy", inline="always")
def wet_share(centres, b, volume):
    """The part of a body's volume [m^3] that is wet, from 0 to 1."""
    return min(centres[b, VOLUME] / volume, 1.0)


@inner
def set_gradient(
    hulls,  # indices of the hulls of the body
    wet,  # (h, 8) submersion of all hulls
    volume,  # of the body [m^3]
    level,  # [m]
    waves,  # (w, 6)
    time,  # [s]
    r,  # (9,) world_from_body
    origin,  # (3,) of the body [m]
    out,  # (6,) written
):
    """Write the gradient of the wet share, and return its rate [1/s] while the body is at rest.

    The gradient [1/m, 1/rad] is along the body's axes, about its origin. The scalar product with
    the body's velocity there, plus that rate, is how fast the share grows.
    """
    # the waterplane of all hulls
    area = x = y = 0.0
    for h in hulls:
        part = wet[h, WATERPLANE_AREA]
        if part != 0.0:
            area += part
            x += part * wet[h, WATERPLANE_X]
            y += part * wet[h, WATERPLANE_Y]
    if not area > 0.0:
        out[:] = 0.0
        return 0.0
    x, y = x / area, y / area

    # the surface there
    eta, along, across, rise = _surface(waves, x, y, time)
    share = area / volume
    fx, fy, fz = share * along, share * across, -share
    ax, ay, az = x - origin[0], y - origin[1], level + eta - origin[2]
    tx, ty, tz = ay * fz - az * fy, az * fx - ax * fz, ax * fy - ay * fx
    out[0], out[1], out[2] = rotate_back(r, fx, fy, fz)
    out[3], out[4], out[5] = rotate_back(r, tx, ty, tz)
    return share * rise


@njit(cache=True, error_model="numpy", inline="always")
def _surface(waves, x, y, time):
    """Elevation over the still level at a place, its gradient, and its rate there."""
    eta = along = across = rise = 0.0
    for w in range(waves.shape[1]):
        angle = phase_at(waves, w, x, y, time)
        eta += waves[AMPLITUDE, w] * math.cos(angle)
        slope = waves[AMPLITUDE, w] * math.sin(angle)
        along -= waves[KX, w] * slope
        across -= waves[KY, w] * slope
        rise += waves[OMEGA, w] * slope
    return eta, along, across, rise

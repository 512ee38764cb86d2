"""How a point of a body moves, and the water around it."""

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.currents import set_current
from buoyancy_mj.kernels.vectors import difference
from buoyancy_mj.kernels.waves import add_velocity, elevation


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def find_velocity(
    bodies,  # `multibody.Bodies`
    b,  # index of the body
    at,  # (3) [m]
):
    """Velocity (3) [m/s] of the point of a body that is at a place, in the world's axes."""
    spin, com = bodies.cvel[b], bodies.subtree_com[bodies.body_rootid[b]]
    x, y, z = difference(at, com)
    return (
        spin[3] + spin[1] * z - spin[2] * y,
        spin[4] + spin[2] * x - spin[0] * z,
        spin[5] + spin[0] * y - spin[1] * x,
    )


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def find_depth(
    sea,  # `sea.Sea`
    at,  # (3) [m]
    time,  # [s]
):
    """How deep a place is under the surface above it [m]; less than 0 in the air."""
    return sea.level + elevation(sea.waves, at[0], at[1], time) - at[2]


@inner
def set_water_velocity(
    sea,  # `sea.Sea`
    at,  # (3) [m]
    time,  # [s]
    out,  # (3,) [m/s]
):
    """Write the velocity of current and waves at a place to `out`, in the world's axes."""
    set_current(sea.current, sea.level - at[2], time, out)
    add_velocity(sea.waves, at[0], at[1], at[2] - sea.level, time, out)

"""How fast ballast changes: pumps by command, openings by the head.

Through an opening of area A water flows at Cd A sqrt(2 g h), h the difference of the heads on its
two sides (Torricelli). While the head falls in proportion to what has passed, as in a tank with
upright walls, its root falls evenly with time: the mean flow over a timestep follows in closed
form, at any timestep, and stops where the heads are equal. So no flow turns round within a step.
"""

import math

from buoyancy_mj.kernels import fills
from buoyancy_mj.kernels.compiling import inner
from buoyancy_mj.kernels.vectors import triple
from buoyancy_mj.kernels.waves import elevation

BLADDER, TANK, COMPARTMENT = range(3)
"""Kinds of ballast, in `Ballast.kinds`."""
ATMOSPHERE = 101325.0
"""Pressure of the air [Pa] (ISO 2533)."""


@inner
def find_flow(
    ballast,  # `ballast.Ballast`
    n,  # index of the bladder, tank or compartment
    commands,  # `multibody.Commands`
    geoms,  # `multibody.Geoms`
    sea,  # `sea.Sea`
    time,  # [s]
    timestep,  # [s]
    gravity,  # downward acceleration [m/s^2]
):
    """How fast a volume grows [m^3/s]: the mean over the timestep that begins."""
    capacity = ballast.capacities[n]
    volume = min(max(commands.act[ballast.acts[n]], 0.0), capacity)
    if not timestep > 0.0:
        return 0.0
    if ballast.kinds[n] != COMPARTMENT:
        u = ballast.addresses[n]
        wanted = commands.ctrl[u]
        # no number is no command
        if not math.isfinite(wanted):
            return 0.0
        if commands.actuator_ctrllimited[u]:
            low, high = commands.actuator_ctrlrange[u, 0], commands.actuator_ctrlrange[u, 1]
            wanted = min(max(wanted, low), high)
        wanted = min(max(wanted, 0.0), capacity)
        # from the state as it is, so that one beyond its limits comes back
        volume = commands.act[ballast.acts[n]]
        flow = (wanted - volume) / timestep
        # what rounding leaves of it
        flow += (wanted - (volume + flow * timestep)) / timestep
        return min(max(flow, -ballast.rates[n]), ballast.rates[n])

    # at this volume, and at the one that the flow of now would bring
    if not gravity * sea.density > 0.0:
        return 0.0
    steepness = ballast.openings[n] * math.sqrt(2.0 * gravity)
    x, y, z = triple(commands.site_xpos, ballast.sites[n], 0)
    outside = max(sea.level + elevation(sea.waves, x, y, time) - z, 0.0)
    specific_weight = gravity * sea.density
    head = _find_head(ballast, n, volume, outside, z, geoms, specific_weight)
    if head == 0.0:
        return 0.0
    sign = 1.0 if head > 0.0 else -1.0
    root = math.sqrt(abs(head))
    flow = sign * steepness * root
    there = min(max(volume + flow * timestep, 0.0), capacity)
    passed = abs(there - volume)
    if not passed > 0.0:
        return 0.0
    head_there = _find_head(ballast, n, there, outside, z, geoms, specific_weight)
    slope = (abs(head) - sign * head_there) / passed
    if not slope * passed > 1e-12 * abs(head):
        return (there - volume) / timestep

    # the mean over the timestep, of a head that falls with that slope
    left = max(root - 0.5 * slope * steepness * timestep, 0.0)
    mean = sign * (abs(head) - left * left) / (slope * timestep)
    return min(max(mean, -volume / timestep), (capacity - volume) / timestep)


@inner
def _find_head(ballast, n, volume, outside, opening, geoms, specific_weight):
    """The head [m] that drives water through an opening at a height; positive inwards.

    `outside` is the depth of the opening. Only water flows: none leaves what is not above the
    opening, and none enters an opening that is dry.
    """
    geom = ballast.frames[n]
    turn = geoms.geom_xmat[geom]
    level, _, _, _, _ = fills.find_level(ballast.fills, n, turn[6], turn[7], turn[8], volume)
    inside = max(level + geoms.geom_xpos[geom, 2] - opening, 0.0) if volume > 0.0 else 0.0
    head = outside - inside
    if ballast.sealed[n] != 0:
        # the air that filled it at the pressure of the atmosphere, at the same temperature (Boyle)
        air = ballast.capacities[n] - volume
        if not air > 0.0:
            return min(head, 0.0)
        head -= ATMOSPHERE * volume / (air * specific_weight)
    if (head > 0.0 and not outside > 0.0) or (head < 0.0 and not inside > 0.0):
        return 0.0
    return head

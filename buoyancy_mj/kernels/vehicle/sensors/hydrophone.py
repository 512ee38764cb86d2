"""A hydrophone: where a pinger was when the sound left it that arrives now."""

import math
from typing import NamedTuple

import numpy as np

from buoyancy_mj.kernels.compiling import inner
from buoyancy_mj.kernels.vectors import difference, rotate_back, triple
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.motion import find_depth, find_velocity
from buoyancy_mj.kernels.vehicle.sensors.sampling import (
    HELD,
    Mount,
    find_sample,
    take_sample,
)
from buoyancy_mj.kernels.vehicle.sensors.water import find_site

RANGE, TRAVEL = 0, 3
"""Columns of what it reads."""
JUST = 1e-9
"""Part of a period that a ping may be early, for times are rounded."""


class HydrophoneSensor(NamedTuple):
    """One hydrophone."""

    device: Device
    mount: Mount
    pinger: int
    """Index of the site of the pinger; -1 for none."""
    pinger_body: int
    """Index of its body."""
    speed: float
    """Of sound [m/s]."""
    period: float
    """From ping to ping [s]; 0 for a sound that never ends."""


@inner
def measure_hydrophone(sensor, equipment, sea):
    """Range [m], bearing and elevation [rad] and travel time [s] of the sound that arrives now.

    The pinger is taken to have moved straight, at p - v t where it is at p now. Then the way w =
    p - h to it from the hydrophone at h gives |w - v t| = c t, so that with u = w v

        t = (sqrt(u^2 + (c^2 - v^2) w^2) - u) / (c^2 - v^2)

    Returns:
        The number of the ping.
    """
    mount, truth = sensor.mount, sensor.mount.truth
    truth[:] = math.nan
    if sensor.pinger < 0:
        return find_sample(mount, equipment)
    at = find_site(mount, equipment)
    theirs = triple(equipment.sites.site_xpos, sensor.pinger, 0)
    way = difference(theirs, at)
    velocity = find_velocity(equipment.bodies, sensor.pinger_body, theirs)

    # how long the sound was under way
    towards = way[0] * velocity[0] + way[1] * velocity[1] + way[2] * velocity[2]
    square = velocity[0] ** 2 + velocity[1] ** 2 + velocity[2] ** 2
    left = sensor.speed * sensor.speed - square
    length = way[0] ** 2 + way[1] ** 2 + way[2] ** 2
    if not left > 0.0:
        return find_sample(mount, equipment)
    travel = (math.sqrt(towards * towards + left * length) - towards) / left

    # which ping it is
    sent = equipment.time - travel
    ping = find_sample(mount, equipment)
    if sensor.period > 0.0:
        ping = np.int64(math.floor(sent / sensor.period + JUST))
        if ping < 0:
            return ping

    # whether both are in the water, and where it came from
    source = (
        theirs[0] - travel * velocity[0],
        theirs[1] - travel * velocity[1],
        theirs[2] - travel * velocity[2],
    )
    if find_depth(sea, at, equipment.time) > 0.0 and find_depth(sea, source, sent) > 0.0:
        dx, dy, dz = difference(source, at)
        x, y, z = rotate_back(equipment.sites.site_xmat[mount.site], dx, dy, dz)
        truth[0], truth[3] = sensor.speed * travel, travel
        truth[1], truth[2] = math.atan2(y, x), math.atan2(z, math.hypot(x, y))
    return ping


@inner
def hear_ping(sensor, equipment, ping):
    """Take a sample, whose range is its travel time's, noise and all."""
    mount = sensor.mount
    take_sample(mount, equipment, ping)
    data, state = equipment.sensing.sensordata, equipment.sensing.plugin_state
    far = data[mount.address + RANGE]
    if far >= 0.0:
        data[mount.address + TRAVEL] = far / sensor.speed
        state[mount.state + HELD + TRAVEL] = far / sensor.speed

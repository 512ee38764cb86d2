"""A Doppler velocity log: velocity from the beams that come back."""

import math
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Doubles
from buoyancy_mj.kernels.compiling import inner, njit, register_jitable
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.motion import find_depth, find_velocity, set_water_velocity
from buoyancy_mj.kernels.vehicle.sensors.echoes import Echoes, drop_dry, find_end
from buoyancy_mj.kernels.vehicle.sensors.sampling import Mount
from buoyancy_mj.kernels.vehicle.sensors.water import find_site

LOCK, RANGES = 3, 4
"""Columns of what it reads, after the velocity: the lock, and the ranges of the beams."""
NONE, BOTTOM, WATER = 0.0, 1.0, 2.0
"""What it may be locked to."""
FEWEST = 3
"""Beams that a velocity takes."""


class DvlSensor(NamedTuple):
    """One Doppler velocity log."""

    device: Device
    mount: Mount
    echoes: Echoes
    """Its beams."""
    layer: float
    """How far along the beams the layer of water is that it may lock to [m]; 0 for none."""
    solvers: Annotated[Doubles, ("s", 4)]
    """For each set of beams, by its bits, three rows: the velocity in the site's axes that fits the
    speeds along the beams best."""
    speeds: Annotated[Doubles, (4,)]
    """Speeds along the beams [m/s]."""


@register_jitable(error_model="numpy")
def measure_dvl(sensor, equipment, sea):
    """Velocity (3) over the bottom or through the water [m/s], lock, and four ranges [m]."""
    mount, echoes = sensor.mount, sensor.echoes
    at = find_site(mount, equipment)
    is_wet = drop_dry(echoes, equipment, sea, at)
    for b in range(4):
        if not echoes.nearest <= echoes.ranges[b] <= echoes.farthest:
            echoes.ranges[b] = math.nan
        mount.truth[RANGES + b] = echoes.ranges[b]
    mount.truth[:LOCK] = math.nan
    mount.truth[LOCK] = NONE
    if not is_wet:
        return

    # over the bottom, or through a layer of the water
    velocity = find_velocity(equipment.bodies, mount.body, at)
    if _solve(sensor, _listen_to_bottom(sensor, equipment, at, velocity)):
        mount.truth[LOCK] = BOTTOM
    elif sensor.layer > 0.0:
        beams = _listen_to_water(sensor, equipment, sea, at, velocity)
        if _solve(sensor, beams):
            mount.truth[LOCK] = WATER


@inner
def _listen_to_bottom(sensor, equipment, at, velocity):
    """Set the speeds along the beams that met something; those beams as bits."""
    echoes, beams = sensor.echoes, 0
    for b in range(4):
        if math.isnan(echoes.ranges[b]):
            continue
        end = find_end(echoes, b, at, echoes.ranges[b])
        theirs = find_velocity(equipment.bodies, echoes.met[b], end)
        sensor.speeds[b] = _project(echoes.ways[b], velocity, theirs)
        beams |= 1 << b
    return beams


@inner
def _listen_to_water(sensor, equipment, sea, at, velocity):
    """Set the speeds along the beams through the layer, where it is water; those beams as bits."""
    echoes, water, beams = sensor.echoes, sensor.mount.truth[:LOCK], 0
    for b in range(4):
        end = find_end(echoes, b, at, sensor.layer)
        if echoes.ranges[b] < sensor.layer or not find_depth(sea, end, equipment.time) > 0.0:
            continue
        set_water_velocity(sea, end, equipment.time, water)
        sensor.speeds[b] = _project(echoes.ways[b], velocity, water)
        beams |= 1 << b
    return beams


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _project(way, ours, theirs):
    """How fast one moves towards another along a way [m/s]."""
    return (
        way[0] * (ours[0] - theirs[0])
        + way[1] * (ours[1] - theirs[1])
        + way[2] * (ours[2] - theirs[2])
    )


@njit(cache=True, error_model="numpy", _nrt=False)
def _solve(sensor, beams):
    """Write the velocity that fits the speeds along some beams; whether they are enough."""
    truth, speeds = sensor.mount.truth, sensor.speeds
    count = 0
    for b in range(4):
        count += (beams >> b) & 1
    if count < FEWEST:
        truth[:LOCK] = math.nan
        return False
    for axis in range(3):
        row = sensor.solvers[3 * beams + axis]
        total = 0.0
        for b in range(4):
            if (beams >> b) & 1:
                total += row[b] * speeds[b]
        truth[axis] = total
    return True

"""Sensors of the water at a site: pressure, depth, the surface's height, velocities, wet or dry."""

from typing import NamedTuple

from buoyancy_mj.kernels.compiling import njit, register_jitable
from buoyancy_mj.kernels.multibody import downward_gravity
from buoyancy_mj.kernels.vectors import rotate_back, triple
from buoyancy_mj.kernels.vehicle.devices import Device
from buoyancy_mj.kernels.vehicle.motion import find_depth, find_velocity, set_water_velocity
from buoyancy_mj.kernels.vehicle.sensors.sampling import Mount
from buoyancy_mj.kernels.waves import elevation, head


class SiteSensor(NamedTuple):
    """A sensor with one option."""

    device: Device
    mount: Mount
    option: float
    """What it means stands with each that reads it."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def find_site(mount, equipment):
    """Where a sensor is [m]."""
    return triple(equipment.sites.site_xpos, mount.site, 0)


@register_jitable(error_model="numpy")
def measure_pressure(sensor, equipment, sea):
    """Pressure [Pa] in excess of the air's; the option is the air's that is added.

    See `waves.head`. In the air it is the option alone.
    """
    mount, option = sensor.mount, equipment.option
    at = find_site(mount, equipment)
    pressure = 0.0
    if find_depth(sea, at, equipment.time) > 0.0:
        gravity = downward_gravity(option.gravity, option.disableflags)
        high = head(sea.waves, at[0], at[1], at[2] - sea.level, equipment.time, True)
        pressure = sea.density * gravity * high
    mount.truth[0] = pressure + sensor.option


@register_jitable(error_model="numpy")
def measure_depth(sensor, equipment, sea):
    """How deep the site is under the surface above it [m]; option 1: under the still level."""
    at = find_site(sensor.mount, equipment)
    sensor.mount.truth[0] = (
        sea.level - at[2] if sensor.option != 0.0 else find_depth(sea, at, equipment.time)
    )


@register_jitable(error_model="numpy")
def measure_elevation(sensor, equipment, sea):
    """Height of the surface above or below the site [m], world frame."""
    at = find_site(sensor.mount, equipment)
    sensor.mount.truth[0] = sea.level + elevation(sea.waves, at[0], at[1], equipment.time)


@register_jitable(error_model="numpy")
def measure_water_velocity(sensor, equipment, sea):
    """Velocity of the water at the site [m/s], 0 in the air; option 1: in the site's axes."""
    mount, truth = sensor.mount, sensor.mount.truth
    at = find_site(mount, equipment)
    truth[:] = 0.0
    if find_depth(sea, at, equipment.time) > 0.0:
        set_water_velocity(sea, at, equipment.time, truth)
    if sensor.option != 0.0:
        axes = equipment.sites.site_xmat[mount.site]
        truth[0], truth[1], truth[2] = rotate_back(axes, truth[0], truth[1], truth[2])


@register_jitable(error_model="numpy")
def measure_speed_through_water(sensor, equipment, sea):
    """Velocity of the site less that of the water there [m/s], site's axes; 0 in the air."""
    mount, truth = sensor.mount, sensor.mount.truth
    at = find_site(mount, equipment)
    truth[:] = 0.0
    if not find_depth(sea, at, equipment.time) > 0.0:
        return
    set_water_velocity(sea, at, equipment.time, truth)
    u, v, w = find_velocity(equipment.bodies, mount.body, at)
    axes = equipment.sites.site_xmat[mount.site]
    truth[0], truth[1], truth[2] = rotate_back(axes, u - truth[0], v - truth[1], w - truth[2])


@register_jitable(error_model="numpy")
def measure_wet(sensor, equipment, sea):
    """Whether the site is in the water, 0 or 1; the option is the radius [m] of a ball there.

    Then it is the share of the ball's volume that lies under a level surface at that depth, a cap
    of height h: h^2 (3 r - h) / (4 r^3).
    """
    depth = find_depth(sea, find_site(sensor.mount, equipment), equipment.time)
    radius = sensor.option
    if radius > 0.0:
        cap = min(max(1.0 + depth / radius, 0.0), 2.0)
        sensor.mount.truth[0] = 0.25 * cap * cap * (3.0 - cap)
    else:
        sensor.mount.truth[0] = 1.0 if depth > 0.0 else 0.0

"""Sensors as C functions of the addresses of mjModel, mjData and a sensor's NamedTuple.

They return 0, for they cannot fail.
"""

import functools
from collections.abc import Callable

from numba import int64

from buoyancy_mj.kernels.compiling import register_jitable
from buoyancy_mj.kernels.entries.rays import cast_rays
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.sea import Sea
from buoyancy_mj.kernels.vehicle.equipment import SensorEquipment
from buoyancy_mj.kernels.vehicle.sensors import hydrophone
from buoyancy_mj.kernels.vehicle.sensors.hydrophone import HydrophoneSensor
from buoyancy_mj.kernels.vehicle.sensors.sampling import (
    find_sample,
    hold_sample,
    is_held,
    take_sample,
)


@register_jitable()
def _sound(model, data, known, equipment):
    """Cast the beams of a sensor."""
    cast_rays(model, data, known.mount, known.echoes, equipment)


@register_jitable()
def _keep_still(model, data, known, equipment):
    """Do nothing: the sensor has no beams."""


@functools.cache
def make_entry(
    kind: type, measure: Callable[..., None], sound: Callable[..., None] = _keep_still
) -> Callable[..., int]:
    """What reads sensors of a NamedTuple class, from what measures them and what sounds before."""

    def entry(model: int64, data: int64, sensor: int64) -> int64:
        known = view(sensor, kind)
        equipment = view_engine(model, data, known.device.offsets, SensorEquipment)
        mount = known.mount
        sample = find_sample(mount, equipment)
        if mount.rate > 0.0 and is_held(mount, equipment, sample):
            hold_sample(mount, equipment)
        else:
            sound(model, data, known, equipment)
            measure(known, equipment, view(known.device.sea, Sea))
            take_sample(mount, equipment, sample)
        return 0

    return entry


def make_echo_entry(kind: type, measure: Callable[..., None]) -> Callable[..., int]:
    """The same for sensors with beams."""
    return make_entry(kind, measure, _sound)


def read_hydrophone(model: int64, data: int64, sensor: int64) -> int64:
    """Read a hydrophone: it takes a sample when a ping arrives."""
    known = view(sensor, HydrophoneSensor)
    equipment = view_engine(model, data, known.device.offsets, SensorEquipment)
    ping = hydrophone.measure_hydrophone(known, equipment, view(known.device.sea, Sea))
    if known.period > 0.0 and is_held(known.mount, equipment, ping):
        hold_sample(known.mount, equipment)
    else:
        hydrophone.hear_ping(known, equipment, ping)
    return 0

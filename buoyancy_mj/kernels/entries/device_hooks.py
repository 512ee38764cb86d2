"""The C functions of the engine's plugins for thrusters, tanks and sensors, shared by all kinds.

What a kind does stands at the addresses that its `Device` holds; it is compiled when a model first
has one.
"""

from typing import NamedTuple

import numpy as np
from numba import int32, int64, void

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.entries.pointers import call, set_word, word
from buoyancy_mj.kernels.entries.views import view
from buoyancy_mj.kernels.vehicle.devices import ALIVE, CHANGES, MODEL, Device

PASSIVE = 4
"""MuJoCo's mjPLUGIN_PASSIVE."""


class DeviceContext(NamedTuple):
    """What the hooks are given."""

    plugin_data: int
    """Byte offset of mjData.plugin_data."""
    resolve: int
    """A C function f(mjModel, mjData, instance) that puts a device into the data."""
    changes: int
    """Address of the word that counts how often the waters that act have changed."""
    error: int
    """MuJoCo's mju_error."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _slot(data, instance, context):
    """Address of the word that the engine keeps for an instance: the address of a device, or 0."""
    return word(data + view(context, DeviceContext).plugin_data) + 8 * instance


@inner
def _tell(text, context):
    """Tell the engine what failed; 0 for nothing."""
    if text != 0:
        call(view(context, DeviceContext).error, (text,))


@inner
def _find_device(model, data, instance, context):
    """The address of the device of an instance, of this model and of the waters of now.

    It is 0 while Python is just reading the model.
    """
    links, slot = view(context, DeviceContext), _slot(data, instance, context)
    device = word(slot)
    if device != 0:
        ids = view(device, Device).ids
        if ids[MODEL] == model and ids[CHANGES] == word(links.changes):
            return device
    _tell(call(links.resolve, (model, data, np.int64(instance))), context)
    return word(slot)


def count(model: int64, instance: int32, number: int64) -> int32:
    """The engine asks how many numbers of an instance are part of a state."""
    return np.int32(number)


def count_readings(model: int64, instance: int32, sensor: int32, number: int64) -> int32:
    """The engine asks how many numbers a sensor has."""
    return np.int32(number)


def reset(model: int64, state: int64, device: int64, instance: int32, count: int64) -> void:
    """The engine resets a data: the numbers in its state become 0."""
    for i in range(count):
        set_word(state + 8 * i, 0)


def init(model: int64, data: int64, instance: int32, context: int64) -> int32:
    """The engine has made a data."""
    set_word(_slot(data, instance, context), 0)
    _find_device(model, data, instance, context)
    return np.int32(0)


def destroy(data: int64, instance: int32, context: int64) -> void:
    """The engine frees a data: its device may serve another."""
    device = word(_slot(data, instance, context))
    if device != 0:
        view(device, Device).ids[ALIVE] = 0


def copy(target: int64, model: int64, source: int64, instance: int32, context: int64) -> void:
    """The engine copies a data: the readings go along, and what was added to its forces."""
    one, other = word(_slot(target, instance, context)), word(_slot(source, instance, context))
    if one == 0 or other == 0:
        return
    into, readings = view(one, Device).readings, view(other, Device).readings
    for i in range(min(into.shape[0], readings.shape[0])):
        into[i] = readings[i]
    added, others = view(one, Device).added, view(other, Device).added
    for i in range(others.shape[0]):
        added[i] = others[i]


def actuator_act_dot(model: int64, data: int64, instance: int32, context: int64) -> void:
    """The engine wants the rates of an actuator's states; it does so before each `compute`."""
    device = _find_device(model, data, instance, context)
    if device != 0:
        function = view(device, Device).advance
        if function != 0:
            _tell(call(function, (model, data, device)), context)


def compute(model: int64, data: int64, instance: int32, capability: int32, context: int64) -> void:
    """The engine wants what a device does, or has just computed its passive forces."""
    device = _find_device(model, data, instance, context)
    if device != 0 and capability == PASSIVE:
        view(device, Device).added[:] = 0.0
    elif device != 0:
        _tell(call(view(device, Device).compute, (model, data, device)), context)


BOUND = (init, destroy, copy, compute, actuator_act_dot)
"""Those that get a context, by the names that MuJoCo has for them."""

"""The C functions of an engine plugin."""

from typing import NamedTuple

import numpy as np
from numba import int32, int64, void

from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.entries.passive import act_or_fail
from buoyancy_mj.kernels.entries.pointers import call, set_word, word
from buoyancy_mj.kernels.entries.tables import WaterTable
from buoyancy_mj.kernels.entries.views import WORDS, slot, view, view_engine
from buoyancy_mj.kernels.multibody import Identity, sum_sizes
from buoyancy_mj.kernels.passes import ALIVE, AUGMENTED, DATA, MODEL, SIZES, WATER, Record

_IDS = WORDS * slot(Record, "ids")


class Context(NamedTuple):
    """What a plugin is given."""

    plugin_data: int
    """Byte offset of mjData.plugin_data."""
    resolve: int
    """A C function that finds the water of a model."""
    error: int
    """MuJoCo's mju_error."""


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _slot(data, instance, context):
    """Address of the word that the engine keeps for an instance: the address of a record, or 0."""
    return word(data + view(context, Context).plugin_data) + 8 * instance


@njit(cache=True, error_model="numpy", _nrt=False)
def _resolve(model, data, instance, context):
    """Let Python find the water of a model and put a record of it into the data.

    An error goes to the engine.
    """
    links = view(context, Context)
    text = call(links.resolve, (model, data, instance))
    if text != 0:
        call(links.error, (text,))


def nstate(model: int64, instance: int32) -> int32:
    """The engine asks how many numbers of an instance are part of a state: none."""
    return 0


def reset(model: int64, state: int64, record: int64, instance: int32) -> void:
    """The engine resets a data: no loads are of it any more."""
    if record != 0:
        view(record, Record).ids[DATA] = 0


def init(model: int64, data: int64, instance: int32, context: int64) -> int32:
    """The engine has made a data."""
    set_word(_slot(data, instance, context), 0)
    _resolve(model, data, np.int64(instance), context)
    return 0


def destroy(data: int64, instance: int32, context: int64) -> void:
    """The engine frees a data: its record may serve another."""
    record = word(_slot(data, instance, context))
    if record != 0:
        view(record, Record).ids[ALIVE] = 0


def copy(target: int64, model: int64, source: int64, instance: int32, context: int64) -> void:
    """The engine copies a data: the record's contents go along, if both are of one water."""
    one, other = word(_slot(target, instance, context)), word(_slot(source, instance, context))
    if one == 0 or other == 0:
        return
    ids, others = view(one, Record).ids, view(other, Record).ids
    if ids[WATER] != others[WATER]:
        return
    # arrays of one water's records are of one size, and all are of 64-bit words
    for n in range(0, _IDS, WORDS):
        into, source_words = word(one + 8 * n), word(other + 8 * n)
        for i in range(word(one + 8 * n + 8) * word(one + 8 * n + 16)):
            set_word(into + 8 * i, word(source_words + 8 * i))
    ids[AUGMENTED] = others[AUGMENTED]
    ids[DATA] = target if others[DATA] == source else 0


def compute(model: int64, data: int64, instance: int32, capability: int32, context: int64) -> void:
    """The engine wants the passive forces of an instance."""
    record = word(_slot(data, instance, context))
    # stepped with another model than before, or with other geoms in it
    if record == 0 or _is_of_another(model, data, record):
        _resolve(model, data, np.int64(instance), context)
        record = word(_slot(data, instance, context))
        if record == 0:
            # Python is just reading the model
            return
        view(record, Record).ids[SIZES] = _sum_sizes(model, data, record)
    act_or_fail(model, data, view(record, Record).ids[WATER], record)


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _is_of_another(model, data, record):
    """Whether a record is of another model, or of other sizes of its geoms."""
    ids = view(record, Record).ids
    return ids[MODEL] != model or ids[SIZES] != _sum_sizes(model, data, record)


@inner
def _sum_sizes(model, data, record):
    """The sum by which other sizes of a model's geoms are noticed."""
    offsets = view(view(record, Record).ids[WATER], WaterTable).offsets
    return sum_sizes(view_engine(model, data, offsets, Identity).geom_size)


HOOKS = (nstate, reset, init, destroy, copy, compute)
"""The C functions, by the names that MuJoCo has for them."""

"""What an engine plugin is made of: C functions that the engine calls, each with its own small part of the work."""

import numpy as np
from numba import carray, njit

from buoyancy_mj.kernels.entries.passive import Context, Id, Offset, Record, Water, act_or_fail
from buoyancy_mj.kernels.entries.pointers import call, grid, pointer, word, words


@njit(cache=True, error_model="numpy", inline="always")
def _slot(data, instance, context):
    """Address of the word that the engine keeps for an instance in its data."""
    return word(data + word(context + 8 * Context.plugin_data)) + 8 * instance


@njit(cache=True, error_model="numpy")
def _resolved(model, data, instance, context):
    """Let Python find the water of a model and put a record of it into the data; tells the engine what fails."""
    text = call(word(context + 8 * Context.resolve), model, data, instance, 0)
    if text != 0:
        call(word(context + 8 * Context.error), text, 0, 0, 0)


def nstate(model, instance):
    """The engine asks how many numbers of an instance are part of a state: none."""
    return 0


def reset(model, state, record, instance):
    """The engine resets a data: no loads are of it any more."""
    if record != 0:
        words(record, Record.ids)[Id.data] = 0


def init(model, data, instance, context):
    """The engine has made a data."""
    carray(pointer(_slot(data, instance, context)), (1,), np.int64)[0] = 0
    _resolved(model, data, np.int64(instance), context)
    return 0


def destroy(data, instance, context):
    """The engine frees a data: its record may serve another."""
    record = word(_slot(data, instance, context))
    if record != 0:
        words(record, Record.ids)[Id.alive] = 0


def copy(target, model, source, instance, context):
    """The engine copies a data: the record's contents go along, if both are of one water."""
    one, other = word(_slot(target, instance, context)), word(_slot(source, instance, context))
    if (
        one == 0
        or other == 0
        or words(one, Record.ids)[Id.water] != words(other, Record.ids)[Id.water]
    ):
        return
    for k in range(Record.ids):
        grid(one, k)[:, :] = grid(other, k)
    words(one, Record.ids)[Id.heavier] = words(other, Record.ids)[Id.heavier]
    words(one, Record.ids)[Id.data] = target if words(other, Record.ids)[Id.data] == source else 0


def compute(model, data, instance, capability, context):
    """The engine wants the passive forces of an instance."""
    record = word(_slot(data, instance, context))
    # stepped with another model than before, or with other geoms in it
    if (
        record == 0
        or words(record, Record.ids)[Id.model] != model
        or words(record, Record.ids)[Id.sizes] != _sizes(model, record)
    ):
        _resolved(model, data, np.int64(instance), context)
        record = word(_slot(data, instance, context))
        if record == 0:
            # Python is just reading the model
            return
        words(record, Record.ids)[Id.sizes] = _sizes(model, record)
    act_or_fail(model, data, words(record, Record.ids)[Id.water], record)


@njit(cache=True, error_model="numpy")
def _sizes(model, record):
    """A sum over the bits of the sizes of all geoms, which another size changes."""
    offsets = words(words(record, Record.ids)[Id.water], Water.offsets)
    count = 3 * word(model + offsets[Offset.ngeom])
    bits = carray(pointer(word(model + offsets[Offset.geom_size])), (count,), np.int64)
    total = np.int64(0)
    for i in range(count):
        total = 31 * total + bits[i]
    return total

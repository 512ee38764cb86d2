"""The water as an engine written in C calls it: by the addresses of mjModel and mjData.

What is known of the water, where it works and what a callback is told stand in `entries.tables`.
"""

import math

from numba import int64, void

from buoyancy_mj.kernels import delivery, passes
from buoyancy_mj.kernels.compiling import inner, njit
from buoyancy_mj.kernels.entries.crews import share, take_workplace
from buoyancy_mj.kernels.entries.pointers import call, exchange, set_word, word
from buoyancy_mj.kernels.entries.tables import Lease, WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, Identity, downward_gravity, sum_sizes
from buoyancy_mj.kernels.passes import AUGMENTED, DATA, MODEL, Record


@njit(cache=True, error_model="numpy", _nrt=False)
def _evaluate(model, data, water, place, record):
    """Run one pass: fill a record, and add its loads to the engine's forces and mass matrix.

    Returns 0, or the address of a text that tells why it cannot.
    """
    table, results = view(water, WaterTable), view(record, Record)
    loads, links, acting, items = table.loads, table.links, table.acting, table.items
    engine = view_engine(model, data, table.offsets, Engine)
    if math.isnan(downward_gravity(engine.option.gravity, engine.option.disableflags)):
        return links.gravity_text

    # what is wet, and what the water does to it
    words = model, data, record, water, place
    text = share(links.submerge, words, table.hulls, links)
    if text != 0:
        return text
    passes.begin(loads, results)
    for n in range(acting.shape[0]):
        share(acting[n], words, items[n], links)
    passes.end(engine, results)

    # to the forces, and to the mass matrix
    delivery.deliver(loads, engine, results)
    done = delivery.UNCHANGED
    if links.augment != 0:
        done = call(links.augment, words)
    if done != delivery.UNCHANGED:
        call(links.factor, (model, data))
    if done == delivery.AUGMENT_DUAL:
        call(links.project, (model, data))
    results.ids[MODEL], results.ids[DATA] = model, data
    return 0


@inner
def _take_record(water, data):
    """Index of the record of some data, or of the oldest that no other thread fills."""
    table = view(water, WaterTable)
    datas, busy = table.datas, table.busy
    for i in range(datas.shape[0]):
        if datas[i] == data and exchange(busy[i], 1) == 0:
            datas[i] = data
            return i
    i = word(table.turn)
    while exchange(busy[i], 1) != 0:
        i = (i + 1) % datas.shape[0]
    set_word(table.turn, (i + 1) % datas.shape[0])
    datas[i] = data
    ids = view(table.records[i], Record).ids
    ids[DATA] = ids[AUGMENTED] = 0
    return i


def act(model: int64, data: int64, water: int64, record: int64) -> int64:
    """Act on data at a free workplace, and leave the loads in a record.

    A record of 0 stands for one of those that the water keeps for the last data. Returns 0, or the
    address of a text that tells what failed.
    """
    place = take_workplace(water)
    if record != 0:
        text = _evaluate(model, data, water, place, record)
    else:
        table = view(water, WaterTable)
        i = _take_record(water, data)
        text = _evaluate(model, data, water, place, table.records[i])
        exchange(table.busy[i], 0)
    exchange(view(place, Workplace).taken, 0)
    return text


# what the engine calls: small, so that it is ready without compiling what is above


@inner
def act_or_fail(model, data, water, record):
    """Act, and tell the engine what fails."""
    links = view(water, WaterTable).links
    text = call(links.act, (model, data, water, record))
    if text != 0:
        call(links.error, (text,))


def callback(model: int64, data: int64, lease: int64) -> void:
    """A callback of the engine: the previous callback, then the water on its own model."""
    told = view(lease, Lease)
    if told.previous != 0:
        call(told.previous, (model, data))
    if told.water == 0:
        return

    # its own model, or a copy
    water = word(told.water)
    table = view(water, WaterTable)
    links = table.links
    if model != links.model and told.copies == 0:
        return
    identity = view_engine(model, data, table.offsets, Identity)
    if model != links.model and identity.signature != links.signature:
        return

    # geoms that were resized
    if sum_sizes(identity.geom_size) != links.sizes:
        text = call(links.measure, (0,)) if model == links.model else links.sizes_text
        if text != 0:
            call(links.error, (text,))
        water = word(told.water)
    act_or_fail(model, data, water, 0)

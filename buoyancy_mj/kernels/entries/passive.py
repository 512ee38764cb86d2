"""The water as an engine written in C calls it: by the addresses of mjModel and mjData.

What is known of the water, what a pass leaves and where it works stand in tables, see
`entries.views`: those of `WaterTable`, `passes.Record` and `Workplace`; what a callback is told,
in that of `Lease`.
"""

import math
from typing import Annotated, NamedTuple

from numba import int64, njit, void

from buoyancy_mj.kernels import clip, passes
from buoyancy_mj.kernels.arrays import Words
from buoyancy_mj.kernels.entries.pointers import call, exchange, set_word, word
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, Identity, Option, downward_gravity, sum_sizes
from buoyancy_mj.kernels.passes import AUGMENTED, DATA, MODEL, LoadArrays, Record
from buoyancy_mj.kernels.scratch import Scratch


class Links(NamedTuple):
    """C functions and other addresses; 0 for none."""

    model: int
    """The water's own mjModel."""
    signature: int
    """MuJoCo's compilation signature of that model."""
    sizes: int
    """The `sum_sizes` of its geoms, when the hulls were measured."""
    measure: int
    """A function that measures the hulls anew."""
    sizes_text: int
    """What the engine is told when a copy of the model has geoms of other sizes."""
    act: int
    """The C function `act`."""
    submerge: int
    """A function that submerges the hulls in place of `clip.submerge_hulls`, of water, mjData and
    record."""
    error: int
    """MuJoCo's mju_error."""
    gravity_text: int
    """What it is told when gravity is not along -z."""
    factor: int
    """MuJoCo's mj_factorM."""
    project: int
    """MuJoCo's mj_projectConstraint."""


class WaterTable(NamedTuple):
    """All that compiled code knows of a water."""

    loads: LoadArrays
    links: Links
    offsets: int
    """Address of the byte offsets of `multibody.PATHS`."""
    pool: Annotated[Words, ("p",)]
    """Addresses of a `Workplace` for each of several threads."""
    records: Annotated[Words, ("p",)]
    """Addresses of a record for each of the data that a callback acted on last."""
    datas: Annotated[Words, ("p",)]
    """Addresses of those data; 0 for none."""
    busy: Annotated[Words, ("p",)]
    """Addresses of words that are 1 while a thread fills the record."""
    turn: int
    """Address of the index of the record that the next data get."""


class Workplace(NamedTuple):
    """Where one thread works."""

    scratch: Scratch
    taken: int
    """Address of a word that is 1 while a thread works here."""


class Lease(NamedTuple):
    """What a callback of the engine is told, and told anew while it stays where it is."""

    previous: int
    """The callback that is called first; 0 for none."""
    water: int
    """Address of the word that holds the address of a `WaterTable`; 0 where no water is lent any
    more."""
    copies: int
    """1 to act on all models of the same compilation signature."""


@njit(cache=True, error_model="numpy")
def _evaluate(model, data, water, place, record):
    """Run one pass: fill a record, and add its loads to the engine's forces and mass matrix.

    Returns 0, or the address of a text that tells why it cannot.
    """
    option = view_engine(model, data, view(water, WaterTable).offsets, Option)
    gravity = downward_gravity(option.gravity, option.disableflags)
    if math.isnan(gravity):
        return view(water, WaterTable).links.gravity_text
    text = _submerge(model, data, water, place, record)
    if text != 0:
        return text

    # what the water does, to the forces and to the mass matrix
    table, results = view(water, WaterTable), view(record, Record)
    loads, links = table.loads, table.links
    engine = view_engine(model, data, table.offsets, Engine)
    passes.add_up(loads, engine, gravity, view(place, Workplace).scratch, results)
    done = passes.apply(loads, engine, results)
    if done != passes.UNCHANGED:
        call(links.factor, model, data, 0, 0)
    if done == passes.AUGMENT_DUAL:
        call(links.project, model, data, 0, 0)
    results.ids[MODEL], results.ids[DATA] = model, data
    return 0


@njit(cache=True, error_model="numpy")
def _submerge(model, data, water, place, record):
    """Find what is under water; returns 0, or the address of a text that tells why it cannot."""
    table, results = view(water, WaterTable), view(record, Record)
    if table.links.submerge != 0:
        return call(table.links.submerge, water, data, record, 0)
    engine = view_engine(model, data, table.offsets, Engine)
    scratch, loads = view(place, Workplace).scratch.cut, table.loads
    level, waves = loads.sea.level, loads.sea.waves
    clip.submerge_hulls(loads.hulls, engine.geoms, level, waves, engine.time, scratch, results.wet)
    return 0


@njit(cache=True, error_model="numpy")
def _take_workplace(water):
    """Address of a workplace that no other thread works at, from the pool of the water."""
    pool = view(water, WaterTable).pool
    i = 0
    while exchange(view(pool[i], Workplace).taken, 1) != 0:
        i = (i + 1) % pool.shape[0]
    return pool[i]


@njit(cache=True, error_model="numpy")
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
    place = _take_workplace(water)
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


@njit(cache=True, error_model="numpy")
def act_or_fail(model, data, water, record):
    """Act, and tell the engine what fails."""
    links = view(water, WaterTable).links
    text = call(links.act, model, data, water, record)
    if text != 0:
        call(links.error, text, 0, 0, 0)


def callback(model: int64, data: int64, lease: int64) -> void:
    """A callback of the engine: the previous callback, then the water on its own model."""
    told = view(lease, Lease)
    if told.previous != 0:
        call(told.previous, model, data, 0, 0)
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
        text = call(links.measure, 0, 0, 0, 0) if model == links.model else links.sizes_text
        if text != 0:
            call(links.error, text, 0, 0, 0)
        water = word(told.water)
    act_or_fail(model, data, water, 0)

"""The water as an engine written in C calls it: by the addresses of mjModel and mjData.

What is known of the water, what a pass leaves and where it works stand in tables, see
`entries.views`: those of `WaterTable`, `passes.Record` and `Workplace`.
"""

import math
from typing import Annotated, NamedTuple

from numba import int64, njit, void

from buoyancy_mj.kernels import clip, passes
from buoyancy_mj.kernels.arrays import Words
from buoyancy_mj.kernels.entries.pointers import call, exchange
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, Identity, Option, downward_gravity
from buoyancy_mj.kernels.passes import DATA, MODEL, LoadArrays, Record
from buoyancy_mj.kernels.scratch import Scratch


class Links(NamedTuple):
    """C functions and other addresses; 0 for none."""

    model: int
    """The water's own mjModel."""
    signature: int
    """MuJoCo's compilation signature of that model."""
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


class Workplace(NamedTuple):
    """Where one thread works."""

    scratch: Scratch
    taken: int
    """Address of a word that is 1 while a thread works here."""
    record: int
    """Address of a record that goes with it."""


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


def act(model: int64, data: int64, water: int64, record: int64) -> int64:
    """Act on data at a free workplace, and leave the loads in a record.

    A record of 0 stands for the one of the workplace. Returns 0, or the address of a text that
    tells what failed.
    """
    place = _take_workplace(water)
    room = view(place, Workplace)
    text = _evaluate(model, data, water, place, record if record != 0 else room.record)
    exchange(room.taken, 0)
    return text


# what the engine calls: small, so that it is ready without compiling what is above


@njit(cache=True, error_model="numpy")
def act_or_fail(model, data, water, record):
    """Act, and tell the engine what fails."""
    links = view(water, WaterTable).links
    text = call(links.act, model, data, water, record)
    if text != 0:
        call(links.error, text, 0, 0, 0)


def callback(model: int64, data: int64, water: int64, previous: int64, copies: int64) -> void:
    """A callback of the engine: the previous callback, then the water on its own model.

    With `copies` the water acts on all models of the same compilation signature too.
    """
    if previous != 0:
        call(previous, model, data, 0, 0)
    table = view(water, WaterTable)
    own = model == table.links.model
    if not own and copies != 0:
        identity = view_engine(model, data, table.offsets, Identity)
        own = identity.signature == table.links.signature
    if own:
        act_or_fail(model, data, water, 0)

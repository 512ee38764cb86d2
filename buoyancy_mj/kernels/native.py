"""The water as an engine written in C calls it: addresses in, generalized forces added where those point.

What is known of the water, what an evaluation leaves and where it works stand in tables of 64-bit
words: `WATER`, `RECORD`, `SCRATCH`. An array takes three words, its address, rows and columns.
Where the engine keeps its own numbers says a table of byte offsets, `OFFSETS`.
"""

from enum import IntEnum

import numpy as np
from numba import carray, njit

from buoyancy_mj.kernels import clip, pressure, wrenches
from buoyancy_mj.kernels.memory import (
    call,
    corners,
    doubles,
    give,
    grid,
    int32s,
    number,
    pointer,
    row,
    spans,
    take,
    word,
    words,
)

Water = IntEnum(
    "Water",
    "vertices faces areas nodes spans boxes moments whole frames waves "
    "owners bodies damped volumes linear quadratic members member_starts sea current offsets pool links",
    start=0,
)
"""Arrays of a water; 'sea' is density, level and `Pressure`, 'owners' the body of each hull, 'damped' those with drag."""
Pressure = IntEnum("Pressure", "archimedes hydrostatic froude_krylov", start=0)
"""What the water's pressure in waves is taken for."""
Link = IntEnum("Link", "model signature act submerge error gravity_text", start=0)
"""Words of 'links': the own model and its signature; C functions, 0 for none; a text for the engine's error function."""
Record = IntEnum("Record", "results centres heads buoyancy wave_pressure drag total instant ids", start=0)
"""Arrays of what an evaluation leaves."""
Id = IntEnum("Id", "alive model data water sizes", start=0)
"""Words of 'ids': whether it is in use; addresses of what it is of; and a sum over the sizes of the model's geoms."""
Scratch = IntEnum("Scratch", "depths swell state", start=0)
"""Arrays to work in."""
State = IntEnum("State", "taken record", start=0)
"""Words of 'state': whether they are taken, and the address of a record that goes with them."""
Context = IntEnum("Context", "plugin_data resolve error", start=0)
"""Words that a plugin is given: the offset of that field, and C functions."""
Offset = IntEnum(
    "Offset",
    "timestep gravity disableflags nbody ngeom nv signature body_parentid body_rootid body_dofnum body_dofadr body_mass "
    "body_inertia dof_parentid geom_size time geom_xpos geom_xmat xipos ximat xmat subtree_com cvel cdof qfrc_passive",
    start=0,
)
"""What is read of the engine's options, model and data; the last is written."""
OFFSETS = tuple(
    f"mjModel.opt.{entry.name}" if entry < Offset.nbody else f"{'mjModel' if entry < Offset.time else 'mjData'}.{entry.name}"
    for entry in Offset
)
"""Where each is."""
NO_GRAVITY = 1 << 7
"""MuJoCo's mjDSBL_GRAVITY; see `native`, which checks it."""


# what acts


@njit(cache=True)
def _evaluate(model, data, water, scratch, record):
    """Evaluate the loads, leave them in the record, add them to the engine's passive forces.

    Gives 0; or the address of a text that tells why it cannot.
    """
    offsets, links = words(water, Water.offsets), words(water, Water.links)
    nbody, ngeom, nv = (
        word(model + offsets[Offset.nbody]),
        word(model + offsets[Offset.ngeom]),
        word(model + offsets[Offset.nv]),
    )
    flags = carray(pointer(model + offsets[Offset.disableflags]), (1,), np.int32)[0]
    gravity = carray(pointer(model + offsets[Offset.gravity]), (3,), np.float64)
    strength = 0.0
    if not flags & NO_GRAVITY:
        if gravity[0] != 0.0 or gravity[1] != 0.0 or gravity[2] > 0.0:
            return links[Link.gravity_text]
        strength = -gravity[2]
    time = number(data + offsets[Offset.time])
    xipos = doubles(word(data + offsets[Offset.xipos]), nbody, 3)
    subtree_com = doubles(word(data + offsets[Offset.subtree_com]), nbody, 3)
    roots = int32s(word(model + offsets[Offset.body_rootid]), nbody)
    waves, sea, owners = grid(water, Water.waves), row(water, Water.sea), words(water, Water.owners)
    wet, centres, total = grid(record, Record.results), grid(record, Record.centres), grid(record, Record.total)
    # what is under water
    if links[Link.submerge] != 0:
        text = call(links[Link.submerge], water, data, record, 0)
        if text != 0:
            return text
    else:
        clip.submerge_hulls(
            grid(water, Water.vertices),
            corners(water, Water.faces),
            grid(water, Water.areas),
            words(water, Water.nodes),
            spans(water, Water.spans),
            grid(water, Water.boxes),
            grid(water, Water.moments),
            grid(water, Water.whole),
            words(water, Water.frames),
            doubles(word(data + offsets[Offset.geom_xpos]), ngeom, 3),
            doubles(word(data + offsets[Offset.geom_xmat]), ngeom, 9),
            sea[1],
            waves,
            time,
            row(scratch, Scratch.depths),
            grid(scratch, Scratch.swell),
            wet,
        )
    wrenches.merge(wet, owners, centres)
    # the loads by cause, and their sum
    buoyancy = grid(record, Record.buoyancy)
    buoyancy[:, :] = 0.0
    wrenches.add_buoyancy(wet, owners, sea[0] * strength, xipos, buoyancy)
    total[:, :] = buoyancy
    kind = int(sea[2])
    if kind != Pressure.archimedes and waves.shape[0] > 0:
        heads, pushed = grid(record, Record.heads), grid(record, Record.wave_pressure)
        geom_xpos = doubles(word(data + offsets[Offset.geom_xpos]), ngeom, 3)
        pressure.press_hulls(
            grid(water, Water.vertices),
            corners(water, Water.faces),
            grid(water, Water.areas),
            words(water, Water.nodes),
            spans(water, Water.spans),
            grid(water, Water.boxes),
            grid(water, Water.moments),
            grid(water, Water.whole),
            words(water, Water.frames),
            geom_xpos,
            doubles(word(data + offsets[Offset.geom_xmat]), ngeom, 9),
            sea[1],
            waves,
            time,
            kind == Pressure.froude_krylov,
            row(scratch, Scratch.depths),
            heads,
        )
        pushed[:, :] = 0.0
        wrenches.add_wave_pressure(
            heads, wet, owners, words(water, Water.frames), geom_xpos, sea[0] * strength, xipos, pushed
        )
        for b in range(nbody):
            for i in range(6):
                total[b, i] += pushed[b, i]
    damped = words(water, Water.damped)
    if damped.shape[0] > 0:
        drag = grid(record, Record.drag)
        drag[:, :] = 0.0
        wrenches.add_drag(
            centres,
            damped,
            row(water, Water.volumes),
            grid(water, Water.linear),
            grid(water, Water.quadratic),
            words(water, Water.members),
            words(water, Water.member_starts),
            carray(pointer(word(model + offsets[Offset.body_mass])), (nbody,), np.float64),
            doubles(word(model + offsets[Offset.body_inertia]), nbody, 3),
            xipos,
            doubles(word(data + offsets[Offset.ximat]), nbody, 9),
            doubles(word(data + offsets[Offset.xmat]), nbody, 9),
            doubles(word(data + offsets[Offset.cvel]), nbody, 6),
            subtree_com,
            roots,
            sea[1],
            waves,
            row(water, Water.current),
            time,
            number(model + offsets[Offset.timestep]),
            drag,
        )
        for b in range(nbody):
            for i in range(6):
                total[b, i] += drag[b, i]
    wrenches.project(
        total,
        words(water, Water.bodies),
        xipos,
        subtree_com,
        roots,
        int32s(word(model + offsets[Offset.body_parentid]), nbody),
        int32s(word(model + offsets[Offset.body_dofnum]), nbody),
        int32s(word(model + offsets[Offset.body_dofadr]), nbody),
        int32s(word(model + offsets[Offset.dof_parentid]), nv),
        doubles(word(data + offsets[Offset.cdof]), nv, 6),
        carray(pointer(word(data + offsets[Offset.qfrc_passive])), (nv,), np.float64),
    )
    ids = words(record, Record.ids)
    ids[Id.model], ids[Id.data] = model, data
    row(record, Record.instant)[0] = time
    return 0


@njit(cache=True)
def _free_scratch(water):
    """Scratch that no other thread works in, from the pool of the water."""
    pool = words(water, Water.pool)
    i = 0
    while take(word(pool[i] + 24 * Scratch.state)) != 0:
        i = (i + 1) % pool.shape[0]
    return pool[i]


def act(model, data, water, record):
    """Act on data with scratch of the pool, and its own record if none is given; gives 0, or the address of a text."""
    scratch = _free_scratch(water)
    state = word(scratch + 24 * Scratch.state)
    text = _evaluate(model, data, water, scratch, record if record != 0 else word(state + 8 * State.record))
    give(state)
    return text


# what the engine calls: small, so that it is ready without compiling what is above


@njit(cache=True)
def _act_or_fail(model, data, water, record):
    """Act, and tell the engine what fails."""
    links = words(water, Water.links)
    text = call(links[Link.act], model, data, water, record)
    if text != 0:
        call(links[Link.error], text, 0, 0, 0)


def callback(model, data, water, previous, copies):
    """A callback of the engine: first the one that was there before, then the water, if the model is its own.

    With `copies` the water acts on all models of the own one's signature too.
    """
    if previous != 0:
        call(previous, model, data, 0, 0)
    links = words(water, Water.links)
    own = model == links[Link.model]
    if not own and copies != 0:
        own = word(model + words(water, Water.offsets)[Offset.signature]) == links[Link.signature]
    if own:
        _act_or_fail(model, data, water, 0)


# what an engine plugin is made of


@njit(cache=True, inline="always")
def _slot(data, instance, context):
    """Address of the word that the engine keeps for an instance in its data."""
    return word(data + word(context + 8 * Context.plugin_data)) + 8 * instance


@njit(cache=True)
def _resolved(model, data, instance, context):
    """Let Python find the water of a model and put a record of it into the data; tells the engine what fails."""
    text = call(word(context + 8 * Context.resolve), model, data, instance, 0)
    if text != 0:
        call(word(context + 8 * Context.error), text, 0, 0, 0)


def plugin_nstate(model, instance):
    """The engine asks how many numbers of an instance are part of a state: none."""
    return 0


def plugin_reset(model, state, record, instance):
    """The engine resets a data: no loads are of it any more."""
    if record != 0:
        words(record, Record.ids)[Id.data] = 0


def plugin_init(model, data, instance, context):
    """The engine has made a data."""
    carray(pointer(_slot(data, instance, context)), (1,), np.int64)[0] = 0
    _resolved(model, data, np.int64(instance), context)
    return 0


def plugin_destroy(data, instance, context):
    """The engine frees a data: its record may serve another."""
    record = word(_slot(data, instance, context))
    if record != 0:
        words(record, Record.ids)[Id.alive] = 0


def plugin_copy(target, model, source, instance, context):
    """The engine copies a data: the record's contents go along, if both are of one water."""
    one, other = word(_slot(target, instance, context)), word(_slot(source, instance, context))
    if one == 0 or other == 0 or words(one, Record.ids)[Id.water] != words(other, Record.ids)[Id.water]:
        return
    for k in range(Record.ids):
        grid(one, k)[:, :] = grid(other, k)
    words(one, Record.ids)[Id.data] = target if words(other, Record.ids)[Id.data] == source else 0


def plugin_compute(model, data, instance, capability, context):
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
    _act_or_fail(model, data, words(record, Record.ids)[Id.water], record)


@njit(cache=True)
def _sizes(model, record):
    """A sum over the bits of the sizes of all geoms, which another size changes."""
    offsets = words(words(record, Record.ids)[Id.water], Water.offsets)
    count = 3 * word(model + offsets[Offset.ngeom])
    bits = carray(pointer(word(model + offsets[Offset.geom_size])), (count,), np.int64)
    total = np.int64(0)
    for i in range(count):
        total = 31 * total + bits[i]
    return total

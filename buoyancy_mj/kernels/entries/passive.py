"""The water as an engine written in C calls it: addresses in, generalized forces added where those point.

What is known of the water, what an evaluation leaves and where it works stand in tables of 64-bit
words: `WATER`, `RECORD`, `SCRATCH`. An array takes three words, its address, rows and columns.
Where the engine keeps its own numbers says a table of byte offsets, `OFFSETS`.
"""

from enum import IntEnum

import numpy as np
from numba import carray, njit

from buoyancy_mj.kernels import clip, damping, inertia, panels, pressure, wrenches
from buoyancy_mj.kernels.entries.pointers import (
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
    "vertices faces areas nodes spans boxes moments whole typical frames waves owners bodies "
    "damped volumes linear quadratic coupled matrices radiation panels "
    "members member_starts massive massive_volumes added sea current offsets pool links",
    start=0,
)
"""Arrays of a water; 'sea' is density, level and `Pressure`, 'owners' the body of each hull, 'damped' those with drag."""
Pressure = IntEnum("Pressure", "archimedes hydrostatic froude_krylov", start=0)
"""What the water's pressure in waves is taken for."""
Link = IntEnum("Link", "model signature act submerge error gravity_text factor project", start=0)
"""Words of 'links': the own model and its signature; C functions, 0 for none; a text for the engine's error function."""
Record = IntEnum(
    "Record",
    "results centres heads buoyancy wave_pressure drag radiation added_mass total inertia instant ids",
    start=0,
)
"""Arrays of what an evaluation leaves."""
Id = IntEnum("Id", "alive model data water sizes heavier", start=0)
"""Words of 'ids': whether it is in use; addresses of what it is of; a sum over the sizes of the model's geoms; and
whether 'inertia' is a mass matrix with added mass in it."""
Scratch = IntEnum("Scratch", "depths swell state", start=0)
"""Arrays to work in."""
State = IntEnum("State", "taken record", start=0)
"""Words of 'state': whether they are taken, and the address of a record that goes with them."""
Context = IntEnum("Context", "plugin_data resolve error", start=0)
"""Words that a plugin is given: the offset of that field, and C functions."""
Offset = IntEnum(
    "Offset",
    "timestep gravity disableflags solver noslip_iterations nbody ngeom nv nC signature body_parentid body_rootid "
    "body_dofnum body_dofadr body_mass body_inertia dof_parentid M_rownnz M_rowadr M_colind geom_size time qvel geom_xpos "
    "geom_xmat xpos xipos ximat xmat subtree_com cvel cdof cdof_dot M qfrc_passive",
    start=0,
)
"""What is read of the engine's options, model and data; the last two are written."""
OFFSETS = tuple(
    f"mjModel.opt.{entry.name}"
    if entry < Offset.nbody
    else f"{'mjModel' if entry < Offset.time else 'mjData'}.{entry.name}"
    for entry in Offset
)
"""Where each is."""
NO_GRAVITY, PGS = 1 << 7, 0
"""MuJoCo's mjDSBL_GRAVITY and mjSOL_PGS; see `native`, which checks them."""


# what acts


@njit(cache=True, error_model="numpy")
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
    wet, centres, total = (
        grid(record, Record.results),
        grid(record, Record.centres),
        grid(record, Record.total),
    )
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
            grid(scratch, Scratch.depths),
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
            row(water, Water.typical),
            words(water, Water.frames),
            geom_xpos,
            doubles(word(data + offsets[Offset.geom_xmat]), ngeom, 9),
            sea[1],
            waves,
            time,
            kind == Pressure.froude_krylov,
            grid(scratch, Scratch.depths)[0],
            heads,
        )
        pushed[:, :] = 0.0
        wrenches.add_wave_pressure(
            heads,
            wet,
            owners,
            words(water, Water.frames),
            geom_xpos,
            sea[0] * strength,
            xipos,
            pushed,
        )
        _add_to(total, pushed)
    if words(water, Water.damped).shape[0] > 0:
        _slow_down(model, data, water, record, time, xipos, subtree_com, roots)
    if words(water, Water.massive).shape[0] > 0:
        _add_mass(model, data, water, record, time)
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


@njit(cache=True, error_model="numpy")
def _slow_down(model, data, water, record, time, xipos, subtree_com, roots):
    """Add drag and the damping by waves made."""
    offsets, sea = words(water, Water.offsets), row(water, Water.sea)
    nbody, ngeom = word(model + offsets[Offset.nbody]), word(model + offsets[Offset.ngeom])
    wet, centres, total = (
        grid(record, Record.results),
        grid(record, Record.centres),
        grid(record, Record.total),
    )
    owners = words(water, Water.owners)
    moving = damping.Moving(
        words(water, Water.damped),
        words(water, Water.members),
        words(water, Water.member_starts),
        carray(pointer(word(model + offsets[Offset.body_mass])), (nbody,), np.float64),
        doubles(word(model + offsets[Offset.body_inertia]), nbody, 3),
        doubles(word(data + offsets[Offset.xpos]), nbody, 3),
        xipos,
        doubles(word(data + offsets[Offset.ximat]), nbody, 9),
        doubles(word(data + offsets[Offset.xmat]), nbody, 9),
        doubles(word(data + offsets[Offset.cvel]), nbody, 6),
        subtree_com,
        roots,
        sea[1],
        grid(water, Water.waves),
        grid(water, Water.current),
        time,
        number(model + offsets[Offset.timestep]),
    )
    drag = grid(record, Record.drag)
    drag[:, :] = 0.0
    damping.add_drag(
        moving,
        centres,
        row(water, Water.volumes),
        grid(water, Water.linear),
        grid(water, Water.quadratic),
        words(water, Water.coupled),
        grid(water, Water.matrices),
        drag,
    )
    sheets = grid(water, Water.panels)
    if sheets.shape[0] > 0:
        panels.add_panels(
            moving,
            grid(water, Water.vertices),
            corners(water, Water.faces),
            grid(water, Water.areas),
            words(water, Water.nodes),
            spans(water, Water.spans),
            grid(water, Water.whole),
            words(water, Water.frames),
            doubles(word(data + offsets[Offset.geom_xpos]), ngeom, 3),
            doubles(word(data + offsets[Offset.geom_xmat]), ngeom, 9),
            wet,
            owners,
            sheets,
            drag,
        )
    _add_to(total, drag)
    made = grid(record, Record.radiation)
    if made.shape[0] > 0:
        made[:, :] = 0.0
        damping.add_radiation(moving, wet, owners, centres, grid(water, Water.radiation), made)
        _add_to(total, made)


@njit(cache=True, error_model="numpy", inline="always")
def _add_to(total, part):
    """Add the loads of one cause."""
    for b in range(total.shape[0]):
        for i in range(6):
            total[b, i] += part[b, i]


@njit(cache=True, error_model="numpy")
def _add_mass(model, data, water, record, time):
    """Add the added mass to the engine's mass matrix, once in each pass, and the rest of its reaction to the total."""
    offsets, links = words(water, Water.offsets), words(water, Water.links)
    nbody, nv = word(model + offsets[Offset.nbody]), word(model + offsets[Offset.nv])
    centres, total = grid(record, Record.centres), grid(record, Record.total)
    massive, volumes = words(water, Water.massive), row(water, Water.massive_volumes)
    matrices, sea = grid(water, Water.added), row(water, Water.sea)
    xpos, xmat = (
        doubles(word(data + offsets[Offset.xpos]), nbody, 3),
        doubles(word(data + offsets[Offset.xmat]), nbody, 9),
    )
    subtree_com = doubles(word(data + offsets[Offset.subtree_com]), nbody, 3)
    roots = int32s(word(model + offsets[Offset.body_rootid]), nbody)
    parents = int32s(word(model + offsets[Offset.body_parentid]), nbody)
    dofnum = int32s(word(model + offsets[Offset.body_dofnum]), nbody)
    dofadr = int32s(word(model + offsets[Offset.body_dofadr]), nbody)
    dof_parents = int32s(word(model + offsets[Offset.dof_parentid]), nv)
    reaction = grid(record, Record.added_mass)
    reaction[:, :] = 0.0
    inertia.add_reaction(
        centres,
        massive,
        volumes,
        matrices,
        doubles(word(data + offsets[Offset.xipos]), nbody, 3),
        xpos,
        xmat,
        doubles(word(data + offsets[Offset.cvel]), nbody, 6),
        subtree_com,
        roots,
        parents,
        dofnum,
        dofadr,
        dof_parents,
        doubles(word(data + offsets[Offset.cdof_dot]), nv, 6),
        carray(pointer(word(data + offsets[Offset.qvel])), (nv,), np.float64),
        sea[1],
        grid(water, Water.waves),
        grid(water, Water.current),
        time,
        reaction,
    )
    _add_to(total, reaction)
    # where the engine goes over a pass again without computing its mass matrix anew, it is heavier already
    count = word(model + offsets[Offset.nC])
    mass = carray(pointer(word(data + offsets[Offset.M])), (count,), np.float64)
    left, ids = row(record, Record.inertia), words(record, Record.ids)
    if ids[Id.heavier] != 0:
        same = True
        for e in range(count):
            same = same and mass[e] == left[e]
        if same:
            return
    ids[Id.heavier] = 0
    if inertia.add_inertia(
        centres,
        massive,
        volumes,
        matrices,
        xpos,
        xmat,
        subtree_com,
        roots,
        parents,
        dofnum,
        dofadr,
        dof_parents,
        doubles(word(data + offsets[Offset.cdof]), nv, 6),
        int32s(word(model + offsets[Offset.M_rownnz]), nv),
        int32s(word(model + offsets[Offset.M_rowadr]), nv),
        int32s(word(model + offsets[Offset.M_colind]), count),
        mass,
    ):
        call(links[Link.factor], model, data, 0, 0)
        # what solvers of the dual problem have made of the mass matrix before
        solver = carray(pointer(model + offsets[Offset.solver]), (1,), np.int32)[0]
        noslip = carray(pointer(model + offsets[Offset.noslip_iterations]), (1,), np.int32)[0]
        if solver == PGS or noslip > 0:
            call(links[Link.project], model, data, 0, 0)
        ids[Id.heavier] = 1
        left[:] = mass


@njit(cache=True, error_model="numpy")
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
    text = _evaluate(
        model, data, water, scratch, record if record != 0 else word(state + 8 * State.record)
    )
    give(state)
    return text


# what the engine calls: small, so that it is ready without compiling what is above


@njit(cache=True, error_model="numpy")
def act_or_fail(model, data, water, record):
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
        act_or_fail(model, data, water, 0)

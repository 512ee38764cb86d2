"""One pass of the water over the bodies of a model, called by compiled code and by Python alike.

Each load is one function. Python calls it as it is, and compiled code by the address of its entry,
see `entries.loads`: what does not act is never compiled.

To add a load: write its kernel, declare its arrays in a NamedTuple of `LoadArrays`, name it in
`Causes`, and add a function of `PassArrays` to `LOADS`. Where it goes over hulls or bodies that
touch no rows of each other, add how many there are to `DIVIDED`, so that threads may share it.
"""

from collections.abc import Callable, Mapping
from typing import Annotated, NamedTuple

from buoyancy_mj.kernels import (
    ballast,
    damping,
    foils,
    panels,
    pressure,
    radiation,
    reaction,
    wrenches,
)
from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.ballast import Ballast
from buoyancy_mj.kernels.compiling import njit, register_jitable
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.foils import Foils
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.kernels.multibody import Engine
from buoyancy_mj.kernels.scratch import Scratch
from buoyancy_mj.kernels.sea import Sea

ALIVE, MODEL, DATA, WATER, SIZES, AUGMENTED, IDS = range(7)
"""Columns of `Record.ids`, and how many: whether the record is in use; addresses of its mjModel,
mjData and water; a sum over the sizes of the model's geoms; and whether `Record.inertia` is a mass
matrix with added mass in it."""


class LoadArrays(NamedTuple):
    """All that the water does to the bodies of one model."""

    hulls: Hulls
    owners: Annotated[Words, ("h",)]
    """Body of each hull."""
    bodies: Annotated[Words, ("b",)]
    """Bodies that have hulls, foils or ballast."""
    sea: Sea
    damping: DampingArrays
    foils: Foils
    added_mass: AddedMass
    ballast: Ballast


class Causes(NamedTuple):
    """Force [N] and torque [N m] about `xipos` on each body, world frame, by cause.

    A cause that never acts has no rows.
    """

    buoyancy: Annotated[Doubles, ("nbody", 6)]
    wave_pressure: Annotated[Doubles, ("nbody", 6)]
    drag: Annotated[Doubles, ("nbody", 6)]
    radiation: Annotated[Doubles, ("nbody", 6)]
    foil: Annotated[Doubles, ("nbody", 6)]
    added_mass: Annotated[Doubles, ("nbody", 6)]
    slamming: Annotated[Doubles, ("nbody", 6)]
    ballast: Annotated[Doubles, ("nbody", 6)]


class Record(NamedTuple):
    """What a pass leaves."""

    wet: Annotated[Doubles, ("h", 8)]
    """Submersion of each hull, and of the geoms of bladders, see `clip.submerge_hulls`."""
    centres: Annotated[Doubles, ("nbody", 4)]
    """Submerged volume of each body [m^3] and its centroid [m]."""
    heads: Annotated[Doubles, ("h", 6)]
    """Pressure on each of them, see `pressure.press_hulls`; zeros where no model of pressure asks
    for it."""
    causes: Causes
    total: Annotated[Doubles, ("nbody", 6)]
    """Sum over the causes."""
    inertia: Annotated[Doubles, ("nC",)]
    """The mass matrix with added mass and the water of tanks in it, as the last pass left it."""
    instant: Annotated[Doubles, (1,)]
    """Time of the pass [s]."""
    xipos: Annotated[Doubles, ("nbody", 3)]
    """Centres of mass of the bodies in the pass [m]."""
    ids: Annotated[Words, (IDS,)]
    """Of what the pass was, in columns `ALIVE` to `AUGMENTED`."""


class PassArrays(NamedTuple):
    """What a load reads, and the record in which it writes its cause."""

    loads: LoadArrays
    engine: Engine
    gravity: float
    """Downward acceleration [m/s^2]."""
    scratch: Scratch
    record: Record
    """`wet` and `centres` are of this pass."""
    first: int
    """First of the items to do, see `DIVIDED`."""
    last: int
    """One past the last of them."""


@njit(cache=True, error_model="numpy", inline="always")
def begin(loads, record):
    """Find the submerged volume of each body, and set all causes to zero."""
    wrenches.merge(record.wet, loads.owners, record.centres)
    for cause in record.causes:
        cause[:, :] = 0.0


@njit(cache=True, error_model="numpy", inline="always")
def end(engine, record):
    """Sum up the causes, and note of what instant they are."""
    total = record.total
    total[:, :] = 0.0
    for cause in record.causes:
        for b in range(cause.shape[0]):
            for i in range(6):
                total[b, i] += cause[b, i]
    record.instant[0] = engine.time
    xipos = engine.bodies.xipos
    for b in range(xipos.shape[0]):
        for i in range(3):
            record.xipos[b, i] = xipos[b, i]


@register_jitable()
def add_buoyancy(arrays):
    """Archimedes' force."""
    loads, record = arrays.loads, arrays.record
    wrenches.add_buoyancy(
        record.wet,
        loads.owners,
        loads.sea.density * arrays.gravity,
        arrays.engine.bodies.xipos,
        record.causes.buoyancy,
    )


@register_jitable()
def press_hulls(arrays):
    """The pressure under waves on each hull."""
    loads, engine = arrays.loads, arrays.engine
    pressure.press_hulls(
        loads.hulls,
        engine.geoms,
        loads.sea,
        engine.time,
        arrays.scratch,
        arrays.record.heads,
        arrays.first,
        arrays.last,
    )


@register_jitable()
def add_wave_pressure(arrays):
    """What the pressure under waves adds to it."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    wrenches.add_wave_pressure(
        record.heads,
        record.wet,
        loads.owners,
        loads.hulls.frames,
        engine.geoms.geom_xpos,
        loads.sea.density * arrays.gravity,
        engine.bodies.xipos,
        record.causes.wave_pressure,
    )


@register_jitable()
def add_drag(arrays):
    """Drag that is linear and quadratic in the velocity of a body."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    damping.add_drag(
        loads.damping,
        engine.bodies,
        loads.sea,
        engine.time,
        engine.option.timestep,
        engine.equalities.eq_active,
        record.centres,
        record.causes.drag,
        arrays.first,
        arrays.last,
    )


@register_jitable()
def add_panel_drag(arrays):
    """Drag of each panel of a hull."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    panels.add_panels(
        loads.damping,
        loads.hulls,
        loads.damping.owners,
        engine.bodies,
        engine.geoms,
        loads.sea,
        engine.time,
        engine.option.timestep,
        engine.equalities.eq_active,
        record.wet,
        record.causes.drag,
        arrays.first,
        arrays.last,
    )


@register_jitable()
def add_radiation(arrays):
    """Damping by the waves that a body makes."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    radiation.add_radiation(
        loads.damping,
        engine.bodies,
        loads.sea,
        engine.time,
        engine.option.timestep,
        record.wet,
        record.centres,
        record.causes.radiation,
        arrays.first,
        arrays.last,
    )


@register_jitable()
def add_foils(arrays):
    """Lift and drag of fins, rudders, keels and wings."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    foils.add_foils(
        loads.foils,
        engine.bodies,
        engine.joints,
        engine.mass_matrix,
        loads.sea,
        engine.time,
        engine.option.timestep,
        record.causes.foil,
    )


@register_jitable()
def add_reaction(arrays):
    """What added mass does beside its inertia, and what the water keeps of it in an entry."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    reaction.add_reaction(
        loads.added_mass,
        engine.bodies,
        engine.joints,
        loads.sea,
        engine.time,
        engine.option.timestep,
        record.wet,
        record.centres,
        record.causes.added_mass,
        record.causes.slamming,
        arrays.first,
        arrays.last,
    )


@register_jitable()
def add_ballast(arrays):
    """Bladders, and the water in tanks and compartments."""
    loads, engine, record = arrays.loads, arrays.engine, arrays.record
    ballast.add_ballast(
        loads.ballast,
        engine.commands,
        engine.bodies,
        engine.joints,
        engine.geoms,
        loads.sea,
        engine.time,
        engine.option.timestep,
        arrays.gravity,
        record.wet,
        record.heads,
        record.causes.ballast,
    )


LOADS = (
    add_buoyancy,
    press_hulls,
    add_wave_pressure,
    add_drag,
    add_panel_drag,
    add_radiation,
    add_foils,
    add_reaction,
    add_ballast,
)
"""All loads, in the order in which they are added."""
DIVIDED: Mapping[Callable[..., None], Callable[[LoadArrays], int]] = {
    press_hulls: lambda loads: len(loads.hulls.frames),
    add_drag: lambda loads: len(loads.damping.welded.linear) + len(loads.damping.bodies),
    add_panel_drag: lambda loads: len(loads.damping.welded.linear) + len(loads.damping.bodies),
    add_radiation: lambda loads: len(loads.damping.bodies),
    add_reaction: lambda loads: len(loads.added_mass.bodies),
}
"""Loads whose items, hulls or bodies, may be done side by side: how many there are of them. All
others are one item."""


def count_items(load: Callable[..., None], loads: LoadArrays) -> int:
    """How many items of a load may be done side by side."""
    return DIVIDED[load](loads) if load in DIVIDED else 1

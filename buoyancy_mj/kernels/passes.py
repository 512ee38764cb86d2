"""One pass of the water over the bodies of a model, called by compiled code and by Python alike.

To add a load: write its kernel, declare its arrays in a NamedTuple of `LoadArrays`, name it in
`Causes`, and call the kernel in `add_up`.
"""

from typing import Annotated, NamedTuple

import numpy as np
from numba import njit

from buoyancy_mj.kernels import damping, inertia, panels, pressure, wrenches
from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.damping import DampingArrays
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.inertia import AddedMass
from buoyancy_mj.kernels.multibody import PGS
from buoyancy_mj.kernels.sea import PressureModel, Sea

ALIVE, MODEL, DATA, WATER, SIZES, AUGMENTED, IDS = range(7)
"""Columns of `Record.ids`, and how many: whether the record is in use; addresses of its mjModel,
mjData and water; a sum over the sizes of the model's geoms; and whether `Record.inertia` is a mass
matrix with added mass in it."""
UNCHANGED, AUGMENT, AUGMENT_DUAL = range(3)
"""What `augment` did to the mass matrix: nothing; added mass, so that it must be factored anew; the
same for a solver of the dual problem, whose constraints must be projected anew too."""


class LoadArrays(NamedTuple):
    """All that the water does to the bodies of one model."""

    hulls: Hulls
    owners: Annotated[Words, ("h",)]
    """Body of each hull."""
    bodies: Annotated[Words, ("b",)]
    """Bodies that have hulls."""
    sea: Sea
    damping: DampingArrays
    added_mass: AddedMass


class Causes(NamedTuple):
    """Force [N] and torque [N m] about `xipos` on each body, world frame, by cause.

    A cause that never acts has no rows.
    """

    buoyancy: Annotated[Doubles, ("nbody", 6)]
    wave_pressure: Annotated[Doubles, ("nbody", 6)]
    drag: Annotated[Doubles, ("nbody", 6)]
    radiation: Annotated[Doubles, ("nbody", 6)]
    added_mass: Annotated[Doubles, ("nbody", 6)]


class Record(NamedTuple):
    """What a pass leaves."""

    wet: Annotated[Doubles, ("h", 6)]
    """Submersion of each hull, see `clip.submerge_hulls`."""
    centres: Annotated[Doubles, ("nbody", 4)]
    """Submerged volume of each body [m^3] and its centroid [m]."""
    heads: Annotated[Doubles, ("h", 6)]
    """Pressure on each hull, see `pressure.press_hulls`; zeros where no model of pressure asks for
    it."""
    causes: Causes
    total: Annotated[Doubles, ("nbody", 6)]
    """Sum over the causes."""
    inertia: Annotated[Doubles, ("nC",)]
    """The mass matrix with the added mass in it, as the last pass left it."""
    instant: Annotated[Doubles, (1,)]
    """Time of the pass [s]."""
    xipos: Annotated[Doubles, ("nbody", 3)]
    """Centres of mass of the bodies in the pass [m]."""
    ids: Annotated[Words, (IDS,)]
    """Of what the pass was, in columns `ALIVE` to `AUGMENTED`."""


@njit(cache=True, error_model="numpy", inline="always")
def add_up(loads, engine, gravity, scratch, record):
    """Evaluate each load, and the sum of all, from what is wet.

    Args:
        loads: `LoadArrays`, what acts.
        engine: `multibody.Engine`, how the bodies lie and move.
        gravity: downward acceleration [m/s^2].
        scratch: `scratch.Scratch`.
        record: `Record`; `wet` is read, all else up to `total` is written.
    """
    sea, bodies, time, timestep = loads.sea, engine.bodies, engine.time, engine.option.timestep
    wet, owners, centres, causes = record.wet, loads.owners, record.centres, record.causes
    specific_weight = sea.density * gravity
    wrenches.merge(wet, owners, centres)
    for cause in causes:
        cause[:, :] = 0.0

    # each load
    wrenches.add_buoyancy(wet, owners, specific_weight, bodies.xipos, causes.buoyancy)
    if sea.pressure != PressureModel.archimedes and sea.waves.shape[0] > 0:
        pressure.press_hulls(loads.hulls, engine.geoms, sea, time, scratch.pressure, record.heads)
        wrenches.add_wave_pressure(
            record.heads,
            wet,
            owners,
            loads.hulls.frames,
            engine.geoms.geom_xpos,
            specific_weight,
            bodies.xipos,
            causes.wave_pressure,
        )
    if loads.damping.bodies.shape[0] > 0:
        damping.add_drag(loads.damping, bodies, sea, time, timestep, centres, causes.drag)
    if loads.damping.panels.shape[0] > 0:
        panels.add_panels(
            loads.damping,
            loads.hulls,
            owners,
            bodies,
            engine.geoms,
            sea,
            time,
            timestep,
            wet,
            causes.drag,
        )
    if causes.radiation.shape[0] > 0:
        damping.add_radiation(
            loads.damping, owners, bodies, sea, time, timestep, wet, centres, causes.radiation
        )
    if loads.added_mass.bodies.shape[0] > 0:
        inertia.add_reaction(
            loads.added_mass, bodies, engine.joints, sea, time, centres, causes.added_mass
        )

    # their sum
    total = record.total
    total[:, :] = 0.0
    for cause in causes:
        for b in range(cause.shape[0]):
            for i in range(6):
                total[b, i] += cause[b, i]
    record.instant[0] = time
    record.xipos[:, :] = bodies.xipos


@njit(cache=True, error_model="numpy", inline="always")
def apply(loads, engine, record):
    """Add the loads of `add_up` to the engine's forces, and the added mass to its mass matrix.

    Returns:
        What `augment` returns.
    """
    wrenches.project(record.total, loads.bodies, engine.bodies, engine.joints, engine.qfrc_passive)
    return augment(loads, engine, record)


@njit(cache=True, error_model="numpy", inline="always")
def augment(loads, engine, record):
    """Add the added mass of what is wet to the engine's mass matrix, once in each pass.

    Returns:
        `UNCHANGED`, `AUGMENT` or `AUGMENT_DUAL`.
    """
    mass = engine.mass_matrix.M
    if loads.added_mass.bodies.shape[0] == 0 or _is_augmented(mass, record):
        return UNCHANGED
    record.ids[AUGMENTED] = 0
    if not inertia.add_inertia(
        loads.added_mass, engine.bodies, engine.joints, engine.mass_matrix, record.centres
    ):
        return UNCHANGED
    record.ids[AUGMENTED] = 1
    record.inertia[:] = mass
    dual = engine.option.solver == PGS or engine.option.noslip_iterations > 0
    return AUGMENT_DUAL if dual else AUGMENT


@njit(cache=True, error_model="numpy", inline="always")
def _is_augmented(mass, record):
    """Whether the mass matrix holds the added mass already.

    The engine may go over a pass again without computing its mass matrix anew.
    """
    return record.ids[AUGMENTED] != 0 and np.array_equal(mass, record.inertia)

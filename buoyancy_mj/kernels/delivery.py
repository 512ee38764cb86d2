"""What a pass of the water does to the engine: its forces, and its mass matrix."""

from buoyancy_mj.kernels import ballast, inertia, wrenches
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.multibody import PGS
from buoyancy_mj.kernels.passes import AUGMENTED

UNCHANGED, AUGMENT, AUGMENT_DUAL = range(3)
"""What `augment` did to the mass matrix: nothing; added mass, so that it must be factored anew; the
same for a solver of the dual problem, whose constraints must be projected anew too."""


@njit(cache=True, error_model="numpy", inline="always")
def deliver(loads, engine, record):
    """Add the sum of all loads to the engine's forces."""
    wrenches.project(record.total, loads.bodies, engine.bodies, engine.joints, engine.qfrc_passive)


@njit(cache=True, error_model="numpy", inline="always")
def augment(loads, engine, record):
    """Add added mass and the water in tanks to the engine's mass matrix, once in each pass.

    Returns:
        `UNCHANGED`, `AUGMENT` or `AUGMENT_DUAL`.
    """
    mass = engine.mass_matrix.M
    if is_augmented(mass, record):
        return UNCHANGED
    bodies = loads.added_mass.bodies.shape[0]
    add_inertia(loads, engine, record, 0, bodies)
    return end_augmenting(loads, engine, record)


@njit(cache=True, error_model="numpy", inline="always")
def add_inertia(loads, engine, record, first, last):
    """Add the added mass of the rows from first up to last, see `inertia.add_inertia`."""
    inertia.add_inertia(
        loads.added_mass,
        engine.bodies,
        engine.joints,
        engine.mass_matrix,
        record.centres,
        first,
        last,
    )


@njit(cache=True, error_model="numpy", inline="always")
def end_augmenting(loads, engine, record):
    """Add the water in tanks to a mass matrix that has all added mass, and note what it is then.

    Returns what `augment` does.
    """
    mass = engine.mass_matrix.M
    record.ids[AUGMENTED] = 0
    wet = inertia.is_wet(loads.added_mass, record.centres)
    filled = ballast.add_inertia(
        loads.ballast,
        engine.commands.act,
        loads.sea.density,
        engine.bodies,
        engine.joints,
        engine.mass_matrix,
    )
    if not (wet or filled):
        return UNCHANGED
    record.ids[AUGMENTED] = 1
    for i in range(mass.shape[0]):
        record.inertia[i] = mass[i]
    dual = engine.option.solver == PGS or engine.option.noslip_iterations > 0
    return AUGMENT_DUAL if dual else AUGMENT


@njit(cache=True, error_model="numpy", inline="always")
def is_augmented(mass, record):
    """Whether the mass matrix holds the added mass already.

    The engine may go over a pass again without computing its mass matrix anew.
    """
    same = record.ids[AUGMENTED] != 0
    for i in range(mass.shape[0]):
        same = same and mass[i] == record.inertia[i]
    return same

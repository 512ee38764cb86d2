"""The submersion and the loads as C functions, each compiled when a water first needs it.

They take the addresses of mjModel, mjData, a `passes.Record`, a `WaterTable` and a `Workplace`,
and the first of the items to do and one past the last, see `passes.DIVIDED`.
"""

import functools
from collections.abc import Callable

from numba import int64, void

from buoyancy_mj.kernels import clip, delivery
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.entries.crews import share
from buoyancy_mj.kernels.entries.tables import WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, downward_gravity
from buoyancy_mj.kernels.passes import PassArrays, Record


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _read(model, data, record, water, place, first, last):
    """What a load takes."""
    table = view(water, WaterTable)
    engine = view_engine(model, data, table.offsets, Engine)
    gravity = downward_gravity(engine.option.gravity, engine.option.disableflags)
    scratch, results = view(place, Workplace).scratch, view(record, Record)
    return PassArrays(table.loads, engine, gravity, scratch, results, first, last)


def submerge(
    model: int64, data: int64, record: int64, water: int64, place: int64, first: int64, last: int64
) -> int64:
    """Find what is under water by `clip.submerge_hulls`; returns 0, for it cannot fail."""
    arrays = _read(model, data, record, water, place, first, last)
    loads, engine = arrays.loads, arrays.engine
    clip.submerge_hulls(
        loads.hulls,
        engine.geoms,
        loads.sea.level,
        engine.time,
        arrays.scratch.cut,
        arrays.record.wet,
        first,
        last,
    )
    return 0


@functools.cache
def make_entry(load: Callable[..., None]) -> Callable[..., None]:
    """One of `passes.LOADS`, for `closures.compile_kernel`."""

    def entry(
        model: int64,
        data: int64,
        record: int64,
        water: int64,
        place: int64,
        first: int64,
        last: int64,
    ) -> void:
        load(_read(model, data, record, water, place, first, last))

    return entry


def add_inertia(
    model: int64, data: int64, record: int64, water: int64, place: int64, first: int64, last: int64
) -> void:
    """Add the added mass of bodies to the engine's mass matrix."""
    arrays = _read(model, data, record, water, place, first, last)
    delivery.add_inertia(arrays.loads, arrays.engine, arrays.record, first, last)


def augment(model: int64, data: int64, record: int64, water: int64, place: int64) -> int64:
    """Add added mass and tanks to the engine's mass matrix; returns what `delivery.augment` does.

    Threads share the bodies that have added mass.
    """
    table = view(water, WaterTable)
    loads, results = table.loads, view(record, Record)
    engine = view_engine(model, data, table.offsets, Engine)
    if delivery.is_augmented(engine.mass_matrix.M, results):
        return delivery.UNCHANGED
    items = loads.added_mass.bodies.shape[0]
    share(table.links.inertia, (model, data, record, water, place), items, table.links)
    return delivery.end_augmenting(loads, engine, results)

"""The submersion and the loads as C functions, each compiled when a water first needs it.

They take the addresses of mjModel, mjData, a `passes.Record`, a `WaterTable` and a `Workplace`.
"""

import functools
from collections.abc import Callable

from numba import int64, void

from buoyancy_mj.kernels import clip, delivery
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.entries.tables import WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, downward_gravity
from buoyancy_mj.kernels.passes import PassArrays, Record


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def _read(model, data, record, water, place):
    """What a load takes."""
    table = view(water, WaterTable)
    engine = view_engine(model, data, table.offsets, Engine)
    gravity = downward_gravity(engine.option.gravity, engine.option.disableflags)
    scratch, results = view(place, Workplace).scratch, view(record, Record)
    return PassArrays(table.loads, engine, gravity, scratch, results)


def submerge(model: int64, data: int64, record: int64, water: int64, place: int64) -> int64:
    """Find what is under water by `clip.submerge_hulls`; returns 0, for it cannot fail."""
    arrays = _read(model, data, record, water, place)
    loads, engine = arrays.loads, arrays.engine
    clip.submerge_hulls(
        loads.hulls,
        engine.geoms,
        loads.sea.level,
        engine.time,
        arrays.scratch.cut,
        arrays.record.wet,
    )
    return 0


@functools.cache
def make_entry(load: Callable[..., None]) -> Callable[..., None]:
    """One of `passes.LOADS`, for `closures.compile_kernel`."""

    def entry(model: int64, data: int64, record: int64, water: int64, place: int64) -> void:
        load(_read(model, data, record, water, place))

    return entry


def augment(model: int64, data: int64, record: int64, water: int64) -> int64:
    """Add the added mass to the engine's mass matrix; returns what `delivery.augment` does."""
    table = view(water, WaterTable)
    engine = view_engine(model, data, table.offsets, Engine)
    return delivery.augment(table.loads, engine, view(record, Record))

"""Where the time of a step goes: the engine, the sea, the walk over meshes, each load.

The parts of the water are called again and again by compiled code, over states of a run one after
the other. What they and the engine sum up to is printed beside the step as a whole.
"""

import dataclasses
import math
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np
from numba import int64
from rich.table import Table

from benchmarks import sea
from benchmarks.rows import describe_time
from benchmarks.stretches import Course, Plan, find_starts, forward, time_steps
from benchmarks.timing import spent_since
from buoyancy_mj import Scene, Start, read_scene
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.kernels import clip, delivery, passes
from buoyancy_mj.kernels.blocks import INSTANT
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.entries.pointers import call
from buoyancy_mj.kernels.entries.tables import WaterTable, Workplace
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.hulls import Hulls
from buoyancy_mj.kernels.multibody import Engine
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.kernels.tiles import Tiles
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

Results = dict[str, dict[str, float]]
"""Times [s] by scene and by part, and of the `STEP` as a whole."""

STATES = 16
"""How many; twice as many are at most `compiled.THREADS`, the records of a water."""
STEP, ENGINE = "step", "engine"
PARTS = ("sea", "walk", "pressure", "drag", "added mass", "projection", "devices")
"""The parts of the water. 'walk' is the submersion of the same hulls in the same poses under a flat
surface as high as the sea in the middle, and 'sea' is what the waves add to that. The sea at which
the pressure of waves and other loads look is theirs. 'devices' are sensors and thrusters that look
at the water."""
_PART_OF_LOAD = {
    "add_buoyancy": "pressure",
    "press_hulls": "pressure",
    "add_wave_pressure": "pressure",
    "add_drag": "drag",
    "add_panel_drag": "drag",
    "add_reaction": "added mass",
}
_LEAST = 2e-5
"""How long [s] the repeats of a part take together in a state, at least."""


class Call(NamedTuple):
    """Something that is timed."""

    repeat: Callable[..., None]
    """Does it as often as its first argument says, in the state of its second one."""
    arguments: tuple[Any, ...]
    """Its other arguments."""


def measure(quick: bool) -> Results:
    """Measure `auv_waves`, `auv_sea_state_2` and a catamaran of 4 m in 64 waves, by pressure."""
    plan = Plan(STATES, apart=60, steps=2, rounds=8 if quick else 20)
    with tempfile.TemporaryDirectory() as folder:
        return {name: _measure_scene(scene, plan) for name, scene in _list_scenes(Path(folder))}


def _list_scenes(folder: Path) -> Iterator[tuple[str, Scene]]:
    """The scenes, with names that tell what acts."""
    waves = read_scene(catalog.scenes()["auv_waves"])
    for pressure in (sea.ARCHIMEDES, sea.PRESSURE):
        yield f"auv_waves, {pressure}", dataclasses.replace(waves, pressure=pressure)
    for name, case in sea.list_cases(folder).items():
        for acting, scene in case.scenes.items():
            yield f"{name}, {sea.FEW}, {acting}", sea.enter_sea(scene, case, sea.FEW)


def _measure_scene(scene: Scene, plan: Plan) -> dict[str, float]:
    """Measure a step as a whole, without water, and each part of the water."""
    model, data, _ = assemble(scene, with_water=True)
    mujoco.mj_forward(model, data)
    bare, _, _ = assemble(dataclasses.replace(scene, start=Start()))
    starts = find_starts(model, data, plan)
    steps = time_steps({STEP: Course(model, starts), ENGINE: Course(bare, starts)}, plan)

    # calls over all states, and their sums by part
    datas = [forward(model, start) for start in starts]
    dry = [forward(bare, start) for start in starts]
    calls = _list_calls(model, datas, dry)
    times = _time_in_turns([call for _, _, call in calls], len(starts), plan.rounds)
    parts = dict.fromkeys(PARTS, 0.0)
    for (part, sign, _), seconds in zip(calls, times, strict=True):
        parts[part] = parts.get(part, 0.0) + sign * seconds
    return steps | parts


def _list_calls(
    model: mujoco.MjModel, datas: Sequence[mujoco.MjData], dry: Sequence[mujoco.MjData]
) -> list[tuple[str, float, Call]]:
    """The calls whose times make the parts: the part, the sign of the time in it, and the call.

    Args:
        model: the model.
        datas: its data in several states.
        dry: data of the model without water in the same states.
    """
    water = water_in(model)
    load_model = water.acting.load_model
    addresses = np.array([data._address for data in datas])
    places = water.compiled.address, model._address, addresses

    # the submersion, under a flat surface and under the waves
    now = np.array([data.time for data in datas])
    x, y, _ = np.transpose([data.subtree_com[water.bodies[0]] for data in datas])
    sea, tiles = load_model.arrays.sea, load_model.arrays.hulls.tiles
    still = np.zeros_like(tiles.layout), np.zeros((len(tiles.waves), 0))
    flat = water.water.elevation(x, y, now), *still
    waved = np.full(len(datas), sea.level), *tiles
    under_flat = Call(_submerge, (*places, *flat))
    under_waves = Call(_submerge, (*places, *waved))
    calls = [("walk", 1.0, under_flat), ("sea", 1.0, under_waves), ("sea", -1.0, under_flat)]

    # the loads, the forces on joints, and the mass matrix, from that without water
    _begin(*places)
    for i, load in enumerate(load_model.acting):
        part = _PART_OF_LOAD.get(load.__name__, load.__name__.removeprefix("add_"))
        calls.append((part, 1.0, Call(_act, (*places, i))))
    calls.append(("projection", 1.0, Call(_deliver, places)))
    if load_model.augments:
        masses = np.array([data.M for data in dry])
        calls.append(("added mass", 1.0, Call(_augment, (*places, masses))))
    calls.append(("devices", 1.0, Call(_run_devices, (model, datas))))
    calls.append(("devices", -1.0, Call(_run_devices, (dry[0].model, dry))))
    return calls


def _time_in_turns(calls: Sequence[Call], states: int, rounds: int) -> list[float]:
    """Times of the thread [s] of calls, means over states, of each the quickest round."""
    counts = []
    for one in calls:
        _time(one, 1, 0)
        counts.append(1 + int(_LEAST / max(_time(one, 1, 0), 1e-7)))
    best, ways = np.full((len(calls), states), np.inf), np.full(len(calls), np.inf)
    for _ in range(rounds):
        for n, (one, count) in enumerate(zip(calls, counts, strict=True)):
            for i in range(states):
                # without the way from Python and back
                ways[n] = min(ways[n], _time(one, 0, i))
                best[n, i] = min(best[n, i], _time(one, count, i))
    spent = best.mean(axis=1) - ways
    return [float(seconds) / count for seconds, count in zip(spent, counts, strict=True)]


def _time(one: Call, count: int, state: int) -> float:
    """Time of the thread [s] of a call that does something `count` times in a state."""
    started = time.thread_time()
    one.repeat(count, state, *one.arguments)
    return spent_since(started)


def _run_devices(
    count: int, state: int, model: mujoco.MjModel, datas: Sequence[mujoco.MjData]
) -> None:
    """Run actuators and sensors, some of which look at the water."""
    data = datas[state]
    for _ in range(count):
        mujoco.mj_fwdActuation(model, data)
        mujoco.mj_sensorPos(model, data)
        mujoco.mj_sensorVel(model, data)
        mujoco.mj_sensorAcc(model, data)


@njit(cache=True, error_model="numpy")
def _submerge(count, state, water, model, datas, levels, layout, waves):
    """Submerge all hulls under the waves of a layout, and leave that in a record of its own."""
    table = view(water, WaterTable)
    engine = view_engine(model, datas[state], table.offsets, Engine)
    own, scratch = table.loads.hulls, view(table.pool[0], Workplace).scratch
    hulls = Hulls(
        own.vertices, own.faces, own.areas, own.sizes, own.nodes, own.spans, own.boxes,
        own.moments, own.rules, own.edges, own.whole, own.typical, Tiles(layout, waves), own.blocks,
        own.frames,
    )  # fmt: skip
    wet = view(table.records[STATES + state], Record).wet
    for n in range(count):
        clip.submerge_hulls(
            hulls,
            engine.geoms,
            levels[state],
            # as at a new instant, so that the sea is summed up anew
            engine.time + 1e-9 * n,
            scratch.cut,
            wet,
            0,
            hulls.frames.shape[0],
        )


@njit(cache=True, error_model="numpy")
def _begin(water, model, datas):
    """Find what is wet in each state, for the loads to read."""
    table = view(water, WaterTable)
    for i in range(len(datas)):
        words = model, datas[i], table.records[i], water, table.pool[0]
        call(table.links.submerge, (*words, int64(0), table.hulls))
        passes.begin(table.loads, view(table.records[i], Record))


@njit(cache=True, error_model="numpy")
def _act(count, state, water, model, datas, load):
    """Add one of the loads that act."""
    table = view(water, WaterTable)
    words = model, datas[state], table.records[state], water, table.pool[0]
    found = view(table.pool[0], Workplace).scratch.pressure.store.found
    for _ in range(count):
        # as at a new instant, so that the sea is summed up anew
        for b in range(found.shape[0]):
            found[b, INSTANT] = math.nan
        call(table.acting[load], (*words, int64(0), table.items[load]))


@njit(cache=True, error_model="numpy")
def _deliver(count, state, water, model, datas):
    """Sum up, and add the sum to the engine's forces."""
    table = view(water, WaterTable)
    record = view(table.records[state], Record)
    engine = view_engine(model, datas[state], table.offsets, Engine)
    for _ in range(count):
        passes.begin(table.loads, record)
        passes.end(engine, record)
        delivery.deliver(table.loads, engine, record)


@njit(cache=True, error_model="numpy")
def _augment(count, state, water, model, datas, masses):
    """Add added mass to the mass matrix, and factorise that."""
    table = view(water, WaterTable)
    engine = view_engine(model, datas[state], table.offsets, Engine)
    words = model, datas[state], table.records[state], water, table.pool[0]
    for _ in range(count):
        engine.mass_matrix.M[:] = masses[state]
        if call(table.links.augment, words) != delivery.UNCHANGED:
            call(table.links.factor, (model, datas[state]))


def describe(results: Results) -> Iterator[Table | str]:
    """Describe each scene in a row, parts as shares of the step."""
    table = Table(title="where a step goes: processor time, as shares of the step as a whole")
    for column in ("scene", STEP, *list_columns(results), "together"):
        table.add_column(column, justify="right")
    for name, cells in list_shares(results):
        table.add_row(name, *cells)
    yield table


def list_columns(results: Results) -> tuple[str, ...]:
    """The parts of a step, those last that some scenes have alone."""
    others = {part for row in results.values() for part in row} - {STEP, ENGINE, *PARTS}
    return (ENGINE, *PARTS, *sorted(others))


def list_shares(results: Results) -> Iterator[tuple[str, list[str]]]:
    """Each scene with its step, the share of each part, and what they sum up to."""
    columns = list_columns(results)
    for name, row in results.items():
        shares = [row.get(column, 0.0) / row[STEP] for column in columns]
        yield name, [describe_time(row[STEP]), *(f"{n:.0%}" for n in [*shares, sum(shares)])]

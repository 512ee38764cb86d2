"""Where the time of a step goes: the engine, the sea, the walk over meshes, each load.

The parts of the water are called again and again by compiled code, over states of a run one after
the other. What they and the engine sum up to is printed beside the step as a whole.
"""

import dataclasses
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numba import carray, njit
from numpy.typing import NDArray
from rich.table import Table

from benchmarks import sea
from benchmarks.rows import describe_time
from benchmarks.stretches import Course, Plan, find_starts, forward, time_steps
from benchmarks.timing import spent_since
from buoyancy_mj import Buoyancy, Scene, Start, read_scene
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.kernels import clip, delivery, passes
from buoyancy_mj.kernels.entries.pointers import call, pointer
from buoyancy_mj.kernels.entries.tables import WaterTable
from buoyancy_mj.kernels.entries.views import view, view_engine
from buoyancy_mj.kernels.multibody import Engine, Geoms
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble

Results = dict[str, dict[str, float]]
"""Times [s] by scene and by part, and of the `STEP` as a whole."""

STEP, ENGINE = "step", "engine"
PARTS = ("sea", "walk", "pressure", "drag", "added mass", "projection", "devices")
"""The parts of the water. 'walk' is the submersion of the same hulls in the same poses under a flat
surface as high as the sea in the middle, and 'sea' is what the waves add to that. The sea at which
the pressure of waves and other loads look is theirs. 'devices' are sensors and thrusters that look
at the water."""
_PART_OF_LOAD = {
    "add_buoyancy": "pressure",
    "add_wave_pressure": "pressure",
    "add_drag": "drag",
    "add_panel_drag": "drag",
    "add_reaction": "added mass",
}
_LEAST = 3e-4
"""How long [s] the repeats of a part take together, at least."""


def measure(quick: bool) -> Results:
    """Measure `auv_waves`, `auv_sea_state_2` and a catamaran of 4 m in 64 waves, by pressure."""
    plan = Plan(starts=16, apart=60, steps=2, rounds=5 if quick else 20)
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
    times = time_steps({STEP: Course(model, starts), ENGINE: Course(bare, starts)}, plan)

    # the mass matrix without added mass is the engine's own
    datas = [forward(model, start) for start in starts]
    dry = [forward(bare, start) for start in starts]
    masses = np.array([data.M for data in dry])
    devices, bare_devices = (
        _time(_run_devices, plan.rounds, *pair) / len(starts)
        for pair in ((model, datas), (bare, dry))
    )
    parts = _time_parts(water_in(model), model, datas, masses, plan.rounds)
    return times | parts | {"devices": devices - bare_devices}


def _time_parts(
    water: Buoyancy,
    model: mujoco.MjModel,
    datas: Sequence[mujoco.MjData],
    masses: NDArray[np.float64],
    rounds: int,
) -> dict[str, float]:
    """Mean times [s] of the parts of a pass.

    Args:
        water: the water of the model.
        model: the model.
        datas: its data in several states, at most `compiled.THREADS`.
        masses: mass matrices (n, nC) in these states, without added mass.
        rounds: how often each part is timed; the quickest counts.
    """
    load_model = water.acting.load_model
    addresses = np.array([data._address for data in datas])
    places = water.compiled.address, model._address, addresses
    parts = dict.fromkeys(PARTS, 0.0)

    # the submersion, under a flat surface and under the waves
    arrays, scratch = load_model.arrays, load_model.scratch.cut
    positions = np.array([data.geom_xpos for data in datas])
    rotations = np.array([data.geom_xmat for data in datas])
    now = np.array([data.time for data in datas])
    x, y, _ = np.transpose([data.subtree_com[water.bodies[0]] for data in datas])
    wet = np.zeros((len(arrays.owners), clip.COLUMNS))
    seas = (
        (water.water.elevation(x, y, now), arrays.sea.waves[:0]),
        (np.full(len(datas), arrays.sea.level), arrays.sea.waves),
    )
    flat, waved = (
        _time(
            _submerge,
            rounds,
            arrays.hulls,
            positions,
            rotations,
            levels,
            *(waves, now, scratch, wet),
        )
        for levels, waves in seas
    )
    parts["walk"], parts["sea"] = flat, waved - flat

    # the loads, the mass matrix, and the forces on joints
    _begin(*places)
    for i, load in enumerate(load_model.acting):
        part = _PART_OF_LOAD.get(load.__name__, load.__name__.removeprefix("add_"))
        parts[part] = parts.get(part, 0.0) + _time(_act, rounds, *places, i)
    parts["projection"] = _time(_deliver, rounds, *places)
    if load_model.augments:
        addresses_of_masses = np.array([data.M.ctypes.data for data in datas])
        parts["added mass"] += _time(_augment, rounds, *places, addresses_of_masses, masses)
    return {part: seconds / len(datas) for part, seconds in parts.items()}


def _run_devices(count: int, model: mujoco.MjModel, datas: Sequence[mujoco.MjData]) -> None:
    """Run actuators and sensors, some of which look at the water."""
    for _ in range(count):
        for data in datas:
            mujoco.mj_fwdActuation(model, data)
            mujoco.mj_sensorPos(model, data)
            mujoco.mj_sensorVel(model, data)
            mujoco.mj_sensorAcc(model, data)


def _time(repeat: Callable[..., None], rounds: int, *arguments: Any) -> float:
    """Least time of the thread [s] of a function that repeats something over all states."""
    repeat(1, *arguments)
    started = time.thread_time()
    repeat(1, *arguments)
    count = 1 + int(_LEAST / max(spent_since(started), 1e-7))
    times = []
    for _ in range(rounds):
        started = time.thread_time()
        repeat(count, *arguments)
        times.append(spent_since(started) / count)
    return min(times)


@njit(cache=True, error_model="numpy")
def _submerge(count, hulls, positions, rotations, levels, waves, now, scratch, out):
    """Submerge all hulls, again and again, in each state."""
    for _ in range(count):
        for i in range(len(now)):
            geoms = Geoms(positions[i], rotations[i])
            clip.submerge_hulls(hulls, geoms, levels[i], waves, now[i], scratch, out)


@njit(cache=True, error_model="numpy")
def _begin(water, model, datas):
    """Find what is wet in each state, for the loads to read."""
    table = view(water, WaterTable)
    for i in range(len(datas)):
        arguments = model, datas[i], table.records[i], water, table.pool[0]
        call(table.links.submerge, arguments)
        passes.begin(table.loads, view(table.records[i], Record))


@njit(cache=True, error_model="numpy")
def _act(count, water, model, datas, load):
    """Add one of the loads that act."""
    table = view(water, WaterTable)
    for _ in range(count):
        for i in range(len(datas)):
            arguments = model, datas[i], table.records[i], water, table.pool[0]
            call(table.acting[load], arguments)


@njit(cache=True, error_model="numpy")
def _deliver(count, water, model, datas):
    """Sum up, and add the sum to the engine's forces."""
    table = view(water, WaterTable)
    for _ in range(count):
        for i in range(len(datas)):
            record = view(table.records[i], Record)
            engine = view_engine(model, datas[i], table.offsets, Engine)
            passes.begin(table.loads, record)
            passes.end(engine, record)
            delivery.deliver(table.loads, engine, record)


@njit(cache=True, error_model="numpy")
def _augment(count, water, model, datas, masses, fresh):
    """Add added mass to the mass matrix, and factorise that."""
    table = view(water, WaterTable)
    for _ in range(count):
        for i in range(len(datas)):
            mass = carray(pointer(masses[i]), (fresh.shape[1],), np.float64)
            mass[:] = fresh[i]
            arguments = model, datas[i], table.records[i], water
            if call(table.links.augment, arguments) != delivery.UNCHANGED:
                call(table.links.factor, (model, datas[i]))


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

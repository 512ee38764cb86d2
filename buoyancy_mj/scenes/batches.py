"""Simulations run side by side, as batches on all cores as far as their models allow."""

import time
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np
from mujoco import batch
from numpy.typing import NDArray

from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.errors import DivergenceError
from buoyancy_mj.scenes.divergence import describe_divergence
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.trajectory import Trajectory

BATCH_MEMORY = 2e8
"""Memory that the trajectories of a batch may take [bytes]."""
MOST_MEMORY = 2e9
"""Memory that the trajectory of one run may take [bytes]; a longer run goes alone, without it."""
_STATE = ("qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat")
_SIZES = ("nq", "nv", "na", "nu", "nbody", "ngeom", "nsite", "nsensordata", "nmocap")
_TIME = int(mujoco.mjtState.mjSTATE_TIME)


def run_simulations(
    simulations: Mapping[int, Simulation], threads: int = 0
) -> Iterator[tuple[int, str]]:
    """Run simulations to their ends.

    Args:
        simulations: what to run, by any number.
        threads: number of threads that step at once; 0 for one per core.

    Yields:
        The number of each simulation, batch by batch, and the reason why it failed, or ''.
    """
    groups: dict[tuple[float, ...], list[int]] = {}
    for number, simulation in simulations.items():
        groups.setdefault(_batch_key(simulation), []).append(number)
    for group in groups.values():
        size = max(1, int(BATCH_MEMORY / _trajectory_size(simulations[group[0]])))
        for start in range(0, len(group), size):
            numbers = group[start : start + size]
            members = [simulations[number] for number in numbers]
            if plugin_instances(members[0].model) and _trajectory_size(members[0]) <= MOST_MEMORY:
                reasons = run_batch(members, threads)
            else:
                reasons = [_run_alone(member) for member in members]
            yield from zip(numbers, reasons, strict=True)


def run_batch(simulations: Sequence[Simulation], threads: int = 0) -> list[str]:
    """Run simulations whose models hold their water and have the same sizes, as one batch.

    Args:
        simulations: what to run.
        threads: number of threads that step at once; 0 for one per core.

    Returns:
        For each simulation the reason why it failed, or ''.
    """
    # the models and their states at the start
    first = simulations[0]
    many = batch.Batch(first.model, len(simulations), nthread=threads)
    many.set_models([simulation.model for simulation in simulations])
    for name in _STATE:
        if getattr(first.data, name).size:
            many.bind(name)[:] = [getattr(simulation.data, name) for simulation in simulations]

    # all steps
    started = time.perf_counter()
    recorded = _recorders(first, len(simulations))
    failures: dict[int, str] = {}
    try:
        many.rollout(first.steps, record=list(recorded), out=recorded)
    except batch.SimulationError:
        failures = {i: many.error(i) for i in range(len(simulations)) if many.error(i)}
    wall_time = (time.perf_counter() - started) / len(simulations)

    # what came of each
    reasons = []
    for i, simulation in enumerate(simulations):
        reason = failures.get(i, "") or _divergence(simulation, float(recorded[_TIME][i, -1, 0]))
        if not reason:
            trajectory = Trajectory(*(recorded[name][i] for name in Trajectory._fields))
            simulation.replay(trajectory, wall_time)
        reasons.append(reason)
    return reasons


def _recorders(simulation: Simulation, count: int) -> dict[str | int, NDArray[Any]]:
    """Room for the trajectories of a batch and for their times."""
    leading = count, simulation.steps
    recorders: dict[str | int, NDArray[Any]] = {}
    for name in Trajectory._fields:
        value = np.asarray(getattr(simulation.data, name))
        kind = np.int32 if value.dtype.kind == "i" else np.float64
        recorders[name] = np.zeros((*leading, *value.shape), kind)
    recorders[_TIME] = np.zeros((*leading, 1))
    return recorders


def _divergence(simulation: Simulation, end: float) -> str:
    """The sentence that tells of a run whose time does not end where it should, or ''."""
    timestep = simulation.model.opt.timestep
    if abs(end - simulation.steps * timestep) < 0.5 * timestep:
        return ""
    return describe_divergence(simulation.scene, end)


def _run_alone(simulation: Simulation) -> str:
    """Run one simulation to its end; the reason why it failed, or ''."""
    try:
        for _ in simulation.frames():
            pass
    except (DivergenceError, mujoco.FatalError) as error:
        return str(error)
    return ""


def _trajectory_size(simulation: Simulation) -> float:
    """Memory of the trajectory of a whole run [bytes]."""
    model = simulation.model
    return float(8 * simulation.steps * (15 * model.nbody + model.nq + 1))


def _batch_key(simulation: Simulation) -> tuple[float, ...]:
    """Numbers that simulations must share to be stepped in one batch."""
    model = simulation.model
    sizes = [getattr(model, name) for name in _SIZES]
    return (*sizes, simulation.steps, model.opt.timestep, len(plugin_instances(model)))

"""Simulations run side by side, as batches on all cores as far as their models allow."""

import time
from collections.abc import Iterator, Mapping, Sequence

import mujoco
import numpy as np
from mujoco import batch

from buoyancy_mj.engine.c_functions import find_cause
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.errors import BuoyancyError, DivergenceError
from buoyancy_mj.scenes.divergence import describe_divergence
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.trajectory import Trajectory

BATCH_MEMORY = 2e8
"""Memory that the trajectories of a batch may take [bytes]."""
BLOCK_TIME = 0.25
"""About how long a batch steps before Ctrl-C is asked for [s]."""
_STATE = ("qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat")
_SIZES = ("nq", "nv", "na", "nu", "nbody", "ngeom", "nsite", "nsensordata", "nmocap")


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
            if plugin_instances(members[0].model):
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

    # all steps, block by block, between which Ctrl-C acts
    trajectories = _make_trajectories(first, len(simulations), first.steps)
    failures: dict[int, str] = {}
    started = time.perf_counter()
    done, size = 0, 1
    while done < first.steps and len(failures) < len(simulations):
        size = min(size, first.steps - done)
        begun = time.perf_counter()
        running = [i for i in range(len(simulations)) if i not in failures]
        failures |= _step_block(many, simulations, running, slice(done, done + size), trajectories)
        done += size
        size = max(1, int(size * min(2.0, BLOCK_TIME / (time.perf_counter() - begun))))
    wall_time = (time.perf_counter() - started) / len(simulations)

    # what came of each
    for i, simulation in enumerate(simulations):
        if i not in failures:
            simulation.replay(Trajectory(*(values[i] for values in trajectories)), wall_time)
    return [failures.get(i, "") for i in range(len(simulations))]


def _make_trajectories(simulation: Simulation, count: int, steps: int) -> Trajectory:
    """Room for the trajectories of some simulations over some steps."""
    arrays = []
    for name in Trajectory._fields:
        value = np.asarray(getattr(simulation.data, name))
        kind = np.int32 if value.dtype.kind == "i" else np.float64
        arrays.append(np.zeros((count, steps, *value.shape), kind))
    return Trajectory(*arrays)


def _step_block(
    many: batch.Batch,
    simulations: Sequence[Simulation],
    running: Sequence[int],
    steps: slice,
    trajectories: Trajectory,
) -> dict[int, str]:
    """Take some steps with the simulations that still run, and keep what they leave.

    Returns:
        The reasons of those that fail.
    """
    size = steps.stop - steps.start
    recorded = _make_trajectories(simulations[0], len(running), size)._asdict()
    failures = {}
    try:
        many.rollout(size, record=list(recorded), ids=running, out=recorded)
    except batch.SimulationError:
        failures = {i: _find_reason(many.error(i)) for i in running if many.error(i)}
    for name, values in recorded.items():
        getattr(trajectories, name)[running, steps] = values

    # one that diverges stops before the others
    now = many.bind("time")
    timestep = simulations[0].model.opt.timestep
    for i in running:
        if i not in failures and abs(now[i] - steps.stop * timestep) > 0.5 * timestep:
            failures[i] = describe_divergence(simulations[i].scene, float(now[i]))
    return failures


def _find_reason(told: str) -> str:
    """The reason of a run that fails, from the message of the engine.

    Raises:
        BaseException: what says nothing of the run, as Ctrl-C does.
        MemoryError: the memory ran out.
    """
    if "ould not allocate" in told:
        raise MemoryError(told)
    cause = find_cause(told)
    if cause is not None and not isinstance(cause, BuoyancyError):
        raise cause
    return told if cause is None else str(cause)


def _run_alone(simulation: Simulation) -> str:
    """Run one simulation to its end; the reason why it failed, or ''."""
    try:
        for _ in simulation.frames():
            pass
    except DivergenceError as error:
        return str(error)
    except mujoco.FatalError as error:
        return _find_reason(str(error))
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

"""Simulations run side by side, as batches on all cores as far as their models allow."""

import time
from collections.abc import Iterator, Mapping, Sequence

import mujoco
import numpy as np
from mujoco import batch

from buoyancy_mj.engine.c_functions import find_cause, raise_causes
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.errors import BuoyancyError, ControlError, DivergenceError
from buoyancy_mj.scenes.divergence import BAD_VALUES, describe_divergence
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.trajectory import Trajectory

BATCH_MEMORY = 2e8
"""Memory that the trajectories of a batch may take [bytes]."""
MOST_MEMORY = 2e9
"""Memory that the trajectory of one run may take [bytes]; a longer run goes alone, without it."""
BLOCK_TIME = 0.25
"""About how long a batch steps before Ctrl-C is asked for [s]."""
PATIENCE = 3.0
"""How many times longer than its first step a batch may step at least: in each block the engine
asks for the devices of all its simulations anew, which may take as long as many steps."""
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
            if _can_batch(members[0]):
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
    with raise_causes():
        many = batch.Batch(first.model, len(simulations), nthread=threads)
        many.set_models([simulation.model for simulation in simulations])
        for name in _STATE:
            if getattr(first.data, name).size:
                many.bind(name)[:] = [getattr(simulation.data, name) for simulation in simulations]

    # all steps, block by block, between which Ctrl-C acts
    stepping = _Stepping(many, simulations)
    started = time.perf_counter()
    done, size, block_time = 0, 1, 0.0
    while done < first.steps and len(stepping.failures) < len(simulations):
        size = min(size, first.steps - done)
        begun = time.perf_counter()
        stepping.step(slice(done, done + size))
        spent = time.perf_counter() - begun
        done += size
        block_time = block_time or max(BLOCK_TIME, PATIENCE * spent)
        size = max(1, int(size * min(2.0, block_time / spent)))
    wall_time = (time.perf_counter() - started) / len(simulations)

    # what came of each
    for i, simulation in enumerate(simulations):
        if i not in stepping.failures:
            trajectory = Trajectory(*(values[i] for values in stepping.trajectories))
            try:
                simulation.replay(trajectory, wall_time)
            except DivergenceError as error:
                stepping.failures[i] = str(error)
    return [stepping.failures.get(i, "") for i in range(len(simulations))]


class _Stepping:
    """A batch on its way: what its simulations leave."""

    def __init__(self, many: batch.Batch, simulations: Sequence[Simulation]) -> None:
        self._batch, self._simulations = many, simulations
        self._time = many.bind("time")
        self.trajectories = self._make_trajectories(len(simulations), simulations[0].steps)
        """Trajectories of all simulations, one after the other in each array."""
        self.failures: dict[int, str] = {}
        """Reasons of those that failed."""

    def step(self, steps: slice) -> None:
        """Take these steps with all simulations that have not failed."""
        running = [i for i in range(len(self._simulations)) if i not in self.failures]
        self._roll_out(running, steps)

        # a warning of any kind makes MuJoCo leave one behind; it goes on as it would alone
        timestep = self._simulations[0].model.opt.timestep
        for i in running:
            while i not in self.failures and round(self._time[i] / timestep) < steps.stop:
                self._roll_out([i], slice(round(self._time[i] / timestep), steps.stop))

    def _roll_out(self, numbers: Sequence[int], steps: slice) -> None:
        """Take steps with some simulations, and keep what they leave."""
        recorded = self._make_trajectories(len(numbers), steps.stop - steps.start)._asdict()
        asked = {name: values for name, values in recorded.items() if values.size}
        try:
            self._batch.rollout(
                steps.stop - steps.start, record=list(asked), ids=numbers, out=asked
            )
        except batch.SimulationError as error:
            self.failures |= {int(i): _find_reason(self._batch.error(i)) for i in error.ids}
        for name, values in asked.items():
            getattr(self.trajectories, name)[numbers, steps] = values

        # bad values end one
        for i in numbers:
            if i not in self.failures and self._batch.warning[i, BAD_VALUES, 1].any():
                scene = self._simulations[i].scene
                self.failures[i] = describe_divergence(scene, float(self._time[i]))

    def _make_trajectories(self, count: int, steps: int) -> Trajectory:
        """Room for the trajectories of some simulations over some steps."""
        arrays = []
        for name in Trajectory._fields:
            value = np.asarray(getattr(self._simulations[0].data, name))
            if name == "sensordata" and not self._simulations[0].measures_sensors:
                value = value[:0]
            kind = np.int32 if value.dtype.kind == "i" else np.float64
            arrays.append(np.zeros((count, steps, *value.shape), kind))
        return Trajectory(*arrays)


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
        simulation.run()
    except (ControlError, DivergenceError) as error:
        return str(error)
    except mujoco.FatalError as error:
        return _find_reason(str(error))
    return ""


def _can_batch(simulation: Simulation) -> bool:
    """Whether the engine can step a simulation by itself.

    Controllers and referees are Python, step by step.
    """
    return bool(
        plugin_instances(simulation.model)
        and not simulation.scene.control
        and simulation.mission is None
        and _trajectory_size(simulation) <= MOST_MEMORY
    )


def _trajectory_size(simulation: Simulation) -> float:
    """Memory of the trajectory of a whole run [bytes]."""
    model = simulation.model
    sensors = model.nsensordata if simulation.measures_sensors else 0
    return float(8 * simulation.steps * (15 * model.nbody + model.nq + 1 + sensors))


def _batch_key(simulation: Simulation) -> tuple[float, ...]:
    """Numbers that simulations must share to be stepped in one batch."""
    model = simulation.model
    sizes = [getattr(model, name) for name in _SIZES]
    kinds = (len(plugin_instances(model)), len(simulation.scene.control))
    return (*sizes, simulation.steps, model.opt.timestep, *kinds)

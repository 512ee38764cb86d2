"""Many runs of one scene: a grid or random draws over its fields, as batches on all cores, one row of results each."""

import dataclasses
import functools
import hashlib
import itertools
import math
import time
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from mujoco import batch
from numpy.typing import NDArray

from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.errors import BuoyancyError, DivergenceError, SweepError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.frames import Summary
from buoyancy_mj.scenes.journal import Journal, read_parquet, write_parquet
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.simulation import Simulation

AT_ONCE = 64
"""Most runs in a batch: as many are lost at most when the sweep is killed."""
ROOM = 2e8
"""Memory that the poses of a batch may take [bytes]."""
_SUMMARY = tuple(
    f.name
    for f in dataclasses.fields(Summary)
    if f.name not in ("scene", "wall_time", "real_time_factor")
)
_STATE = ("qpos", "qvel", "act", "ctrl", "mocap_pos", "mocap_quat")


@dataclasses.dataclass(frozen=True)
class Over:
    """One field of the scene and the values it takes."""

    key: str
    """As for `--set`, 'water.waves.0.amplitude'."""
    low: float
    """First value."""
    high: float
    """Last value."""
    count: int
    """How many, evenly spaced; of random draws this plays no part."""

    @property
    def values(self) -> list[float]:
        """All of them."""
        return np.linspace(self.low, self.high, self.count).tolist()


def parse_over(text: str) -> Over:
    """'KEY=a:b:n', n values from a to b, or 'KEY=a:b' for random draws.

    Raises:
        SweepError: it is nothing of that kind.
    """
    key, equals, span = text.partition("=")
    parts = span.split(":")
    try:
        low, high = float(parts[0]), float(parts[1])
        count = int(parts[2]) if len(parts) == 3 else 0
        if not (
            equals
            and key.strip()
            and len(parts) in (2, 3)
            and math.isfinite(low)
            and math.isfinite(high)
        ):
            raise ValueError
        if len(parts) == 3 and count < 1:
            raise ValueError
    except (ValueError, IndexError):
        raise SweepError(
            f"--over is '{text}'; it must be KEY=a:b:n, n values from a to b, as start.position.2=0:0.5:6, "
            "or KEY=a:b with --draws"
        ) from None
    return Over(key.strip(), low, high, count)


def grid(over: Sequence[Over]) -> list[tuple[float, ...]]:
    """All combinations of values, the last field fastest.

    Raises:
        SweepError: a field without a number of values.
    """
    for one in over:
        if one.count == 0:
            raise SweepError(
                f"--over {one.key}={one.low:g}:{one.high:g} has no number of values; add it (:n), or give --draws"
            )
    return list(itertools.product(*(one.values for one in over)))


def draws(over: Sequence[Over], count: int, seed: int) -> list[tuple[float, ...]]:
    """Random combinations, each value uniform between its ends; the same for the same seed."""
    low, high = (np.array([getattr(one, end) for one in over]) for end in ("low", "high"))
    return [
        tuple(row)
        for row in np.random.default_rng(seed).uniform(low, high, (count, len(over))).tolist()
    ]


@dataclasses.dataclass(frozen=True)
class Sweep:
    """A scene and the values of its fields in each run."""

    path: Path
    """The scene's file."""
    settings: tuple[str, ...]
    """What all runs have, as for `--set`."""
    keys: tuple[str, ...]
    """Fields that vary."""
    values: tuple[tuple[float, ...], ...]
    """Of them in each run."""
    out: Path
    """Results: .csv, or .parquet."""

    def __post_init__(self) -> None:
        if self.out.suffix not in (".csv", ".parquet"):
            raise SweepError(
                f"--out is '{self.out}'; results go to a file that ends in .csv or .parquet"
            )
        if len(set(self.keys)) < len(self.keys):
            raise SweepError(
                f"a field is given twice: {', '.join(self.keys)}; give each --over once"
            )

    def run(self, threads: int = 0) -> Iterator[dict[str, str]]:
        """Run what has not been run yet, batch by batch; a row for each run, those of earlier sweeps first.

        Args:
            threads: that step at once; 0 for one per core.

        Raises:
            SweepError: see `Journal`.
        """
        # parquet has no end to write to, so that a journal stands beside it until all is done
        journal = self.out if self.out.suffix == ".csv" else self.out.with_suffix(".partial.csv")
        known = (
            read_parquet(self.out) if self.out.suffix == ".parquet" and not journal.exists() else []
        )
        done = Journal(journal, self._header, self._digest, known)
        try:
            self._compare(journal, done.rows)
            self._check_fields()
            yield from done.rows.values()
            todo = [i for i in range(len(self.values)) if i not in done.rows]
            while todo:
                now, todo = todo[:AT_ONCE], todo[AT_ONCE:]
                for row in self._batch(now, threads):
                    done.add(row)
                    done.save()
                    yield done.rows[int(row["run"])]
        finally:
            done.close()
        if self.out.suffix == ".parquet":
            write_parquet(self.out, [done.rows[i] for i in sorted(done.rows)], done.header)
            journal.unlink()

    @property
    def _header(self) -> list[str]:
        """Columns of the results."""
        return [
            "run",
            "scene",
            *self.keys,
            "status",
            "reason",
            *(name for name in _SUMMARY if name not in self.keys),
        ]

    def _compare(self, path: Path, rows: Mapping[int, Mapping[str, str]]) -> None:
        """Refuse rows of runs that this sweep does not have, or has with other values."""
        for run, row in rows.items():
            if (
                run >= len(self.values)
                or tuple(float(row[key]) for key in self.keys) != self.values[run]
            ):
                raise SweepError(
                    f"'{path}' holds runs with other values; give another --out, or remove it"
                )

    def _check_fields(self) -> None:
        """Tell at once what would be wrong with every run: a field that the scene lacks."""
        errors = []
        for run in {0, len(self.values) - 1}:
            try:
                self._scene(run)
            except BuoyancyError as error:
                errors.append(error)
        if (
            errors
            and len(errors) == len({0, len(self.values) - 1})
            and "unknown key" in str(errors[0])
        ):
            raise errors[0]

    @functools.cached_property
    def _digest(self) -> str:
        """In short, what all runs have in common."""
        scene = read_scene(self.path, self.settings)
        vehicle = catalog.model_path(scene.vehicle, scene.folder)
        told = repr((self.path.read_bytes(), vehicle.read_bytes(), self.settings, self.keys))
        return f"{self.path.stem} {hashlib.blake2b(told.encode(), digest_size=4).hexdigest()}"

    def _scene(self, run: int) -> Scene:
        varied = (
            f"{key}={value!r}" for key, value in zip(self.keys, self.values[run], strict=True)
        )
        return read_scene(self.path, [*self.settings, *varied])

    def _batch(self, runs: Sequence[int], threads: int) -> Iterator[dict[str, Any]]:
        """Rows of some runs, stepped together as far as their models allow."""
        ready: dict[tuple[int, ...], list[tuple[int, Simulation]]] = {}
        for run in runs:
            try:
                simulation = Simulation(self._scene(run))
            except BuoyancyError as error:
                yield self._row(run, reason=str(error))
                continue
            ready.setdefault(_layout(simulation), []).append((run, simulation))
        for group in ready.values():
            size = simulation_size(group[0][1])
            most = max(1, int(ROOM / size))
            for first in range(0, len(group), most):
                some = group[first : first + most]
                reasons = join_batches([simulation for _, simulation in some], threads)
                for (run, simulation), reason in zip(some, reasons, strict=True):
                    yield self._row(run, simulation, reason)

    def _row(
        self, run: int, simulation: Simulation | None = None, reason: str = ""
    ) -> dict[str, Any]:
        row = {
            "run": run,
            "scene": self._digest,
            "status": "failed" if reason else "done",
            "reason": reason,
        }
        row |= dict(zip(self.keys, self.values[run], strict=True))
        told = dataclasses.asdict(simulation.summary()) if simulation and not reason else {}
        return row | {name: told.get(name) for name in _SUMMARY if name not in self.keys}


def simulation_size(simulation: Simulation) -> float:
    """Memory of the poses of a whole run [bytes]."""
    return 8.0 * simulation.steps * (15 * simulation.model.nbody + simulation.model.nq + 1)


def join_batches(simulations: Sequence[Simulation], threads: int = 0) -> list[str]:
    """Run simulations of one layout to their ends, as a batch; for each the reason why it failed, or nothing."""
    if not plugin_instances(simulations[0].model):
        return [_alone(simulation) for simulation in simulations]
    first, steps = simulations[0], simulations[0].steps
    many = batch.Batch(first.model, len(simulations), nthread=threads)
    many.set_models([simulation.model for simulation in simulations])
    for name in _STATE:
        if getattr(first.data, name).size:
            many.bind(name)[:] = [getattr(simulation.data, name) for simulation in simulations]
    started = time.perf_counter()
    recorded: dict[str | int, NDArray[Any]] = {
        name: np.zeros(
            (len(simulations), steps, *np.shape(getattr(first.data, name))),
            np.int32 if name == "ncon" else float,
        )
        for name in ("xpos", "xmat", "xipos", "qpos", "ncon")
    }
    clock = int(mujoco.mjtState.mjSTATE_TIME)
    recorded[clock] = np.zeros((len(simulations), steps, 1))
    failed: dict[int, str] = {}
    try:
        many.rollout(steps, record=list(recorded), out=recorded)
    except batch.SimulationError:
        failed = {i: many.error(i) for i in range(len(simulations)) if many.error(i)}
    wall = (time.perf_counter() - started) / len(simulations)
    reasons = []
    for i, simulation in enumerate(simulations):
        end = float(recorded[clock][i, -1, 0])
        reason = failed.get(i, "")
        if (
            not reason
            and not abs(end - steps * first.model.opt.timestep) < 0.5 * first.model.opt.timestep
        ):
            reason = simulation.divergence(end)
        if not reason:
            poses = {str(name): values[i] for name, values in recorded.items() if name != clock}
            simulation.follow(**poses, wall_time=wall)
        reasons.append(reason)
    return reasons


def _alone(simulation: Simulation) -> str:
    """Run one to its end; the reason why it failed, or nothing."""
    try:
        for _ in simulation.frames():
            pass
    except (DivergenceError, mujoco.FatalError) as error:
        return str(error)
    return ""


def _layout(simulation: Simulation) -> tuple[int, ...]:
    """Simulations that agree in this may be stepped in one batch."""
    model = simulation.model
    sizes = [
        int(getattr(model, f"n{name}"))
        for name in ("q", "v", "a", "u", "body", "geom", "site", "sensordata", "mocap")
    ]
    return (
        *sizes,
        simulation.steps,
        int(np.float64(model.opt.timestep).view(np.int64)),
        len(plugin_instances(model)),
    )

"""`Sweep`: many runs of one scene with other values, one row of results each."""

import dataclasses
import functools
import hashlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import BuoyancyError, SceneError, SceneTypeError, SweepError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.batches import run_simulations
from buoyancy_mj.scenes.frames import Summary
from buoyancy_mj.scenes.journal import Journal, read_parquet, write_parquet
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.simulation import Simulation

BATCH_SIZE = 64
"""Most runs in a batch: a sweep that is killed loses no more."""
_SUMMARY = tuple(
    field.name
    for field in dataclasses.fields(Summary)
    if field.name not in ("scene", "wall_time", "real_time_factor")
)
"""Fields of the summary that become columns."""


@dataclasses.dataclass(frozen=True)
class Sweep:
    """A scene, and the values of some of its fields in each run.

    Raises:
        SweepError: results of an unknown format, or a field that stands twice.
    """

    path: Path
    """The scene's file."""
    settings: tuple[str, ...]
    """Settings that all runs share, as for `--set`."""
    keys: tuple[str, ...]
    """Keys of the fields that vary."""
    values: tuple[tuple[float, ...], ...]
    """Values of these fields in each run."""
    out: Path
    """File of the results: .csv, or .parquet."""

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
        """Run what has not been run yet, batch by batch.

        Args:
            threads: number of threads that step at once; 0 for one per core.

        Yields:
            A row for each run, those of earlier sweeps first.

        Raises:
            SceneError: a key that the scene does not have.
            SweepError: the file of the results holds something else, or cannot be written.
        """
        # parquet cannot grow row by row: a journal stands beside it until all is done
        is_parquet = self.out.suffix == ".parquet"
        path = self.out.with_suffix(".partial.csv") if is_parquet else self.out
        finished = read_parquet(self.out) if is_parquet and not path.exists() else []
        journal = Journal(path, self._header, self._digest, finished)

        # rows of earlier sweeps, then new ones
        try:
            self._check_rows(path, journal.rows)
            self._check_keys()
            yield from journal.rows.values()
            missing = [run for run in range(len(self.values)) if run not in journal.rows]
            for start in range(0, len(missing), BATCH_SIZE):
                for row in self._run_batch(missing[start : start + BATCH_SIZE], threads):
                    journal.add(row)
                    journal.save()
                    yield journal.rows[int(row["run"])]
        finally:
            journal.close()

        # the whole table
        if is_parquet:
            rows = [journal.rows[run] for run in sorted(journal.rows)]
            write_parquet(self.out, rows, journal.header)
            path.unlink()

    @property
    def _header(self) -> list[str]:
        """Columns of the results."""
        summary = [name for name in _SUMMARY if name not in self.keys]
        return ["run", "scene", *self.keys, "status", "reason", *summary]

    @functools.cached_property
    def _digest(self) -> str:
        """A short text of all that the runs have in common."""
        scene = read_scene(self.path, self.settings)
        vehicle = catalog.model_path(scene.vehicle, scene.folder)
        common = repr((self.path.read_bytes(), vehicle.read_bytes(), self.settings, self.keys))
        return f"{self.path.stem} {hashlib.blake2b(common.encode(), digest_size=4).hexdigest()}"

    def _check_rows(self, path: Path, rows: Mapping[int, Mapping[str, str]]) -> None:
        """Refuse rows of runs that this sweep does not have, or has with other values."""
        for run, row in rows.items():
            values = tuple(float(row[key]) for key in self.keys)
            if run >= len(self.values) or values != self.values[run]:
                raise SweepError(
                    f"'{path}' holds runs with other values; give another --out, or remove it"
                )

    def _check_keys(self) -> None:
        """Refuse a key that the scene lacks, or that takes no numbers: every run would fail."""
        try:
            self._read_scene(0)
        except SceneTypeError:
            raise
        except SceneError:
            # other values may make sense
            return

    def _read_scene(self, run: int) -> Scene:
        """The scene with the values of one run."""
        varied = (
            f"{key}={value!r}" for key, value in zip(self.keys, self.values[run], strict=True)
        )
        return read_scene(self.path, [*self.settings, *varied])

    def _run_batch(self, runs: Sequence[int], threads: int) -> Iterator[dict[str, Any]]:
        """Run some runs to their ends; a row for each."""
        simulations: dict[int, Simulation] = {}
        for run in runs:
            try:
                simulations[run] = Simulation(self._read_scene(run))
            except BuoyancyError as error:
                yield self._row(run, reason=str(error))
        for run, reason in run_simulations(simulations, threads):
            yield self._row(run, simulations[run], reason)

    def _row(
        self, run: int, simulation: Simulation | None = None, reason: str = ""
    ) -> dict[str, Any]:
        """One row of the results."""
        row = {
            "run": run,
            "scene": self._digest,
            "status": "failed" if reason else "done",
            "reason": reason,
        }
        row |= dict(zip(self.keys, self.values[run], strict=True))
        results = dataclasses.asdict(simulation.summary()) if simulation and not reason else {}
        return row | {name: results.get(name) for name in _SUMMARY if name not in self.keys}

"""`Sweep`: many runs of one scene with other values, one row of results each."""

import dataclasses
import functools
import hashlib
import warnings
from collections.abc import Container, Iterator, Mapping
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import (
    BuoyancyError,
    BuoyancyWarning,
    SceneError,
    SceneTypeError,
    SweepError,
)
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.batches import run_simulations
from buoyancy_mj.scenes.journal import Journal, write_parquet
from buoyancy_mj.scenes.scene import Scene, read_scene
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.steering import check_trust
from buoyancy_mj.scenes.summary import list_values

BATCH_SIZE = 64
"""Most runs in a batch: a sweep that is killed loses no more."""
_NO_COLUMNS = ("scene", "wall_time", "real_time_factor")
"""Values of the summary that become no columns: a digest stands for the scene, and time varies."""
_OF_FILES = ("MuJoCo cannot read", "Error opening file", "ould not allocate")
"""Words of errors that have to do with files or memory, and not with the values of a run."""


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
    trust: bool = False
    """Whether to run the Python files that the scene names as controllers."""

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
            SceneError: a key that the scene does not have, or a controller that is not trusted.
            SweepError: the file of the results holds something else, another sweep is writing it,
                or it cannot be written; a file that a run needs cannot be read, or the memory runs
                out. What is done stays, and is not run again.
        """
        check_trust(read_scene(self.path, self.settings), trust=self.trust)

        # parquet cannot grow row by row: a journal stands beside it until all is done
        is_parquet = self.out.suffix == ".parquet"
        table = self.out.resolve() if self.out.is_symlink() else self.out
        path = table.with_suffix(".partial.csv") if is_parquet else self.out
        journal = Journal(path, self._header, self._digest, self.out if is_parquet else None)
        try:
            self._check_rows(path, journal.rows)
            self._check_keys()
            yield from journal.rows.values()
            for row in self._run_missing(journal.rows, threads):
                journal.add(row)
                yield journal.rows[int(row["run"])]

            # the whole table
            if is_parquet:
                rows = [journal.rows[run] for run in sorted(journal.rows)]
                write_parquet(self.out, rows, journal.header)
                path.unlink()
        except (MemoryError, _UntriedError) as error:
            reason = str(error) or "the memory ran out"
            raise SweepError(f"the sweep stopped: {reason}; {journal.state}") from error
        finally:
            journal.close()

    @property
    def _header(self) -> list[str]:
        """Columns of the results."""
        return ["run", "scene", *self.keys, "status", "reason", *self._results]

    @functools.cached_property
    def _results(self) -> list[str]:
        """Columns of the summary; a sweep with several vehicles has NAME.column for each."""
        vehicles = self._name_vehicles()
        controls = read_scene(self.path, self.settings).control
        steered = [control.vehicle or vehicles[0] for control in controls]
        names = list_values(vehicles, steered)
        return [name for name in names if name not in (*_NO_COLUMNS, *self.keys)]

    def _name_vehicles(self) -> list[str]:
        """Names of the vehicles, as in the first run that can be assembled."""
        names = [""]
        for run in range(len(self.values)):
            try:
                scene = self._read_scene(run)
                names = [str(entry.name) for entry in scene.entries]
                with warnings.catch_warnings():
                    # the run itself will give them
                    warnings.simplefilter("ignore", BuoyancyWarning)
                    return [group.name for group in assemble(scene).afloat]
            except BuoyancyError:
                # the row of that run will say why
                continue
        return names

    @functools.cached_property
    def _digest(self) -> str:
        """A short text of all that the runs have in common."""
        scene = read_scene(self.path, self.settings)
        models = [catalog.model_path(entry.model, scene.folder) for entry in scene.entries]
        controls = [path for control in scene.control for path in control.list_files(scene.folder)]
        read = [path for path in (self.path, *models, *controls) if path.is_file()]
        files = [path.read_bytes() for path in read]
        common = repr((*files, self.settings, self.keys))
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

    def _run_missing(self, done: Container[int], threads: int) -> Iterator[dict[str, Any]]:
        """Run what is not done, batch by batch; a row for each run."""
        missing = [run for run in range(len(self.values)) if run not in done]
        for start in range(0, len(missing), BATCH_SIZE):
            simulations: dict[int, Simulation] = {}
            for run in missing[start : start + BATCH_SIZE]:
                try:
                    simulations[run] = Simulation(self._read_scene(run), trust=self.trust)
                except BuoyancyError as error:
                    if not _is_of_values(error):
                        raise _UntriedError(str(error)) from error
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
            "reason": " ".join(reason.split()),
        }
        row |= dict(zip(self.keys, self.values[run], strict=True))
        results = simulation.summary().values() if simulation and not reason else {}
        return row | {name: results.get(name) for name in self._results}


class _UntriedError(Exception):
    """A run that could not be tried, whatever its values."""


def _is_of_values(error: BaseException) -> bool:
    """Whether an error may be due to the values of a run, and not to files or memory."""
    if isinstance(error, (OSError, MemoryError)) or any(words in str(error) for words in _OF_FILES):
        return False
    cause = error.__cause__
    return cause is None or _is_of_values(cause)

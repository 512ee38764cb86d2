"""`Sweep`: many runs of one scene with other values, one row of results each."""

import contextlib
import dataclasses
from collections.abc import Container, Iterator, Mapping, Sequence
from pathlib import Path

from buoyancy_mj.errors import SweepError
from buoyancy_mj.scenes import catalog, ranges
from buoyancy_mj.scenes.journal import Journal, write_parquet
from buoyancy_mj.scenes.places import LOCAL, find_place
from buoyancy_mj.scenes.variations import UntriedError, Values, vary


@dataclasses.dataclass(frozen=True)
class Sweep:
    """A scene, and the values of some of its fields in each run.

    Raises:
        SweepError: results of an unknown format, or a field that stands twice.

    Example:
        >>> plan = Sweep.over("auv_waves", ["mass=20:25:6"], "rows.csv")
        >>> drafts = [row["peak_draft"] for row in plan.run()]
    """

    path: Path
    """The scene's file."""
    settings: tuple[str, ...]
    """Settings that all runs share, as for `--set`."""
    keys: tuple[str, ...]
    """Keys of the fields that vary."""
    values: tuple[Values, ...]
    """Values of these fields in each run."""
    out: Path
    """File of the results: .csv, or .parquet."""
    trust: bool = False
    """Whether to run the Python files that the scene names as controllers."""
    measure: tuple[str, ...] = ()
    """Names of sensors whose numbers become columns, as 'gyro', or 'gyro.x'."""

    def __post_init__(self) -> None:
        if self.out.suffix not in (".csv", ".parquet"):
            raise SweepError(
                f"--out is '{self.out}'; results go to a file that ends in .csv or .parquet"
            )
        if len(set(self.keys)) < len(self.keys):
            raise SweepError(
                f"a field is given twice: {', '.join(self.keys)}; give each --over once"
            )

    @classmethod
    def over(
        cls,
        scene: str | Path,
        over: Sequence[str],
        out: str | Path,
        *,
        draws: int | None = None,
        seed: int = 0,
        settings: Sequence[str] = (),
        trust: bool = False,
        measure: Sequence[str] = (),
    ) -> "Sweep":
        """A sweep over a grid or random draws, as the command line has it.

        Args:
            scene: a scene file, or the name of a scene that ships.
            over: texts 'KEY=a:b:n', n values from a to b, 'KEY=v1,v2,v3', these, or 'KEY=a:b' for
                random draws.
            out: file of the results, .csv or .parquet.
            draws: number of random draws; None for a grid.
            seed: of the draws.
            settings: texts KEY=VALUE that all runs share.
            trust: whether to run the Python files that the scene names as controllers.
            measure: names of sensors whose numbers become columns.

        Raises:
            SceneError: there is no such scene.
            SweepError: a range, a number of runs or a file that makes no sense.
        """
        fields = [ranges.parse_range(text) for text in over]
        values = ranges.grid(fields) if draws is None else ranges.draws(fields, draws, seed)
        keys = tuple(field.key for field in fields)
        path = catalog.scene_path(str(scene))
        return cls(path, tuple(settings), keys, tuple(values), Path(out), trust, tuple(measure))

    def run(self, threads: int = 0, on: str = LOCAL) -> Iterator[dict[str, str]]:
        """Run what has not been run yet.

        Args:
            threads: number of threads that step at once; 0 for one per core.
            on: where: 'local', on the cores of this machine; 'ray', on the cluster of Ray that
                this process or machine belongs to, or else on one of this machine alone; or
                'ray://HOST:PORT', on that cluster. See `cluster.Cluster`.

        Yields:
            A row for each run, those of earlier sweeps first, then as they end.

        Raises:
            SceneError: a key that the scene does not have, a controller that is not trusted, or a
                sensor that is not there.
            SweepError: the file of the results holds something else, another sweep is writing it,
                or it cannot be written; there is no such place; a file that a run needs cannot be
                read, or the memory runs out. What is done stays, and is not run again.
        """
        place = find_place(on, threads)
        variations = vary(
            self.path,
            self.settings,
            self.keys,
            self.values,
            trust=self.trust,
            measure=self.measure,
        )

        # parquet cannot grow row by row: a journal stands beside it until all is done
        is_parquet = self.out.suffix == ".parquet"
        table = self.out.resolve() if self.out.is_symlink() else self.out
        path = table.with_suffix(".partial.csv") if is_parquet else self.out
        header, digest = variations.header, variations.digest
        journal = Journal(path, header, digest, self.out if is_parquet else None)
        try:
            self._check_rows(path, journal.rows)
            yield from journal.rows.values()
            missing = self._find_missing(journal.rows)
            if missing:
                with place() as work, contextlib.closing(work(variations, missing)) as done:
                    for rows in done:
                        journal.add(*rows)
                        yield from (journal.rows[int(row["run"])] for row in rows)

            # the whole table
            if is_parquet:
                ordered = [journal.rows[run] for run in sorted(journal.rows)]
                write_parquet(self.out, ordered, journal.header)
                path.unlink()
            else:
                journal.sort()
        except (MemoryError, UntriedError) as error:
            reason = str(error) or "the memory ran out"
            raise SweepError(f"the sweep stopped: {reason}; {journal.state}") from error
        finally:
            journal.close()

    def _check_rows(self, path: Path, rows: Mapping[int, Mapping[str, str]]) -> None:
        """Refuse rows of runs that this sweep does not have, or has with other values."""
        for run, row in rows.items():
            texts = [row[key] for key in self.keys]
            if run >= len(self.values) or not _are_equal(texts, self.values[run]):
                raise SweepError(
                    f"'{path}' holds runs with other values; give another --out, or remove it"
                )

    def _find_missing(self, done: Container[int]) -> dict[int, Values]:
        """The values of what is not done."""
        return {run: own for run, own in enumerate(self.values) if run not in done}


def _are_equal(texts: Sequence[str], values: Values) -> bool:
    """Whether the cells of a row are values."""
    return all(
        text == value if isinstance(value, str) else float(text) == value
        for text, value in zip(texts, values, strict=True)
    )

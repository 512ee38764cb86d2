"""Results of sweeps in files: a journal that outlasts a kill, and tables of parquet."""

import csv
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import SweepError


class Journal:
    """Rows of finished runs in a CSV file: written as they come, and read when a sweep goes on."""

    def __init__(
        self, path: Path, header: Sequence[str], scene: str, known: Sequence[Mapping[str, Any]] = ()
    ) -> None:
        """Open it, and read the runs that it holds.

        Args:
            path: of the file.
            header: its columns.
            scene: a digest of what does not.
            known: rows that a finished sweep has left elsewhere.

        Raises:
            SweepError: the file holds something else, or cannot be written.
        """
        self.header = list(header)
        self.rows: dict[int, dict[str, str]] = {}
        try:
            whole = path.read_bytes() if path.exists() else b""
            # a line that a kill broke off does not count
            complete = whole[: whole.rfind(b"\n") + 1]
            rows = csv.DictReader(complete.decode().splitlines())
            if complete or known:
                self._take(path, rows.fieldnames or known[0], [*rows, *known], scene)
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("r+" if path.exists() else "w", newline="")
            self._file.truncate(len(complete))
            self._file.seek(len(complete))
        except (OSError, UnicodeDecodeError) as error:
            raise SweepError(f"cannot keep results in '{path}': {error}") from error
        self._writer = csv.DictWriter(self._file, self.header)
        if not complete:
            self._writer.writeheader()
            for row in known:
                self._writer.writerow(row)

    def _take(
        self, path: Path, header: Iterable[str], rows: Sequence[Mapping[str, Any]], scene: str
    ) -> None:
        """Believe rows of earlier sweeps, if they are of this one."""
        if list(header) != self.header:
            raise SweepError(
                f"'{path}' holds other columns than this sweep has; give another --out, or remove it"
            )
        for row in rows:
            if row["scene"] != scene:
                raise SweepError(
                    f"'{path}' holds runs of another scene, or with other flags; give another --out, or remove it"
                )
            self.rows[int(row["run"])] = {
                key: "" if value is None else str(value) for key, value in row.items()
            }

    def add(self, row: Mapping[str, Any]) -> None:
        """Write one row."""
        plain = {key: "" if value is None else value for key, value in row.items()}
        self._writer.writerow(plain)
        self.rows[int(row["run"])] = {key: str(value) for key, value in plain.items()}

    def save(self) -> None:
        """See the rows onto the disk."""
        self._file.flush()
        os.fsync(self._file.fileno())

    def close(self) -> None:
        """No more rows."""
        self._file.close()


def read_parquet(path: Path) -> list[dict[str, Any]]:
    """The rows that a finished sweep has left, if there are any."""
    from pyarrow import ArrowException, parquet

    if not path.exists():
        return []
    try:
        rows: list[dict[str, Any]] = parquet.read_table(path).to_pylist()
    except (OSError, ArrowException) as error:
        raise SweepError(
            f"cannot read the results in '{path}': {error}; give another --out, or remove it"
        ) from error
    return rows


def write_parquet(path: Path, rows: Sequence[Mapping[str, str]], header: Sequence[str]) -> None:
    """All rows as a table, numbers as numbers."""
    import pyarrow as pa  # comes along with Rerun
    from pyarrow import parquet

    columns: dict[str, list[Any]] = {}
    for name in header:
        column: list[Any] = [row[name] for row in rows]
        if name not in ("scene", "status", "reason", "method"):
            column = [float(value) if value != "" else None for value in column]
        columns[name] = column
    part = path.with_suffix(".partial.parquet")
    parquet.write_table(pa.table(columns), part)
    part.replace(path)

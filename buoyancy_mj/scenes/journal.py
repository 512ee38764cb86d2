"""Results of sweeps in files: a journal of CSV that survives a kill, and tables of parquet."""

import contextlib
import csv
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import SweepError

_TEXT_COLUMNS = ("scene", "status", "reason", "method")
"""Columns that hold texts; all others hold numbers."""


class Journal:
    """Rows of finished runs in a CSV file, written as they come, and read when a sweep goes on.

    Args:
        path: the file.
        header: its columns.
        scene: a digest of what its runs have in common.
        finished: rows that a finished sweep has left elsewhere.

    Raises:
        SweepError: the file holds something else, or cannot be written.
    """

    def __init__(
        self,
        path: Path,
        header: Sequence[str],
        scene: str,
        finished: Sequence[Mapping[str, Any]] = (),
    ) -> None:
        self.header = list(header)
        """The columns."""
        self.rows: dict[int, dict[str, str]] = {}
        """Rows by the number of the run."""
        self._path = path
        if path.exists() and not path.is_file():
            raise SweepError(f"cannot keep results in '{path}': it is no file; give another --out")
        try:
            # a line that a kill broke off does not count
            content = path.read_bytes() if path.exists() else b""
            complete = content[: content.rfind(b"\n") + 1]
            rows = csv.DictReader(complete.decode().splitlines())
            if complete or finished:
                self._accept(path, rows.fieldnames or finished[0], [*rows, *finished], scene)

            # new rows go to the end of the complete lines
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open("r+" if path.exists() else "w", newline="")
            self._file.truncate(len(complete))
            self._file.seek(len(complete))
        except (OSError, ValueError, TypeError, csv.Error) as error:
            raise SweepError(f"cannot keep results in '{path}': {error}") from error
        self._writer = csv.DictWriter(self._file, self.header)
        if not complete:
            self._writer.writeheader()
            self._writer.writerows(finished)

    def add(self, row: Mapping[str, Any]) -> None:
        """Write one row."""
        texts = _as_texts(row)
        self._writer.writerow(texts)
        self.rows[int(row["run"])] = texts

    def save(self) -> None:
        """Force the rows onto the disk.

        Raises:
            SweepError: it is full, or gone; rows that were saved before stay.
        """
        try:
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            raise SweepError(
                f"cannot keep results in '{self._path}': {error.strerror}; rows up to here are in "
                "it, and the same command goes on from there"
            ) from error

    def close(self) -> None:
        """Close the file; what could not be saved was told before."""
        with contextlib.suppress(OSError):
            self._file.close()

    def _accept(
        self, path: Path, header: Iterable[str], rows: Iterable[Mapping[str, Any]], scene: str
    ) -> None:
        """Take rows of earlier sweeps, if they are of this one."""
        if list(header) != self.header:
            raise SweepError(
                f"'{path}' holds other columns than this sweep has; give another --out, "
                "or remove it"
            )
        for row in rows:
            if row["scene"] != scene:
                raise SweepError(
                    f"'{path}' holds runs of another scene, or with other flags; give another "
                    "--out, or remove it"
                )
            self.rows[int(row["run"])] = _as_texts(row)


def read_parquet(path: Path) -> list[dict[str, Any]]:
    """Read the rows that a finished sweep has left; none if there is no file.

    Raises:
        SweepError: the file cannot be read.
    """
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
    """Write all rows as a table, numbers as numbers.

    Raises:
        SweepError: the disk is full, or gone.
    """
    import pyarrow as pa  # comes along with Rerun
    from pyarrow import parquet

    columns: dict[str, list[Any]] = {}
    for name in header:
        texts = [row[name] for row in rows]
        if name in _TEXT_COLUMNS:
            columns[name] = [*texts]
        else:
            columns[name] = [float(text) if text != "" else None for text in texts]
    part = path.with_suffix(".partial.parquet")
    try:
        parquet.write_table(pa.table(columns), part)
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise SweepError(
            f"cannot write '{path}': {error}; all rows are kept, and the same command goes on"
        ) from error


def _as_texts(row: Mapping[str, Any]) -> dict[str, str]:
    """The cells of a row as they stand in CSV; None is empty."""
    return {key: "" if value is None else str(value) for key, value in row.items()}

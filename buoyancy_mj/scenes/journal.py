"""Results of sweeps in files: a journal of CSV that survives a kill, and tables of parquet."""

import contextlib
import csv
import io
import os
import stat
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from buoyancy_mj.errors import SweepError, describe
from buoyancy_mj.files import lock, replace_file

_TEXT_COLUMNS = ("scene", "status", "reason", "method")
"""Columns that hold texts; all others hold numbers."""


class Table(NamedTuple):
    """Rows of a file under its header."""

    header: Sequence[str]
    """The columns."""
    rows: Sequence[Mapping[str, Any]]
    """The rows."""


class Journal:
    """Rows of finished runs in a CSV file, written as they come, and read when a sweep goes on.

    While it is open, no other sweep writes the file.

    Args:
        path: the file.
        header: its columns.
        scene: a digest of what its runs have in common.
        table: a file of parquet that will hold the rows at the end, and may hold them already.

    Raises:
        SweepError: another sweep is writing the file, it holds something else, or it cannot be
            written.
    """

    def __init__(
        self, path: Path, header: Sequence[str], scene: str, table: Path | None = None
    ) -> None:
        self.path = path
        """The file."""
        self.header = list(header)
        """The columns."""
        self.rows: dict[int, dict[str, str]] = {}
        """Rows by the number of the run."""
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            # a name that nobody gave may be a link to anything
            self._file = _open_locked(path, follow=table is None)
        except BlockingIOError as error:
            raise SweepError(
                f"another sweep is writing '{path}'; wait for its end, or give another --out"
            ) from error
        except OSError as error:
            raise SweepError(
                f"cannot keep results in '{path}': {error.strerror}; give another --out"
            ) from error
        self._size = 0
        try:
            self._begin(scene, table)
        except BaseException:
            self.close()
            raise

    def add(self, *rows: Mapping[str, Any]) -> None:
        """Write rows, and force them onto the disk together.

        Raises:
            SweepError: there is no space for them; the rows before them stay.
        """
        texts = [_as_texts(row) for row in rows]
        self._write(b"".join(map(self._line, texts)))
        self.rows |= {int(row["run"]): row for row in texts}

    def sort(self) -> None:
        """Put the rows of the file into the order of the runs, for which nothing is risked."""
        if list(self.rows) == sorted(self.rows):
            return
        self.rows = {run: self.rows[run] for run in sorted(self.rows)}
        # the order is a courtesy: where no file can be made, the rows stay as they are
        with contextlib.suppress(OSError), replace_file(self.path) as part:
            part.write_bytes(self._line() + b"".join(map(self._line, self.rows.values())))

    @property
    def state(self) -> str:
        """Where the rows are and how the sweep goes on, for the end of a message."""
        if not self.rows:
            return "no run was done"
        rows = f"{len(self.rows)} row{'' if len(self.rows) == 1 else 's'}"
        return f"'{self.path}' holds {rows}, and the same command goes on from there"

    def close(self) -> None:
        """Close the file; it is removed if it has no rows."""
        with contextlib.suppress(OSError):
            if self._size == len(self._line()) or os.fstat(self._file.fileno()).st_size == 0:
                self.path.unlink()
        self._file.close()

    def _begin(self, scene: str, table: Path | None) -> None:
        """Take the rows of earlier sweeps, and cut off what a kill left of a last one."""
        try:
            content = self._file.readall()
            text = content.decode()
        except (OSError, UnicodeDecodeError) as error:
            raise SweepError(
                f"cannot read the results in '{self.path}': {error}; give another --out, "
                "or remove it"
            ) from error
        complete = text[: text.rfind("\n") + 1]
        if complete:
            reader = csv.DictReader(io.StringIO(complete, newline=""))
            self._accept(self.path, Table(reader.fieldnames or (), [*reader]), scene)
            self._size = len(complete.encode())
            self._cut()
        elif not self._line().startswith(content):
            self._refuse(self.path)
        else:
            finished = read_parquet(table) if table is not None else None
            if table is not None and finished is not None:
                self._accept(table, finished, scene)
            self._cut()
            self._write(self._line() + b"".join(map(self._line, self.rows.values())))

    def _accept(self, path: Path, table: Table, scene: str) -> None:
        """Take rows of earlier sweeps, if they are of this one."""
        if list(table.header) != self.header:
            self._refuse(path)
        for row in table.rows:
            if row["scene"] != scene:
                raise SweepError(
                    f"'{path}' holds runs of another scene, or with other flags; give another "
                    "--out, or remove it"
                )
            try:
                self.rows[int(row["run"])] = _as_texts(row)
            except (TypeError, ValueError):
                raise SweepError(
                    f"'{path}' holds a run {describe(row['run'])}, which is no number; "
                    "give another --out, or remove it"
                ) from None

    def _refuse(self, path: Path) -> None:
        raise SweepError(
            f"'{path}' holds other columns than this sweep has; give another --out, or remove it"
        )

    def _line(self, row: Mapping[str, str] | None = None) -> bytes:
        """A row as a line of CSV; the header for None."""
        text = io.StringIO(newline="")
        csv.writer(text).writerow([row[name] for name in self.header] if row else self.header)
        return text.getvalue().encode()

    def _write(self, content: bytes) -> None:
        """Append to the file and force it onto the disk; whole, or not at all."""
        rest = memoryview(content)
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
            os.fsync(self._file.fileno())
        except OSError as error:
            self._cut()
            raise SweepError(
                f"cannot write to '{self.path}': {error.strerror}; {self.state}"
            ) from error
        self._size += len(content)

    def _cut(self) -> None:
        """Cut off what stands behind the last whole line."""
        with contextlib.suppress(OSError):
            self._file.truncate(self._size)
            self._file.seek(self._size)


def read_parquet(path: Path) -> Table | None:
    """Read the rows that a finished sweep has left; None if there is no file.

    Raises:
        SweepError: the file cannot be read.
    """
    from pyarrow import ArrowException, parquet

    if not path.exists():
        return None
    if not path.is_file():
        raise SweepError(
            f"cannot keep results in '{path}': it is no regular file; give another --out"
        )
    try:
        table = parquet.read_table(path)
    except (OSError, ArrowException) as error:
        raise SweepError(
            f"cannot read the results in '{path}': {error}; give another --out, or remove it"
        ) from error
    return Table(table.column_names, table.to_pylist())


def write_parquet(path: Path, rows: Sequence[Mapping[str, str]], header: Sequence[str]) -> None:
    """Write all rows as a table, numbers as numbers.

    Raises:
        SweepError: it cannot be written; a file that was there stays.
    """
    import pyarrow as pa  # comes along with Rerun
    from pyarrow import parquet

    columns = {name: _read_column(name, [row[name] for row in rows]) for name in header}
    try:
        with replace_file(path) as part:
            parquet.write_table(pa.table(columns), part)
    except (OSError, pa.ArrowException) as error:
        raise SweepError(f"cannot write '{path}': {error}") from error


def read_row(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row as a file gives it back: numbers as floats, and None for an empty cell."""
    return {name: _read_cell(name, text) for name, text in _as_texts(row).items()}


def _read_column(name: str, texts: Sequence[str]) -> Sequence[str | float | None]:
    """What the cells of a column hold: numbers, or texts if one of them is none."""
    try:
        return [_read_cell(name, text) for text in texts]
    except ValueError:
        return texts


def _read_cell(name: str, text: str) -> str | float | None:
    """What a cell of a column holds."""
    if name in _TEXT_COLUMNS:
        return text
    return float(text) if text != "" else None


def _open_locked(path: Path, *, follow: bool) -> io.FileIO:
    """Open a file to read and write, made if there is none, and lock it.

    Args:
        path: the file.
        follow: whether it may be a link.
    """
    flags = os.O_RDWR | os.O_CREAT | (0 if follow else getattr(os, "O_NOFOLLOW", 0))
    while True:
        file = io.FileIO(os.open(path, flags, 0o666), "r+")
        try:
            lock(file.fileno(), path)
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise OSError(0, "it is no regular file")
            # the one who had it may just have removed it
            if path.exists() and os.path.samestat(path.stat(), os.fstat(file.fileno())):
                return file
        except BaseException:
            file.close()
            raise
        file.close()


def _as_texts(row: Mapping[str, Any]) -> dict[str, str]:
    """The cells of a row as they stand in CSV; None is empty."""
    return {key: "" if value is None else str(value) for key, value in row.items()}

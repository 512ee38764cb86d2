"""`SeriesFile`: rows of numbers in a file of CSV or parquet, which survive whatever ends them.

Parquet cannot grow row by row: it is made at the end of the CSV that grows in its place.
"""

import contextlib
import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.files import replace_file
from buoyancy_mj.scenes.recording_file import RecordingFile

ENDS = (".csv", ".parquet")
"""Ends of names that say what kind of table a file is."""

BLOCK = 1 << 25
"""Bytes of CSV that become one group of rows in parquet."""


class Column(NamedTuple):
    """A column of numbers."""

    name: str
    """What it is called."""
    unit: str
    """The unit of its numbers; '' for none."""

    @property
    def header(self) -> str:
        """Its name with its unit: 'depth [m]'."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


class SeriesFile:
    """A table of numbers that grows row by row.

    It grows as CSV under the name `NAME.partial.csv`, or `NAME.partial-2.csv` and so on where that
    exists, and takes its own when it is whole: a file which was there is replaced at once or not at
    all.

    Args:
        path: the file, whose name ends in .csv or .parquet.
        columns: its columns.

    Raises:
        RecordingError: the name ends otherwise, or the file cannot be made.
    """

    def __init__(self, path: Path, columns: Sequence[Column]) -> None:
        check_series_name(path)
        self._columns = columns
        self._file = RecordingFile(path, "for the series", grows_as=".csv")
        self._append(column.header for column in columns)

    @property
    def closed(self) -> bool:
        """Whether the file has its name already."""
        return self._file.closed

    def add(self, row: NDArray[np.float64]) -> None:
        """Add a row with a number for each column; NaN is written as nan.

        Raises:
            RecordingError: the disk is full or gone; the file ends with its last whole row.
        """
        self._append(map(repr, row.tolist()))

    def close(self, *, complete: bool) -> Path:
        """Give the file its name.

        An incomplete table keeps the name under which it grew if there is a file of its own.

        Args:
            complete: whether all rows are in it.

        Returns:
            Where the file is.

        Raises:
            RecordingError: it cannot take its name.
        """
        self._file.close()
        path, partial = self._file.path, self._file.partial
        if path.suffix == ".csv" or (path.exists() and not complete):
            return self._file.take_name(complete=complete)
        try:
            self._write_parquet()
        except OSError as error:
            raise RecordingError(
                f"cannot write '{path}': {error.strerror}; what was written is in '{partial}'"
            ) from error
        partial.unlink(missing_ok=True)
        return path

    def discard(self) -> None:
        """Remove the file of a run that never began."""
        self._file.discard()

    def _append(self, cells: Iterable[str]) -> None:
        """Append a row of CSV."""
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerow(cells)
        try:
            self._file.append(text.getvalue().encode())
        except OSError as error:
            self._file.close()
            left = self._file.partial
            if self._file.path.suffix == ".csv":
                with contextlib.suppress(RecordingError):
                    left = self._file.take_name(complete=False)
            raise RecordingError(
                f"the series broke off: {error.strerror}; what was written is in '{left}'"
            ) from error

    def _write_parquet(self) -> None:
        """Write the rows of the CSV as parquet, batch by batch.

        Raises:
            OSError: it cannot be written; a file that was there stays.
        """
        import pyarrow as pa  # comes along with Rerun
        from pyarrow import csv as arrow_csv
        from pyarrow import parquet

        headers = [column.header for column in self._columns]
        schema = pa.schema(
            [
                pa.field(column.header, pa.float64(), metadata={"unit": column.unit})
                for column in self._columns
            ]
        )
        try:
            with (
                arrow_csv.open_csv(
                    self._file.partial,
                    read_options=arrow_csv.ReadOptions(block_size=BLOCK),
                    parse_options=arrow_csv.ParseOptions(newlines_in_values=True),
                    convert_options=arrow_csv.ConvertOptions(
                        column_types=dict.fromkeys(headers, pa.float64()), null_values=[]
                    ),
                ) as rows,
                replace_file(self._file.path) as part,
                parquet.ParquetWriter(part, schema) as writer,
            ):
                for batch in rows:
                    writer.write_batch(pa.record_batch(batch.columns, schema=schema))
        except pa.ArrowException as error:
            raise OSError(0, str(error), str(self._file.path)) from error


def check_series_name(path: Path) -> None:
    """Check that the name of a series says what kind of table it is.

    Raises:
        RecordingError: it ends otherwise than in .csv or .parquet.
    """
    if path.suffix not in ENDS:
        raise RecordingError(
            f"the series is '{path}'; the name of a series ends in {' or '.join(ENDS)}"
        )

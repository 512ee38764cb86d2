"""`McapFile`: an MCAP file that grows under another name, and tells what kept it from growing."""

import os
import warnings
from pathlib import Path
from typing import Any

import foxglove
from foxglove.mcap import MCAPCompression, MCAPWriteOptions

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.files import GrowingFile
from buoyancy_mj.scenes.recording_file import RecordingFile


class McapFile:
    """An MCAP file that grows, and the writer that fills it."""

    def __init__(self, path: Path, context: foxglove.Context) -> None:
        self._file = RecordingFile(path, "(--mcap)")
        self._pipe = _Pipe(self._file)
        options = MCAPWriteOptions(
            compression=MCAPCompression.Zstd,
            compression_threads=0,
            profile="ros2",
            disable_seeking=True,
        )
        self._writer = foxglove.open_mcap(self._pipe, context=context, writer_options=options)

    def flush(self) -> OSError | None:
        """Write what has been told so far; what kept it from being written."""
        return self._try(self._writer.flush)

    def keep(self, values: dict[str, str]) -> None:
        """Keep texts by name."""
        self._try(lambda: self._writer.write_metadata("summary", values))

    def finish(self) -> OSError | None:
        """Write the end of the file; what kept it from being written."""
        return self._try(self._writer.close)

    def take_name(self, *, complete: bool) -> Path:
        """Close the file and give it its name."""
        self._file.close()
        return self._file.take_name(complete=complete)

    def discard(self) -> None:
        """Remove the file of a run that never began."""
        self._try(self._writer.close)
        self._file.discard()

    def _try(self, write: Any) -> OSError | None:
        """Write; the first error of the file, which the writer hides."""
        try:
            write()
        except Exception as error:
            if self._pipe.error is None:
                warnings.warn(f"the MCAP file: {error}", BuoyancyWarning, stacklevel=3)
        return self._pipe.error


class _Pipe:
    """What the writer takes for a file: it only appends."""

    def __init__(self, file: GrowingFile) -> None:
        self.error: OSError | None = None
        """The first error."""
        self._file = file

    def write(self, data: bytes | bytearray) -> int:
        """Append."""
        if self.error is None:
            try:
                self._file.append(memoryview(data))
            except OSError as error:
                self.error = error
        return len(data)

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        """Say where the end is; nothing else is asked for."""
        del offset, whence
        return self._file.size

    def flush(self) -> None:
        """Nothing waits."""

"""An .rrd file that grows message by message and survives whatever ends it.

Rerun's own file sink waits for ever on a full disk, so the bytes of its stream are written here. In
Rerun's format each read of a stream is a header of 12 bytes, then messages, then an end. A message
is its kind and its length (two little-endian 64-bit integers) and that many bytes; the end is a
message of kind 0 and a footer. One file is one header and all the messages; `rerun rrd optimize`
adds the footer and packs the frames together.

A run has a layout from its start on, and at its end a better one, which then takes the place of the
first: the viewer shows the first that it reads.
"""

import contextlib
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import rerun as rr

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.scenes.recording_file import RecordingFile

_HEADER_SIZE = 12
_MESSAGE = struct.Struct("<QQ")
"""Kind and length of a message."""
_BLOCK = 1 << 20
"""Bytes that are copied at once."""
_END = 0
"""Kind of the message that ends a read."""


class RrdFile:
    """What a stream logs, in a file.

    It grows under the name `NAME.partial.rrd`, or `NAME.partial-2.rrd` and so on where that exists,
    and takes its own when it is whole: a file which was there is replaced at once or not at all.

    Args:
        path: the file.
        stream: logs what the file holds, from now on.

    Raises:
        RecordingError: the file cannot be made, or another run is writing it.
    """

    def __init__(self, path: Path, stream: rr.RecordingStream) -> None:
        self._file = RecordingFile(path, "(--record)")
        self._stream = stream.binary_stream()
        self._layouts: list[slice] = []

    @property
    def closed(self) -> bool:
        """Whether the file has its name already, or was discarded."""
        return self._file.closed

    def write(self) -> None:
        """Append what has been logged since the last call.

        Raises:
            RecordingError: the disk is full or gone; the file ends with its last whole message.
        """
        chunk = self._stream.read() or b""
        try:
            for message in _split(chunk, with_header=self._file.size == 0):
                self._file.append(message)
        except OSError as error:
            path = self.close(complete=False)
            raise RecordingError(
                f"the recording broke off: {error.strerror}; what was written is in '{path}'"
            ) from error

    def write_layout(self) -> None:
        """Append a layout, which is all that has been logged since `write` was called.

        Raises:
            RecordingError: as for `write`.
        """
        start = self._file.size
        self.write()
        self._layouts.append(slice(start, self._file.size))

    def close(self, *, complete: bool) -> Path:
        """Add the footer, and give the file its name.

        An incomplete recording keeps the name `NAME.partial.rrd` if there is a file `NAME.rrd`.

        Args:
            complete: whether all that should be in the file is in it.

        Returns:
            Where the file is.

        Raises:
            RecordingError: it cannot take its name.
        """
        self._file.close()
        try:
            _add_footer(self._file.partial, self._layouts)
        finally:
            # also when a second Ctrl-C finds that a footer takes too long
            left = self._file.take_name(complete=complete)
        return left

    def discard(self) -> None:
        """Remove the file of a recording that never began."""
        self._file.discard()


def _split(chunk: bytes, *, with_header: bool) -> Iterator[memoryview]:
    """Split one read of a stream into its messages, without its end, after its header if asked."""
    if not chunk:
        return
    view = memoryview(chunk)
    if with_header:
        yield view[:_HEADER_SIZE]
    start = _HEADER_SIZE
    while True:
        kind, length = _MESSAGE.unpack_from(chunk, start)
        if kind == _END:
            return
        end = start + _MESSAGE.size + length
        yield view[start:end]
        start = end


def _add_footer(path: Path, layouts: Sequence[slice]) -> None:
    """Add the footer, and leave the last layout alone.

    A file for which there is no space stays without, and still opens.
    """
    path = path.absolute()
    with (
        contextlib.suppress(OSError, subprocess.CalledProcessError),
        tempfile.TemporaryDirectory(prefix=".", dir=path.parent) as folder,
    ):
        ordered, whole = Path(folder, "ordered.rrd"), Path(folder, "whole.rrd")
        _keep_last_layout(path, layouts, ordered)
        # in an empty folder: Python imports nothing from where the user works; the command alone,
        # without the whole of rerun, which takes half a second to import
        subprocess.run(
            [sys.executable, "-P", "-m", "rerun_cli", "rrd", "optimize", ordered, "-o", whole],
            cwd=folder, capture_output=True, check=True, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        shutil.copymode(path, whole)
        os.replace(whole, path)


def _keep_last_layout(path: Path, layouts: Sequence[slice], out: Path) -> None:
    """Copy a file with the last of its layouts in the place of the first, without the others."""
    size = path.stat().st_size
    kept = [slice(0, size)]
    if layouts:
        begins, ends = [one.stop for one in layouts], [one.start for one in layouts[1:]]
        kept = [slice(0, layouts[0].start), layouts[-1], *map(slice, begins, [*ends, size])]
    with path.open("rb") as source, out.open("wb") as target:
        for part in kept:
            source.seek(part.start)
            left = part.stop - part.start
            while left > 0:
                left -= target.write(source.read(min(left, _BLOCK)))

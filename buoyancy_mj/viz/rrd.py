"""An .rrd file that grows message by message, survives whatever ends it, and is made whole at the end.

Rerun's own file sink waits for ever on a full disk, so the bytes of its stream are written here. In
Rerun's format each read of a stream is a header of 12 bytes, then messages of a kind and a length
(two little-endian 64-bit integers) and that many bytes, then one of kind 0 and a footer. One file is
one header and all the messages; `rerun rrd optimize` adds the footer and packs the frames together.
"""

import os
import struct
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import rerun as rr

from buoyancy_mj.errors import RecordingError

_HEADER, _MESSAGE, _END = 12, struct.Struct("<QQ"), 0


class RrdFile:
    """What a stream logs, in a file; `follow` says which stream.

    It grows under the name `NAME.partial.rrd` and takes its own when it is whole, so that a file
    which was there is replaced at once or not at all.

    Raises:
        RecordingError: the file cannot be made, or another run is writing it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.growing = path.with_name(f"{path.stem}.partial.rrd")
        self._written = 0
        if path.is_dir():
            raise RecordingError(
                f"cannot write '{path}': it is a folder; choose another place (--record)"
            )
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._descriptor = os.open(self.growing, os.O_WRONLY | os.O_CREAT, 0o644)
        except OSError as error:
            raise RecordingError(
                f"cannot write '{self.growing}': {error.strerror}; choose another place (--record)"
            ) from error
        _claim(self._descriptor, self.growing)
        os.ftruncate(self._descriptor, 0)
        self.closed = False

    def follow(self, stream: rr.RecordingStream) -> None:
        """Take what `stream` logs from now on."""
        self._stream = stream.binary_stream()

    def write(self) -> None:
        """Append what has been logged since the last call.

        Raises:
            RecordingError: the disk is full or gone; the file ends with its last whole message.
        """
        chunk = self._stream.read() or b""
        try:
            for message in _messages(chunk, first=self._written == 0):
                rest = message
                while rest:
                    rest = rest[os.write(self._descriptor, rest) :]
                self._written += len(message)
        except OSError as error:
            os.ftruncate(self._descriptor, self._written)
            path = self.close(complete=False)
            raise RecordingError(
                f"the recording broke off: {error.strerror}; what was written is in '{path}'"
            ) from error

    def close(self, *, complete: bool) -> Path:
        """Make the file whole and give it its name, unless it is a piece and a whole one is there.

        Returns:
            Where it lies.

        Raises:
            RecordingError: it cannot take its name.
        """
        os.close(self._descriptor)
        self.closed = True
        _make_whole(self.growing)
        if not complete and self.path.exists():
            return self.growing
        try:
            os.replace(self.growing, self.path)
        except OSError as error:
            raise RecordingError(
                f"cannot write '{self.path}': {error.strerror}; the recording is in '{self.growing}'"
            ) from error
        return self.path

    def discard(self) -> None:
        """Remove the file, for a recording that never began."""
        os.close(self._descriptor)
        self.closed = True
        self.growing.unlink(missing_ok=True)


def _claim(descriptor: int, path: Path) -> None:
    """Keep other runs from writing the same file, where the system knows locks."""
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        os.close(descriptor)
        raise RecordingError(
            f"another run is writing '{path}'; choose another place (--record)"
        ) from error


def _messages(chunk: bytes, *, first: bool) -> Iterator[memoryview]:
    """The messages of one read, without its end; its header is one too if it is the first."""
    if not chunk:
        return
    if first:
        yield memoryview(chunk)[:_HEADER]
    place = _HEADER
    while True:
        kind, length = _MESSAGE.unpack_from(chunk, place)
        if kind == _END:
            return
        following = place + _MESSAGE.size + length
        yield memoryview(chunk)[place:following]
        place = following


def _make_whole(path: Path) -> None:
    """Give the file its footer; where that fails, for want of space, it stays as it is and can still be opened."""
    whole = path.with_name(f"{path.stem}.whole.rrd")
    command = [sys.executable, "-m", "rerun", "rrd", "optimize", str(path), "-o", str(whole)]
    done = subprocess.run(command, capture_output=True, check=False)
    if done.returncode == 0 and whole.is_file():
        os.replace(whole, path)
    else:
        whole.unlink(missing_ok=True)

"""`FilmFile`: pictures in a film that grows, survives whatever ends it, and goes on where it ended.

It grows as H.264 in Matroska, which plays wherever it breaks off.
"""

import contextlib
import glob
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
from av.bitstream import BitStreamFilterContext
from numpy.typing import NDArray

from buoyancy_mj.drawing.film_kinds import KINDS, Kind
from buoyancy_mj.errors import RecordingError, choices
from buoyancy_mj.files import require_unlocked
from buoyancy_mj.scenes.recording_file import RecordingFile

HEAD = 4096
"""Bytes at the beginning of a film that hold its mark."""
GROWS_AS = ".mkv"
"""End of the name under which a film grows."""
OPTIONS = {
    # no picture depends on a later one, so that none is lost where the film breaks off
    "bf": "0",
    "preset": "medium",
    "x264-params": "rc-lookahead=8",
}


class FilmFile:
    """A film that grows picture by picture.

    It grows under the name `NAME.partial.mkv`, or `NAME.partial-2.mkv` and so on where that exists,
    and takes its own when it is whole. A film of the same mark that was not finished is gone on
    with: `kept` says how many pictures it has.

    Args:
        path: the file, whose name ends in .mp4, .gif or .webp.
        size: width and height of a picture [pixels].
        fps: pictures in a second.
        mark: what tells this film from others of that name.

    Raises:
        RecordingError: the name ends otherwise, the size or the rate is not that of such a film,
            another run is writing it, or the file cannot be made.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: int, mark: str) -> None:
        self._kind = find_kind(path, size, fps)
        self._fps = fps
        # pictures of one encoder are no pictures of another
        mark = f"{self._kind.codec} {mark}"
        self._file = RecordingFile(path, "(--video)", grows_as=GROWS_AS)
        self.count = 0
        """Number of its pictures."""
        self.kept = 0
        """How many of them an earlier run has drawn."""
        writer = _Writer(self._file)
        # short clusters, written at once
        options = {"cluster_time_limit": "250", "flush_packets": "1"}
        self._container = av.open(writer, "w", format="matroska", options=options)
        self._container.metadata["comment"] = mark
        self._stream: Any = self._container.add_stream(
            self._kind.codec, rate=fps, options=OPTIONS | {"crf": self._kind.quality}
        )
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = self._kind.pixels
        self._stream.time_base = self._stream.codec_context.time_base = Fraction(1, fps)
        self._stream.codec_context.open()
        try:
            self._keep(mark)
        except BaseException:
            self.discard()
            raise

    @property
    def closed(self) -> bool:
        """Whether the file has its name already, or keeps the one under which it grew."""
        return self._file.closed

    def add(self, pixels: NDArray[np.uint8]) -> None:
        """Add a picture (height, width, 3).

        Raises:
            RecordingError: the disk is full or gone; the film so far plays.
        """
        frame = av.VideoFrame.from_ndarray(np.ascontiguousarray(pixels), format="rgb24")
        frame.pts, frame.time_base = self.count, Fraction(1, self._fps)
        self._write(self._stream.encode(frame))
        self.count += 1

    def close(self, *, complete: bool) -> Path:
        """Finish the film, and say where it is.

        Args:
            complete: whether all pictures are in it. Otherwise it keeps the name under which it
                grew, and the next film of its mark goes on with it.

        Raises:
            RecordingError: it cannot be written to its end, or cannot take its name.
        """
        try:
            self._write(self._stream.encode())
            with self._tell_full():
                self._container.close()
        finally:
            self._file.close()
        if not complete:
            return self._file.partial
        try:
            self._kind.finish(self._file.partial, self._file.path, self._fps)
        except OSError as error:
            raise RecordingError(
                f"cannot write '{self._file.path}': {error.strerror or error}; the film is in "
                f"'{self._file.partial}'"
            ) from error
        self._file.partial.unlink(missing_ok=True)
        return self._file.path

    def discard(self) -> None:
        """Remove the file of a film that never began; what an earlier run has drawn stays."""
        if self.kept:
            with contextlib.suppress(RecordingError):
                self.close(complete=False)
            return
        self._file.discard()
        self._release()

    def _release(self) -> None:
        """Free the encoder of a file that takes no more; Python would do so in any order."""
        with contextlib.suppress(OSError, av.FFmpegError):
            self._container.close()

    def _write(self, packets: list[Any]) -> None:
        """Write what the encoder has finished."""
        with self._tell_full():
            for packet in packets:
                self._container.mux(packet)

    @contextlib.contextmanager
    def _tell_full(self) -> Iterator[None]:
        """Tell of a disk that takes no more."""
        try:
            yield
        except OSError as error:
            self._file.close()
            self._release()
            raise RecordingError(
                f"the film ends after {self.count / self._fps:.2f} s: {error.strerror or error}; "
                f"what there is plays, '{self._file.partial}'; make room, and the same command "
                "goes on with it"
            ) from error

    def _keep(self, mark: str) -> None:
        """Take over the longest film of the same mark that was not finished."""
        mine = self._file.partial
        stem = glob.escape(self._file.path.stem)
        others = [one for one in mine.parent.glob(f"{stem}.partial*{GROWS_AS}") if one != mine]
        for one in others:
            _require_left(one)
        others = [one for one in others if _has_mark(one, mark)]
        films = {one: list(_read_packets(one)) for one in others}
        best = max(films.values(), key=len, default=[])
        for packet in best:
            packet.stream = self._stream
            packet.pts = packet.dts = self.count
            packet.time_base, packet.duration = Fraction(1, self._fps), 1
            self._write([packet])
            self.count += 1
        self.kept = self.count
        for one in others:
            one.unlink(missing_ok=True)


class _Writer:
    """A file as PyAV writes to it: forward only."""

    def __init__(self, file: RecordingFile) -> None:
        self._file = file

    def write(self, piece: bytes) -> int:
        """Append a piece, if the file takes more."""
        if not self._file.closed:
            self._file.append(piece)
        return len(piece)


def find_kind(path: Path, size: tuple[int, int], fps: int) -> Kind:
    """What kind of film a name means.

    Raises:
        RecordingError: none, or one that has no such size or rate.
    """
    kind = KINDS.get(path.suffix)
    if kind is None:
        raise RecordingError(
            f"the film is '{path}', and its name does not end as a film's; "
            f"{choices(path.suffix, KINDS)}"
        )
    kind.check(path, size, fps)
    return kind


def _require_left(path: Path) -> None:
    """Check that no other run is writing a film."""
    try:
        require_unlocked(path)
    except BlockingIOError as error:
        raise RecordingError(
            f"another run is writing '{path}'; choose another place (--video)"
        ) from error


def _has_mark(path: Path, mark: str) -> bool:
    """Whether a file, however short, is a film of a mark."""
    try:
        with path.open("rb") as file:
            return mark.encode() in file.read(HEAD)
    except OSError:
        return False


def _read_packets(path: Path) -> Iterator[Any]:
    """The whole pictures of a film, still encoded, up to where it breaks off."""
    with contextlib.suppress(OSError, av.FFmpegError), av.open(path) as film:
        # as the encoder gives them
        unpack = BitStreamFilterContext("h264_mp4toannexb", film.streams.video[0])
        for packet in film.demux(video=0):
            # the last one is empty
            if packet.size:
                yield from unpack.filter(packet)

"""`Film` and `Still`: pictures of a run as files."""

import errno
import hashlib
import math
import os
import tempfile
from pathlib import Path

import mujoco
import numpy as np

from buoyancy_mj.drawing.pictures import MISSING, Pictures
from buoyancy_mj.errors import RecordingError
from buoyancy_mj.files import replace_file
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.values import read_whole_number

FPS = 30
"""Pictures in a second, if not told otherwise."""
RATES = (1, 240)
"""Least and most pictures in a second of a film."""


class Film:
    """The frames of a run as a film in real time.

    A film that broke off is gone on with by the next one of the same run, pictures and name: it
    draws only what is not there.

    Args:
        run: the run.
        pictures: what is to be seen of it.
        path: the film, whose name ends in .mp4, .gif or .webp.
        fps: pictures in a second; between frames that are further apart, pictures repeat.

    Raises:
        RecordingError: the encoder is not installed, there is no such film, or the file cannot be
            made.
    """

    def __init__(self, run: Run, pictures: Pictures, path: Path, fps: int = FPS) -> None:
        self._fps = read_whole_number(RecordingError, "fps", fps, *RATES)
        self._pictures = pictures
        self._begin: float | None = None
        try:
            from buoyancy_mj.drawing.film_file import FilmFile
        except ModuleNotFoundError as error:
            raise RecordingError(MISSING.format("a film", error.name)) from error
        self._file = FilmFile(path, pictures.size, fps, _mark(run, pictures, fps))
        self.kept = self._file.kept / fps
        """Time that an earlier run has drawn already [s]."""

    @property
    def closed(self) -> bool:
        """Whether the file has its name already."""
        return self._file.closed

    def add(self, frame: Frame) -> None:
        """Add a frame, if its picture is due.

        Raises:
            RecordingError: the disk is full or gone; the film so far plays.
        """
        self._pictures.follow(frame)
        if self._begin is None:
            self._begin = frame.time
        # the small part forgives the rounding of time * fps
        count = math.floor((frame.time - self._begin) * self._fps + 1e-6) + 1
        if count > self._file.count:
            pixels = self._pictures.draw(frame)
            while self._file.count < count:
                self._file.add(pixels)

    def close(self, *, complete: bool = True) -> Path:
        """Finish the film, and say where it is; see `FilmFile.close`."""
        return self._file.close(complete=complete)

    def discard(self) -> None:
        """Remove the file of a run that never began."""
        self._file.discard()


class Still:
    """One frame of a run as a picture.

    Args:
        pictures: what is to be seen of it.
        path: the picture, whose name ends in .png.
        at: time of the frame [s]; the first that is not before it is taken. None for the last.

    Raises:
        RecordingError: the name ends otherwise, what writes it is not installed, or it cannot be
            written there.
    """

    def __init__(self, pictures: Pictures, path: Path, at: float | None = None) -> None:
        if path.suffix != ".png":
            raise RecordingError(f"the picture is '{path}'; its name ends in .png")
        try:
            from PIL import Image
        except ModuleNotFoundError as error:
            raise RecordingError(MISSING.format("a picture", error.name)) from error
        # at once, and not after the run
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=path.parent):
                if path.is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        except OSError as error:
            raise self._refusal(path, error) from error
        self._from_pixels = Image.fromarray
        self._pictures, self._path, self._at = pictures, path, at
        self._last: Frame | None = None
        self.closed = False
        """Whether the picture is there."""

    def add(self, frame: Frame) -> None:
        """Take the frame, if it is the one.

        Raises:
            RecordingError: the picture cannot be written.
        """
        self._pictures.follow(frame)
        self._last = frame
        if self._at is not None and frame.time >= self._at - 1e-9:
            self.close()

    def close(self) -> Path:
        """Write the picture, of the last frame if none was the one, and say where it is.

        Raises:
            RecordingError: it cannot be written.
        """
        if self.closed or self._last is None:
            return self._path
        self.closed = True
        pixels = self._pictures.draw(self._last)
        try:
            with replace_file(self._path) as part:
                self._from_pixels(pixels).save(part)
        except OSError as error:
            raise self._refusal(self._path, error) from error
        return self._path

    @staticmethod
    def _refusal(path: Path, error: OSError) -> RecordingError:
        """What to say of a place where no picture can be written."""
        return RecordingError(
            f"cannot write '{path}': {error.strerror or error}; choose another place (--screenshot)"
        )


def _mark(run: Run, pictures: Pictures, fps: int) -> str:
    """A checksum of all that the pictures of a film depend on."""
    model = np.empty(mujoco.mj_sizeModel(run.model), np.uint8)
    mujoco.mj_saveModel(run.model, None, model)
    state = run.data.qpos.tobytes() + run.data.qvel.tobytes()
    text = f"{run.text}\n{run.buoyancy.settings!r}\n{pictures.name}\n{fps}"
    return hashlib.sha256(model.tobytes() + state + text.encode()).hexdigest()

"""`Pictures`: what a camera sees of a run, frame by frame."""

import dataclasses
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.cameras import FOLLOW, find_camera
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.renderers import open_frames
from buoyancy_mj.drawing.sea_state import describe_sea
from buoyancy_mj.drawing.shots import Shot
from buoyancy_mj.drawing.subject import Subject
from buoyancy_mj.errors import DrawingError, RecordingError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run, place_at_start
from buoyancy_mj.values import read_whole_number

if TYPE_CHECKING:
    from buoyancy_mj.drawing.hud import Hud

MISSING = "{} needs {}, which is not installed: pip install 'buoyancy_mj[video]'"
"""The message for a library that the extra `video` brings."""

SIZE = (1280, 720)
"""Width and height of a picture [pixels], if not told otherwise."""
SIZES = (16, 8192)
"""Least and greatest width and height [pixels]."""


class Pictures:
    """Pictures of a run.

    Args:
        run: the run.
        camera: 'follow', 'orbit', 'under', or the name of a camera of the model.
        size: width and height [pixels].
        renderer: 'filament' or 'classic'; None for Filament where it can draw.
        has_hud: whether time, sea and scale are written over them.
        look: colours and brightness of sea and sky. Its sun turns with the first vehicle, so that
            it lights what the camera sees.

    Raises:
        DrawingError: no such camera, renderer or size, or nothing can draw here.
        RecordingError: what writes over pictures is not installed.
    """

    def __init__(
        self,
        run: Run,
        *,
        camera: str = FOLLOW,
        size: tuple[int, int] = SIZE,
        renderer: str | None = None,
        has_hud: bool = True,
        look: Look = DAYLIGHT,
    ) -> None:
        for what, side in zip(("width", "height"), size, strict=True):
            read_whole_number(DrawingError, f"the {what}", side, *SIZES)
        self.size = size
        """Width and height [pixels]."""
        self.name = f"{camera} {size} {renderer} {has_hud} {look}"
        """What they are pictures of, beside the run."""
        start, water = place_at_start(run), run.buoyancy.water
        self._subject = Subject(run.model, run.vehicles.values(), start)
        aspect = size[0] / size[1]
        self._camera = find_camera(camera, run.model, self._subject, water, aspect)
        radius = max(self._subject.measure(start))
        look = dataclasses.replace(look, sun_azimuth=look.sun_azimuth + self._subject.heading)
        self._frames = open_frames(renderer, run.model, water, radius, size, look)
        self._hud: Hud | None = None
        if has_hud:
            self._hud = _make_hud(size, describe_sea(water))
        self._shot: Shot | None = None
        self._time = -np.inf

    def follow(self, frame: Frame) -> Shot:
        """Let the camera see a frame, and all frames in their order: it moves without haste."""
        if self._shot is None or frame.time != self._time:
            self._shot, self._time = self._camera.aim(frame.data), frame.time
        return self._shot

    def draw(self, frame: Frame) -> NDArray[np.uint8]:
        """The picture (height, width, 3) of a frame."""
        shot = self.follow(frame)
        pixels = self._frames.draw(frame.data, shot, self._subject.locate(frame.data))
        if self._hud is None:
            return pixels
        pixel = 2.0 * shot.subject * np.tan(0.5 * shot.fovy) / self.size[1]
        return self._hud.write(pixels, frame.time, pixel)


def _make_hud(size: tuple[int, int], sea: str) -> "Hud":
    """What is written over pictures, which needs Pillow."""
    try:
        from buoyancy_mj.drawing.hud import Hud
    except ModuleNotFoundError as error:
        raise RecordingError(MISSING.format("a text over pictures", error.name)) from error
    return Hud(size, sea)

"""Flags that film a run, and what they make."""

import dataclasses
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from buoyancy_mj.errors import SceneError
from buoyancy_mj.scenes.simulation import Simulation

if TYPE_CHECKING:
    from buoyancy_mj.drawing.film import Film, Still


@dataclasses.dataclass(frozen=True, kw_only=True)
class FilmFlags:
    """How a run is filmed."""

    video: Path | None = None
    """Film the run into this .mp4, .gif or .webp file as well."""
    screenshot: Path | None = None
    """Write a picture of the run into this .png file."""
    at: float | None = None
    """Time of that picture instead of the end [s]."""
    camera: str | None = None
    """See by this camera instead of follow: orbit, under, or the name of one in the model."""
    size: str | None = None
    """Width and height of film and picture in pixels instead of 1280x720."""
    fps: int | None = None
    """Pictures in a second of the film instead of 30."""
    renderer: str | None = None
    """Draw with filament or classic instead of what works best here."""
    no_hud: Annotated[bool, typer.Option("--no-hud")] = False
    """Leave out the time, the sea and the scale that stand over pictures."""

    def __post_init__(self) -> None:
        if self.screenshot is not None and self.screenshot.suffix != ".png":
            raise SceneError(f"--screenshot is '{self.screenshot}'; a picture's name ends in .png")
        if self.at is not None and self.screenshot is None:
            raise SceneError("--at is given without --screenshot; give both")
        if self.fps is not None and self.video is None:
            raise SceneError("--fps is given without --video; give both")
        if self.video is None and self.screenshot is None:
            for name in ("camera", "size", "renderer", "no_hud"):
                if getattr(self, name) not in (None, False):
                    raise SceneError(
                        f"--{name.replace('_', '-')} is given without --video and --screenshot; "
                        "give one of them"
                    )

    def open(self, simulation: Simulation) -> "tuple[Film | None, Still | None]":
        """Open what was asked for.

        Raises:
            DrawingError: there is no such camera or size, or nothing can draw here.
            RecordingError: what it needs is not installed, or a file cannot be made.
            SceneError: the picture is asked for after the end.
        """
        if self.video is None and self.screenshot is None:
            return None, None
        from buoyancy_mj.drawing.cameras import FOLLOW
        from buoyancy_mj.drawing.film import FPS, Film, Still
        from buoyancy_mj.drawing.pictures import SIZE, Pictures

        duration = simulation.scene.duration
        if self.at is not None and not 0.0 <= self.at <= duration:
            raise SceneError(
                f"--at is {self.at:g}, and the scene lasts from 0 to {duration:g} s; take a time "
                "in it"
            )
        pictures = Pictures(
            simulation,
            camera=FOLLOW if self.camera is None else self.camera,
            size=SIZE if self.size is None else read_size(self.size),
            renderer=self.renderer,
            has_hud=not self.no_hud,
        )
        still = film = None
        if self.screenshot is not None:
            still = Still(pictures, self.screenshot, self.at)
        if self.video is not None:
            fps = FPS if self.fps is None else self.fps
            film = Film(simulation, pictures, self.video, fps)
        return film, still


def read_size(text: str) -> tuple[int, int]:
    """The width and height that a text WIDTHxHEIGHT says.

    Raises:
        SceneError: it says none.
    """
    if not re.fullmatch(r"[0-9]{1,6}x[0-9]{1,6}", text):
        raise SceneError(f"--size is '{text}'; write WIDTHxHEIGHT in pixels, as in 1280x720")
    width, height = map(int, text.split("x"))
    return width, height

"""`open_frames`: the renderer that draws here."""

import warnings
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.drawing.shots import Shot
from buoyancy_mj.errors import BuoyancyWarning, DrawingError, choices
from buoyancy_mj.sea.water import Water

FILAMENT, CLASSIC = "filament", "classic"
"""MuJoCo's renderers."""


class Frames(Protocol):
    """A renderer for one model."""

    def draw(
        self,
        data: mujoco.MjData,
        shot: Shot,
        centre: NDArray[np.float64],
        *,
        segments: bool = False,
    ) -> NDArray[np.uint8]:
        """A picture (height, width, 3)."""
        ...


def open_frames(
    name: str | None,
    model: mujoco.MjModel,
    water: Water,
    radius: float,
    size: tuple[int, int],
    look: Look,
) -> Frames:
    """A renderer by its name; None for Filament where it can draw, else the classic one.

    Warns:
        BuoyancyWarning: the classic one draws, and why.

    Raises:
        DrawingError: there is none of that name, or it cannot draw here.
    """
    if name is not None and name not in _OPENERS:
        raise DrawingError(f"there is no renderer '{name}'; {choices(name, _OPENERS)}")
    if name is not None:
        return _OPENERS[name](model, water, radius, size, look)
    try:
        return _open_filament(model, water, radius, size, look)
    except DrawingError as error:
        reason = error
    try:
        frames = _open_classic(model, water, radius, size, look)
    except DrawingError as error:
        raise DrawingError(f"nothing can draw here: {reason}; {error}") from error
    warnings.warn(f"the classic renderer draws: {reason}", BuoyancyWarning, stacklevel=3)
    return frames


def _open_filament(
    model: mujoco.MjModel, water: Water, radius: float, size: tuple[int, int], look: Look
) -> Frames:
    """Filament."""
    try:
        from buoyancy_mj.drawing.filament.frames import FilamentFrames
    except ImportError as error:
        raise DrawingError(
            f"Filament cannot be loaded: {' '.join(str(error).split())}; or draw with the classic "
            "renderer"
        ) from error
    return FilamentFrames(model, water, radius, size, look)


def _open_classic(
    model: mujoco.MjModel, water: Water, radius: float, size: tuple[int, int], look: Look
) -> Frames:
    """The classic renderer."""
    from buoyancy_mj.drawing.classic.frames import ClassicFrames

    return ClassicFrames(model, water, radius, size, look)


_OPENERS = {FILAMENT: _open_filament, CLASSIC: _open_classic}

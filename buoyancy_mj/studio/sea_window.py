"""`SeaWindow`: Studio's window, with a picture of the sea behind its panels."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.graphics import quiet
from buoyancy_mj.engine.kept_scenes import mend_windows
from buoyancy_mj.studio.library import load_renderer

load_renderer()

from mujoco.studio import native_viewer  # noqa: E402

BLACK = 2
"""Brightest value of a pixel that counts as black, for Filament dithers."""
_GROUPS = ("geomgroup", "sitegroup", "skingroup", "tendongroup", "flexgroup")
"""What Studio shall not draw of the model: the picture has it."""


class SeaWindow(native_viewer.NativeViewer):
    """A window that shows `picture` wherever Studio draws nothing but black.

    Studio's own view of the model, in 4.0.0, has a black sky as soon as there are more than a few
    geoms and sites, and takes no other. So it is left empty but for what Studio adds: pushes,
    contacts, frames, labels.
    """

    picture: NDArray[np.uint8] | None = None
    """What is behind the panels (height, width, 3)."""

    def __init__(self, config: Any, endpoint: Any, *, plugins: list[Any]) -> None:
        mend_windows()
        with quiet():
            super().__init__(config, endpoint, plugins=plugins)
        self._window: Any = _Backdrop(self._window, self)

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [pixels]."""
        return self._window.GetWidth(), self._window.GetHeight()

    def sync(self) -> None:
        """Draw the panels, over the picture; Studio's own view of the model is left black."""
        options = self.vis_options
        shown = {name: getattr(options, name).copy() for name in _GROUPS}
        for name in _GROUPS:
            getattr(options, name)[:] = 0
        super().sync()
        for name, groups in shown.items():
            getattr(options, name)[:] = groups


class _Backdrop:
    """A window of Studio's that lays what it presents over a picture."""

    def __init__(self, window: Any, owner: SeaWindow) -> None:
        self._presented, self._owner = window, owner

    def __getattr__(self, name: str) -> Any:
        return getattr(self._presented, name)

    def Present(self, pixels: NDArray[np.uint8]) -> None:  # noqa: N802
        """Present pixels (height, width, 3)."""
        behind = self._owner.picture
        if behind is not None and behind.shape == pixels.shape:
            np.copyto(pixels, behind, where=pixels.max(axis=2, keepdims=True) <= BLACK)
        self._presented.Present(pixels)

"""`FilamentFrames`: pictures of a model in its sea, drawn by Filament."""

import mujoco
import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.stage import Stage
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.shots import Shot
from buoyancy_mj.sea.water import Water

NEAR = 0.02
"""Distance of the nearest that is drawn, over that of what is looked at."""
FAR = 10_000.0
"""Distance of the farthest that is drawn [m]."""


class FilamentFrames:
    """A renderer for one model, with its own context.

    Args:
        model: the model.
        water: the sea.
        radius: distance from the middle of the sea within which its surface is exact [m].
        size: width and height of a picture [pixels].
        look: colours and brightness.

    Raises:
        DrawingError: Filament cannot draw here.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        water: Water,
        radius: float,
        size: tuple[int, int],
        look: Look = DAYLIGHT,
    ) -> None:
        self._water, self._look = water, look
        self._size = size
        self._stage = Stage(model, look)
        self._sea = self._stage.add_sea(radius, water.curvature)

    def draw(
        self,
        data: mujoco.MjData,
        shot: Shot,
        centre: NDArray[np.float64],
        *,
        segments: bool = False,
    ) -> NDArray[np.uint8]:
        """A picture (height, width, 3).

        Args:
            data: poses, as mj_forward left them.
            shot: what the camera sees.
            centre: the middle of the sea (3,) [m].
            segments: whether to give, in the place of colours, what is seen: white for the sea,
                black for the sky, and other colours for each part of the model.
        """
        far = max(self._look.visibility, 4.0 * shot.subject)
        self._sea.draw(self._water, centre, float(data.time), shot.eye, far)
        is_below = bool(self._sea.is_below)
        self._stage.pose(data, is_below=is_below)

        # under water a lamp beside the camera; segments are drawn as they are
        wishes = {"headlight": is_below, "headlight_intensity": self._look.lamp_below}
        if segments:
            mode = mjrf.DrawMode.DRAW_MODE_SEGMENTATION_BY_ID
            wishes |= {"draw_mode": mode, "post_processing": False}
        width, height = self._size
        frustum = shot.frustum(width / height, NEAR * shot.subject, FAR)
        return self._stage.draw(mjrf.Camera(**frustum), self._size, **wishes)

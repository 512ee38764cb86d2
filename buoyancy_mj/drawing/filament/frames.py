"""`FilamentFrames`: pictures of a model in its sea, drawn by Filament."""

import mujoco
import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.graphics import open_context
from buoyancy_mj.drawing.filament.sea import FilamentSea
from buoyancy_mj.drawing.filament.sky import FilamentSky
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
        self._width, self._height = size
        context = self._context = open_context()
        self._scene = context.create_scene(mjrf.SceneParams())
        self._scene.configure_from_model(model)
        resources = mjrf.ModelResources(context, model)
        self._lights = mjrf.ModelLights(self._scene, resources)
        self._bodies = mjrf.ModelRenderables(self._scene, resources)
        self._sky = FilamentSky(context, self._scene, look)
        self._sea = FilamentSea(context, self._scene, radius, water.curvature, look)

        self._target = context.create_render_target(
            mjrf.RenderTargetConfig(color_format=mjrf.PixelFormat.PIXEL_FORMAT_RGB8)
        )
        self._target.resize(*size)

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
        self._lights.update(data)
        self._bodies.update(data)
        far = max(self._look.visibility, 4.0 * shot.subject)
        self._sea.draw(self._water, centre, float(data.time), shot.eye, far)
        self._sky.draw(is_below=bool(self._sea.is_below))

        request = mjrf.RenderRequest()
        request.scene, request.target = self._scene, self._target
        near = NEAR * shot.subject
        request.camera = mjrf.Camera(**shot.frustum(self._width / self._height, near, FAR))
        request.viewport.width, request.viewport.height = self._width, self._height
        request.headlight = bool(self._sea.is_below)
        request.headlight_intensity = self._look.lamp_below
        if segments:
            request.draw_mode = mjrf.DrawMode.DRAW_MODE_SEGMENTATION_BY_ID
            request.post_processing = False
        pixels = np.empty((self._height, self._width, 3), np.uint8)
        reading = mjrf.ReadRequest(target=self._target)
        reading.set_buffer(pixels)
        self._context.wait_for_frame(self._context.render([request], [reading]))
        return pixels

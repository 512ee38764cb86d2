"""`Stage`: a model under its sky in a scene of Filament, and pictures of that."""

from typing import Any

import mujoco
import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.graphics import open_context
from buoyancy_mj.drawing.filament.sea import FilamentSea
from buoyancy_mj.drawing.filament.sky import FilamentSky
from buoyancy_mj.drawing.looks import DAYLIGHT, Look


class Stage:
    """A model under its sky, with a context of its own.

    Args:
        model: the model.
        look: colours and brightness.

    Raises:
        DrawingError: Filament cannot draw here.
    """

    def __init__(self, model: mujoco.MjModel, look: Look = DAYLIGHT) -> None:
        context = self._context = open_context()
        self._scene = context.create_scene(mjrf.SceneParams())
        self._scene.configure_from_model(model)
        resources = mjrf.ModelResources(context, model)
        self._lights = mjrf.ModelLights(self._scene, resources)
        self.bodies = mjrf.ModelRenderables(self._scene, resources)
        """What is drawn of the model."""
        self._look, self._sky = look, FilamentSky(context, self._scene, look)
        self._target = context.create_render_target(
            mjrf.RenderTargetConfig(color_format=mjrf.PixelFormat.PIXEL_FORMAT_RGB8)
        )

    def add_sea(self, radius: float, curvature: float) -> FilamentSea:
        """Put a sea into it; see `FilamentSea`."""
        return FilamentSea(self._context, self._scene, radius, curvature, self._look)

    def pose(self, data: mujoco.MjData, *, is_below: bool) -> None:
        """Take the poses of data, as mj_forward left them, and the sky over or under water."""
        self._lights.update(data)
        self.bodies.update(data)
        self._sky.draw(is_below=is_below)

    def draw(self, camera: Any, size: tuple[int, int], **wishes: Any) -> NDArray[np.uint8]:
        """A picture (height, width, 3).

        Args:
            camera: an `mjrf.Camera`.
            size: width and height [pixels].
            wishes: other fields of an `mjrf.RenderRequest`.
        """
        width, height = size
        self._target.resize(width, height)
        request = mjrf.RenderRequest()
        request.scene, request.target, request.camera = self._scene, self._target, camera
        request.viewport.width, request.viewport.height = width, height
        for name, wish in wishes.items():
            setattr(request, name, wish)
        pixels = np.empty((height, width, 3), np.uint8)
        reading = mjrf.ReadRequest(target=self._target)
        reading.set_buffer(pixels)
        self._context.wait_for_frame(self._context.render([request], [reading]))
        return pixels

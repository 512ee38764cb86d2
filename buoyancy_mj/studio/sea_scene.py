"""`SeaScene`: pictures of a model in the sea, as Studio's camera sees it."""

from typing import Any

import mujoco
import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.graphics import open_context
from buoyancy_mj.drawing.filament.sea import FilamentSea
from buoyancy_mj.drawing.filament.sky import FilamentSky
from buoyancy_mj.sea.water import Water


class SeaScene:
    """A model with sea and sky, in a context of its own, since Studio's takes no other sky.

    Args:
        model: the model.
        radius: distance from the middle of the sea within which its surface is exact [m].

    Raises:
        DrawingError: Filament cannot draw here.
    """

    def __init__(self, model: mujoco.MjModel, radius: float) -> None:
        context = self._context = open_context()
        self._scene = context.create_scene(mjrf.SceneParams())
        self._scene.configure_from_model(model)
        resources = mjrf.ModelResources(context, model)
        self._lights = mjrf.ModelLights(self._scene, resources)
        self._bodies = mjrf.ModelRenderables(self._scene, resources)
        self._sky = FilamentSky(context, self._scene)
        self._radius = radius
        self._sea: FilamentSea | None = None
        self._target = context.create_render_target(
            mjrf.RenderTargetConfig(color_format=mjrf.PixelFormat.PIXEL_FORMAT_RGB8)
        )

    def draw(
        self,
        data: mujoco.MjData,
        water: Water | None,
        middle: NDArray[np.float64],
        camera: mujoco.MjvGLCamera,
        options: mujoco.MjvOption,
        size: tuple[int, int],
    ) -> NDArray[np.uint8]:
        """A picture (height, width, 3).

        Args:
            data: poses, as mj_forward left them.
            water: the sea; None for none.
            middle: what the camera looks at (3,) [m].
            camera: the camera.
            options: which groups are shown.
            size: width and height of the picture [pixels].
        """
        # what is there
        eye = np.array(camera.pos, float)
        self._bodies.set_options(options)
        self._bodies.update(data)
        self._lights.update(data)
        is_below = False
        if water is not None:
            if self._sea is None:
                self._sea = FilamentSea(self._context, self._scene, self._radius, water.curvature)
            self._sea.draw(water, middle, float(data.time), eye)
            is_below = bool(self._sea.is_below)
        self._sky.draw(is_below=is_below)

        # the picture of it
        width, height = size
        request = mjrf.RenderRequest()
        request.scene, request.target = self._scene, self._target
        request.camera = _convert(camera, width / height)
        request.viewport.width, request.viewport.height = size
        self._target.resize(width, height)
        pixels = np.empty((height, width, 3), np.uint8)
        reading = mjrf.ReadRequest(target=self._target)
        reading.set_buffer(pixels)
        self._context.wait_for_frame(self._context.render([request], [reading]))
        return pixels


def _convert(camera: mujoco.MjvGLCamera, aspect: float) -> Any:
    """Studio's camera as Filament takes it."""
    half = 0.5 * (camera.frustum_top - camera.frustum_bottom)
    return mjrf.Camera(
        pos=camera.pos,
        forward=camera.forward,
        up=camera.up,
        frustum_center=camera.frustum_center,
        frustum_width=camera.frustum_width or half * aspect,
        frustum_bottom=camera.frustum_bottom,
        frustum_top=camera.frustum_top,
        frustum_near=camera.frustum_near,
        frustum_far=camera.frustum_far,
    )

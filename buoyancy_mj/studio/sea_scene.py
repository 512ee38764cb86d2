"""`SeaScene`: pictures of a model in the sea, as Studio's camera sees it."""

from typing import Any

import mujoco
import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.sea import FilamentSea
from buoyancy_mj.drawing.filament.stage import Stage
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
        self._stage = Stage(model)
        self._radius = radius
        self._sea: FilamentSea | None = None

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
        is_below = False
        if water is not None:
            if self._sea is None:
                self._sea = self._stage.add_sea(self._radius, water.curvature)
            self._sea.draw(water, middle, float(data.time), np.array(camera.pos, float))
            is_below = bool(self._sea.is_below)
        self._stage.bodies.set_options(options)
        self._stage.pose(data, is_below=is_below)
        width, height = size
        return self._stage.draw(_convert(camera, width / height), size)


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

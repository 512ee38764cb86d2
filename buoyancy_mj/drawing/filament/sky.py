"""`FilamentSky`: the sky of a scene of Filament, and its light, above and under water."""

from typing import Any

import numpy as np
from mujoco import mjrf

from buoyancy_mj.drawing.filament.graphics import upload_cube
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.sky import paint_depths, paint_sky, sun_ray

PIXELS, COARSE = 384, 64
"""Pixels along an edge of the sky, and of what has no small parts."""


class FilamentSky:
    """Sky, sun, and the light that comes from everywhere.

    A light with a brightness in lux makes a scene photometric: lamps of the model lose by it.

    Args:
        context: an `mjrf.Context`.
        scene: an `mjrf.Scene` of it.
        look: colours and brightness.
    """

    def __init__(self, context: Any, scene: Any, look: Look = DAYLIGHT) -> None:
        self._scene, self._look = scene, look
        self._is_below: bool | None = None
        depths = upload_cube(context, paint_depths(look, COARSE))
        self._skies = {False: upload_cube(context, paint_sky(look, PIXELS)), True: depths}
        # clouds would lie on the water like oil
        clear = upload_cube(context, paint_sky(look, COARSE, has_clouds=False))
        # a light does not keep its picture
        self._lights = {False: clear, True: depths}
        self._glows = {
            side: context.create_light(
                mjrf.LightParams(
                    type=mjrf.LightType.LIGHT_IMAGE,
                    texture=light,
                    intensity=look.skylight_below if side else look.skylight,
                )
            )
            for side, light in self._lights.items()
        }
        self._sun = context.create_light(
            mjrf.LightParams(
                type=mjrf.LightType.LIGHT_DIRECTIONAL,
                color=look.sun,
                intensity=look.sunlight,
                cast_shadow=True,
            )
        )
        self._sun.set_pose(np.zeros(3), -sun_ray(look))
        scene.add_light(self._sun)

    def draw(self, *, is_below: bool) -> None:
        """Show the sky, or what one sees in its place under water.

        Args:
            is_below: whether the camera is under water.
        """
        if is_below is self._is_below:
            return
        if self._is_below is not None:
            self._scene.remove_light(self._glows[self._is_below])
        self._is_below = is_below
        self._scene.set_skybox(self._skies[is_below])
        self._scene.add_light(self._glows[is_below])
        look = self._look
        self._sun.set_color(look.sun_below if is_below else look.sun)
        self._sun.set_intensity(look.sunlight_below if is_below else look.sunlight)

"""`ClassicFrames`: pictures of a model in its sea, drawn by MuJoCo's classic renderer."""

import contextlib
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.classic.graphics import open_gl
from buoyancy_mj.drawing.classic.sea import WIDE, Eye, add_sea
from buoyancy_mj.drawing.classic.sky import add_sky
from buoyancy_mj.drawing.classic.triangles import AMBIENT, SEGMENT
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.shots import Shot
from buoyancy_mj.sea.water import Water

MOST_GEOMS, MOST_TRIANGLES = 40_000, 25_000
"""Geoms that a scene may have, and triangles of the sea among them."""
NEAR, FAR = 0.02, 600.0
"""Distances of the nearest and the farthest that is drawn, over that of what is looked at."""


class ClassicFrames:
    """A renderer for one model, with its own context.

    Args:
        model: the model.
        water: the sea.
        radius: distance from the middle of the sea within which its surface is finest [m].
        size: width and height of a picture [pixels].
        look: colours.

    Raises:
        DrawingError: there is no OpenGL.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        water: Water,
        radius: float,
        size: tuple[int, int],
        look: Look = DAYLIGHT,
    ) -> None:
        self._model, self._water, self._radius, self._look = model, water, radius, look
        self._width, self._height = size
        self._gl: Any = open_gl()
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        mujoco.mjr_resizeOffscreen(*size, self._context)
        self._scene = mujoco.MjvScene(model, maxgeom=MOST_GEOMS)
        self._option, self._camera = mujoco.MjvOption(), mujoco.MjvCamera()
        mujoco.mjv_defaultFreeCamera(model, self._camera)
        self._has_fog = False

    def draw(
        self,
        data: mujoco.MjData,
        shot: Shot,
        centre: NDArray[np.float64],
        *,
        segments: bool = False,
    ) -> NDArray[np.uint8]:
        """A picture (height, width, 3); see `FilamentFrames.draw`."""
        self._gl.make_current()
        is_below = bool(self._water.depth(shot.eye, float(data.time)) > 0.0)
        self._build(data, shot, centre, is_below=is_below)
        flags = self._scene.flags
        flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = segments
        flags[mujoco.mjtRndFlag.mjRND_FOG] = is_below and not segments
        flags[mujoco.mjtRndFlag.mjRND_HAZE] = flags[mujoco.mjtRndFlag.mjRND_SKYBOX] = False
        rect = mujoco.MjrRect(0, 0, self._width, self._height)
        mujoco.mjr_render(rect, self._scene, self._context)
        if is_below and not self._has_fog:
            # MuJoCo sets the colour of fog after it has drawn with it
            mujoco.mjr_render(rect, self._scene, self._context)
            self._has_fog = True
        pixels = np.empty((self._height, self._width, 3), np.uint8)
        mujoco.mjr_readPixels(pixels, None, rect, self._context)
        if segments:
            self._whiten(pixels)
        return pixels[::-1]

    def close(self) -> None:
        """Free what OpenGL holds; it must not be left to another context."""
        if self._gl is not None:
            self._gl.make_current()
            self._context.free()
            self._gl.free()
            self._gl = None

    def __del__(self) -> None:
        with contextlib.suppress(Exception):
            self.close()

    def _build(
        self, data: mujoco.MjData, shot: Shot, centre: NDArray[np.float64], *, is_below: bool
    ) -> None:
        """Put the model, the sky and the sea into the scene, the farthest first."""
        scene, look = self._scene, self._look
        self._place_camera(data, shot)
        # for a model that brings no lamp
        headlight = scene.lights[0].ambient
        headlight[:] = np.maximum(headlight, AMBIENT)
        far = 0.5 * FAR * shot.subject
        add_sky(scene, shot.eye, shot.forward, far=far, is_below=is_below, look=look)
        spread = min(WIDE * shot.fovy / 2.0, np.pi / 2.0)
        eye = Eye(shot.eye, shot.forward, spread)
        time = float(data.time)
        add_sea(
            scene, self._water, centre, time,
            radius=self._radius, eye=eye, look=look, most=MOST_TRIANGLES,
        )  # fmt: skip
        # the haze hides the far end of the sea
        self._context.fogStart = 0.0
        self._context.fogEnd = max(look.visibility, 4.0 * shot.subject)
        self._context.fogRGBA = [*look.haze, 1.0]

    def _place_camera(self, data: mujoco.MjData, shot: Shot) -> None:
        """Fill the scene as the camera sees the model; the headlight is beside it."""
        camera, scene = self._camera, self._scene
        camera.lookat[:] = shot.eye + shot.subject * shot.forward
        camera.distance = shot.subject
        camera.azimuth = np.degrees(np.arctan2(shot.forward[1], shot.forward[0]))
        camera.elevation = np.degrees(np.arcsin(np.clip(shot.forward[2], -1.0, 1.0)))
        every = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, data, self._option, None, camera, every, scene)
        near, far = NEAR * shot.subject, FAR * shot.subject
        for eye in scene.camera:
            for field, value in shot.frustum(self._width / self._height, near, far).items():
                setattr(eye, field, value)

    def _whiten(self, pixels: NDArray[np.uint8]) -> None:
        """Make what is seen of the sea white in a picture of segments."""
        ids = pixels.astype(np.int64) @ np.array([1, 256, 65536]) - 1
        is_sea = np.array(
            [geom.objid == SEGMENT for geom in self._scene.geoms[: self._scene.ngeom]]
        )
        pixels[(ids >= 0) & is_sea[ids.clip(0)]] = 255

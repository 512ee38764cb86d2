"""The sea as Studio shows it: a picture by Filament in a window, a skin on bones in a browser."""

from typing import Any

import mujoco
import numpy as np
from mujoco.studio import messages, plugin
from numpy.typing import NDArray

from buoyancy_mj.sea.water import Water
from buoyancy_mj.studio.letters import AfloatEvent, VerdictEvent, WaterEvent
from buoyancy_mj.studio.sea_scene import SeaScene
from buoyancy_mj.studio.skin_sea import SkinSea


class SeaPlugin(plugin.ViewerPlugin):
    """Keeps the water that acts, to be drawn around what the camera looks at."""

    _water: Water | None = None
    _radius = 1.0
    _skin: SkinSea | None = None

    @messages.handler
    def on_verdict(self, _: VerdictEvent) -> None:
        """There is no water around a dry model."""
        self._water = None

    @messages.handler
    def on_water(self, event: WaterEvent) -> None:
        """Keep the water that acts now."""
        self._water = event.water

    @messages.handler
    def on_afloat(self, event: AfloatEvent) -> None:
        """Keep the size of what floats, and the skin that is its sea."""
        self._radius, self._skin = event.radius, event.skin

    def _find_middle(self) -> NDArray[np.float64]:
        """What the camera looks at (3,) [m]."""
        viewer = self.viewer
        model, data, camera = viewer.model, viewer.data, viewer.camera
        kind = mujoco.mjtCamera(camera.type)
        if kind == mujoco.mjtCamera.mjCAMERA_FIXED:
            return np.array(model.stat.center)
        if kind == mujoco.mjtCamera.mjCAMERA_TRACKING:
            middle: NDArray[np.float64] = data.subtree_com[camera.trackbodyid].copy()
            return middle
        return np.array(camera.lookat)


class WindowSea(SeaPlugin):
    """The sea in a window: a picture in the place of Studio's own."""

    _scene: SeaScene | None = None

    @messages.handler
    def on_model(self, _: messages.PostModelEvent) -> None:
        """Make the scene of another model anew."""
        self._scene = None

    @messages.handler
    def on_exit(self, _: messages.ExitEvent) -> None:
        """Give the scene up in the thread that made it."""
        self._scene = None

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        """Draw the sea as it is now, and what somebody drags in it."""
        window: Any = self.viewer
        middle = self._find_middle()
        camera = mujoco.mjv_camera2GLCamera(window.model, window.data, window.camera)
        if self._scene is None:
            self._scene = SeaScene(window.model, self._radius)
        window.picture = self._scene.draw(
            window.data, self._water, middle, camera, window.vis_options, window.size
        )


class BrowserSea(SeaPlugin):
    """The sea in a browser: bones of a skin, which are a part of the state that it gets."""

    @messages.handler
    def on_update(self, _: messages.UpdateEvent) -> None:
        """Lay the skin on the sea as it is now."""
        viewer = self.viewer
        if self._water is None or self._skin is None or not viewer.model.nskin:
            return
        bones = self._skin.place(self._water, self._find_middle()[:2], float(viewer.data.time))
        viewer.data.mocap_pos[self._skin.first :] = bones

"""`Twin`: the dry copy of a basin's model that a window shows, and the state that both share."""

import mujoco
import numpy as np

from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.studio.dressing import add_sky, frame_scene
from buoyancy_mj.studio.dry_copy import copy_masses, make_dry_spec
from buoyancy_mj.studio.skin_sea import SkinSea

_SHARED = ("qpos", "qvel", "ctrl", "qfrc_applied", "eq_active")
"""Arrays of the state that are as long in both."""
_LONGER = ("xfrc_applied", "mocap_pos", "mocap_quat")
"""Arrays that are longer in the copy, by what is drawn of the sea."""


class Twin:
    """A dry copy of a basin's model with its state, and with sky and sea where they are its parts.

    Args:
        basin: the scene.
        look: colours of sky and sea.
        skin: whether sky and sea are parts of the copy, as browsers need it; windows draw them.
    """

    def __init__(self, basin: Basin, look: Look, *, skin: bool) -> None:
        vehicles = basin.vehicles.values()
        data = basin.frame().data
        centres = np.array([vehicle.centre_of_mass(data) for vehicle in vehicles])
        middle = 0.5 * (centres.min(axis=0) + centres.max(axis=0))
        reach = float(np.linalg.norm(np.ptp(centres, axis=0)))
        size = reach + max(vehicle.length for vehicle in vehicles)
        if abs(middle[2] - basin.water.level) < size:
            middle[2] = basin.water.level
        self.radius = 0.75 * size
        """Distance around what is looked at within which the sea is exact [m]."""

        spec = make_dry_spec(basin.scene)
        self.sea = SkinSea(spec, self.radius, look) if skin else None
        """The sea, where it is a part of the copy."""
        if skin:
            add_sky(spec, look)
        frame_scene(spec, middle, size)
        self.model = spec.compile()
        """The copy."""
        copy_masses(basin.model, self.model)
        self.data = mujoco.MjData(self.model)
        """Its state."""
        self.take(basin)

    def take(self, basin: Basin) -> None:
        """Take over the state of the basin."""
        self.data.time = basin.data.time
        for name in _SHARED:
            getattr(self.data, name)[:] = getattr(basin.data, name)
        for name in _LONGER:
            own = getattr(basin.data, name)
            getattr(self.data, name)[: len(own)] = own

    def give(self, basin: Basin) -> None:
        """Hand the basin what somebody did in the window: poses, controls, pushes, options."""
        basin.data.time = self.data.time
        for name in _SHARED:
            getattr(basin.data, name)[:] = getattr(self.data, name)
        for name in _LONGER:
            own = getattr(basin.data, name)
            own[:] = getattr(self.data, name)[: len(own)]


def make_dry_model(scene: Scene, look: Look, *, skin: bool) -> mujoco.MjModel:
    """A model that nobody has put into water, framed; for a browser, with a sky.

    Raises:
        ModelError: see `make_dry_spec`.
    """
    spec = make_dry_spec(scene)
    model = spec.compile()
    frame_scene(spec, model.stat.center.copy(), float(model.stat.extent))
    if skin:
        add_sky(spec, look)
    return spec.compile()

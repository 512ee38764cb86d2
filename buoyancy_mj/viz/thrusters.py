"""`ThrusterDrawing`: the forces of actuators at sites, as arrows in a recording."""

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.vehicle.drives import find_pushing
from buoyancy_mj.vehicle.instruments.channels import actuator_name
from buoyancy_mj.viz.framing import arrow_scale
from buoyancy_mj.viz.log import Log

ENTITY = "world/thrusters"
COLOUR = (255, 140, 0)
LONGER = 4.0
"""Length of an arrow over that of a load of the same force: thrusters are weak."""


def find_thrusters(model: mujoco.MjModel) -> NDArray[np.int64]:
    """Indices (n,) of the actuators that push at a site."""
    at_site = np.array(find_pushing(model), np.int64)
    pushing: NDArray[np.int64] = at_site[model.actuator_gear[at_site, :3].any(axis=1)]
    return pushing


class ThrusterDrawing:
    """The actuators of a run that push at a site: motors, and thrusters of this package.

    Args:
        run: the run.
        size: length of the vehicle [m].
    """

    def __init__(self, run: Run, size: float) -> None:
        model = run.model
        self._actuators = find_thrusters(model)
        self._gear = model.actuator_gear[self._actuators, :3]
        self._names = [actuator_name(model, actuator) for actuator in self._actuators.tolist()]
        self._forces = model.actuator_outadr[self._actuators]
        self._size = size
        self._is_idle = False

        # a reference site gives the axes, where there is one
        self._sites, references = model.actuator_trnid[self._actuators].T
        self._axes = np.where(references >= 0, references, self._sites)
        bodies = model.site_bodyid[self._sites].tolist()
        scales = [arrow_scale(run.vehicles.values(), body) for body in bodies]
        self._scales = LONGER * np.array(scales)

    def draw_static(self, log: Log) -> None:
        """Draw what stays the same: colour, and names to be shown on demand."""
        if len(self._actuators):
            style = rr.Arrows3D.from_fields(
                colors=[COLOUR], radii=[0.012 * self._size], labels=self._names, show_labels=False
            )
            log.keep(ENTITY, style)

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw an arrow for each force; a quarter of the vehicle's weight is half its length."""
        if not len(self._actuators):
            return
        # what does not push is drawn once
        is_idle = not frame.data.actuator_force[self._forces].any()
        if not (is_idle and self._is_idle):
            self._is_idle = is_idle
            vectors = self._scales[:, None] * self.find_forces(frame.data)
            origins = frame.data.site_xpos[self._sites]
            log.draw(ENTITY, rr.Arrows3D, origins=origins, vectors=vectors)

    def find_forces(self, data: mujoco.MjData) -> NDArray[np.float64]:
        """The forces (n, 3) [N], world frame: actuator_force times gear, along the site's axes."""
        world_from_site = data.site_xmat[self._axes].reshape(-1, 3, 3)
        along = self._gear * data.actuator_force[self._forces][:, None]
        forces: NDArray[np.float64] = (world_from_site @ along[:, :, None])[:, :, 0]
        return forces

"""`TendonDrawing`: the spatial tendons of a run, as lines in its recording."""

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.visible_geoms import SHOWN_GROUPS, choose_colour

ENTITY = "world/tendons"
PULLEY = -2
"""What MuJoCo writes in place of an object where a pulley parts a tendon."""


class TendonDrawing:
    """The tendons that have a path: tethers, cables, hoses.

    Args:
        model: the model.
    """

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        is_fixed = model.wrap_type[model.tendon_adr] == mujoco.mjtWrap.mjWRAP_JOINT
        shown = np.flatnonzero(~is_fixed & (model.tendon_group < SHOWN_GROUPS))
        colours = {
            tendon: choose_colour(model, model.tendon_rgba[tendon], int(model.tendon_matid[tendon]))
            for tendon in shown.tolist()
        }
        self._colours = {
            tendon: int((255.0 * rgba).astype(np.uint8).view(">u4")[0])
            for tendon, rgba in colours.items()
            if rgba[3] > 0.0
        }

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw the path of each tendon, piece by piece."""
        if not self._colours:
            return
        pieces, colours, radii = [], [], []
        for tendon, colour in self._colours.items():
            for path in find_path(frame.data, tendon):
                pieces.append(np.stack([path[:-1], path[1:]], axis=1))
                colours += [colour] * (len(path) - 1)
                radii += [float(self._model.tendon_width[tendon])] * (len(path) - 1)
        log.draw(
            ENTITY,
            rr.LineStrips3D,
            strips=np.concatenate([np.zeros((0, 2, 3)), *pieces]),
            colors=np.array(colours, np.uint32),
            radii=np.array(radii),
        )


def find_path(data: mujoco.MjData, tendon: int) -> list[NDArray[np.float64]]:
    """The path of a tendon: points (n, 3) [m] in the world frame, for each of its branches."""
    begin, count = int(data.ten_wrapadr[tendon]), int(data.ten_wrapnum[tendon])
    points = data.wrap_xpos.reshape(-1, 3)[begin : begin + count]
    objects = data.wrap_obj.ravel()[begin : begin + count]
    pulleys = np.flatnonzero(objects == PULLEY)

    # a pulley stands before its branch, and is no point of it
    branches = np.split(points, pulleys)
    first, *others = branches
    return [
        branch.copy() for branch in (first, *(other[1:] for other in others)) if len(branch) > 1
    ]

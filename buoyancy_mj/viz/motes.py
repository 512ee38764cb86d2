"""`MoteDrawing`: motes that lie still in deep water, so that motion shows without a floor."""

import numpy as np
import rerun as rr

from buoyancy_mj.viz.eye import Eye
from buoyancy_mj.viz.log import Log

ENTITY = "world/motes"
CELL = 1.2
"""Side of a cube of water that repeats, over the distance of the eye."""
CUBES = 5
"""Number of cubes along each side of the block that is drawn."""
COUNT = 8
"""Number of motes in a cube."""
RADIUS = 0.004
"""Their radius, over the distance of the eye."""
COLOUR = (190, 232, 236)


class MoteDrawing:
    """Motes around what the eye looks at, while it is under water.

    A block of them moves along by whole cubes, which all are alike: no mote moves.

    Args:
        eye: who looks at them.
    """

    def __init__(self, eye: Eye) -> None:
        self._eye = eye
        self._side = CELL * eye.distance
        self._radius = RADIUS * eye.distance
        # whole cubes, under the troughs
        self._top = np.floor((eye.level - eye.crest) / self._side) - 0.5 * CUBES
        self._cube: list[float] | None = None
        self._is_shown: bool | None = None

    def draw_static(self, log: Log) -> None:
        """Draw the block."""
        cube = np.random.default_rng(7).random((COUNT, 3))
        along = np.arange(CUBES) - 0.5 * CUBES
        corners = np.stack(np.meshgrid(along, along, along), axis=-1).reshape(-1, 1, 3)
        places = self._side * (corners + cube).reshape(-1, 3)
        log.keep(ENTITY, rr.Points3D.from_fields(positions=places, colors=[COLOUR]))

    def draw(self, log: Log) -> None:
        """Bring the block to what the eye looks at."""
        if self._eye.is_below is not self._is_shown:
            self._is_shown = self._eye.is_below
            log.draw(ENTITY, rr.Points3D, radii=[self._radius if self._is_shown else 0.0])
        if not self._is_shown:
            return
        x, y, z = np.round(self._eye.middle / self._side).tolist()
        cube = [x, y, min(z, self._top)]
        if cube != self._cube:
            self._cube = cube
            log.draw(ENTITY, rr.Transform3D, translation=self._side * np.array([cube]))

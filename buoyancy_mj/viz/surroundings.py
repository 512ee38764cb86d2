"""`Surroundings`: the eye of a recording, and all that it sees around the vehicles."""

import mujoco
import numpy as np

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.viz import motes, sea_surface, sky
from buoyancy_mj.viz.eye import ENTITY, Eye
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.motes import MoteDrawing
from buoyancy_mj.viz.sea_grid import choose_cell
from buoyancy_mj.viz.sea_surface import SurfaceDrawing
from buoyancy_mj.viz.sky import draw_sky
from buoyancy_mj.viz.still_geoms import StillGeoms

EVERYWHERE = (sky.ENTITY, sea_surface.ENTITY, sea_surface.FAR, motes.ENTITY, ENTITY)
"""Entities that are all over the picture."""


class Surroundings:
    """The sky, the sea, the motes in it, and geoms that do not move.

    Args:
        run: the run.
        start: its data with the poses at the start.
    """

    def __init__(self, run: Run, start: mujoco.MjData) -> None:
        self.eye = Eye(run, start)
        """Who looks."""
        self.cell = choose_cell(self.eye.distance)
        """Side of the squares on the sea, and on floors and walls [m]."""
        self._surface = SurfaceDrawing(run.buoyancy.water, self.eye, self.cell)
        self._geoms = StillGeoms(run.model, self.cell)
        self._motes = None if self._geoms.has_floor else MoteDrawing(self.eye)

    @property
    def passive(self) -> list[str]:
        """Entities that a pointer in the viewer passes over: what is large or everywhere."""
        return [*EVERYWHERE, *self._geoms.large]

    def draw_static(self, log: Log) -> None:
        """Draw what stays the same."""
        draw_sky(log)
        self.eye.draw_static(log)
        self._geoms.draw_static(log)
        self._surface.draw_static(log)
        if self._motes is not None:
            self._motes.draw_static(log)

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw one frame."""
        centres = np.array([one.centre_of_mass for one in frame.vehicles.values()])
        self.eye.draw(log, centres, frame.time)
        self._surface.draw(log, frame.time)
        if self._motes is not None:
            self._motes.draw(log)

"""`DepthTint`: geoms keep their colours under water, with less red the deeper they are."""

import math
from collections.abc import Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz.log import Log

SHALLOW, DEEP = np.array([0.9, 0.98, 1.0]), np.array([0.68, 0.9, 1.0])
"""What is left of red, green and blue just under the surface and far below it."""
FADE = 6.0
"""Depth over which colours change [m]."""
RATE = 10.0
"""Times that depths are looked at in a second [Hz], at most."""
STEPS = 8
"""Number of tints between the two."""


class DepthTint:
    """The colours of geoms by the depths of their middles, sent when they change.

    Args:
        water: the sea.
        geoms: indices of the geoms (n,).
        entities: the entity of each.
        colours: red, green, blue and alpha of each (n, 4), as it is dry.
    """

    def __init__(
        self,
        water: Water,
        geoms: NDArray[np.int64],
        entities: Sequence[str],
        colours: NDArray[np.uint8],
    ) -> None:
        self._water, self._geoms, self._entities = water, geoms, entities
        parts = np.linspace(0.0, 1.0, STEPS)[:, None]
        left = np.vstack([np.ones(3), SHALLOW + (DEEP - SHALLOW) * parts])
        # by geom and by step, the first of which is dry
        tinted = np.repeat(colours[:, None], STEPS + 1, axis=1)
        tinted[..., :3] = np.rint(colours[:, None, :3] * left)
        self._colours = tinted.view(">u4").astype(np.uint32)
        self._steps = np.full(len(geoms), -1)
        self._due = -math.inf

    def draw(self, log: Log, frame: Frame) -> None:
        """Colour the geoms that are deeper or less deep than before."""
        if frame.time < self._due or not len(self._geoms):
            return
        self._due = frame.time + 1.0 / RATE - 1e-6
        depths = self._water.depth(frame.data.geom_xpos[self._geoms], frame.time)
        steps = self.find_steps(depths)
        for geom in np.flatnonzero(steps != self._steps).tolist():
            colour = self._colours[geom, steps[geom]]
            log.draw(self._entities[geom], rr.Mesh3D, albedo_factor=colour)
        self._steps = steps

    @staticmethod
    def find_steps(depths: NDArray[np.float64]) -> NDArray[np.int64]:
        """The tint (n,) of each depth (n,) [m]: 0 is dry, `STEPS` is the deepest."""
        parts = 1.0 - np.exp(-np.maximum(depths, 0.0) / FADE)
        return np.where(depths > 0.0, 1 + np.rint((STEPS - 1) * parts).astype(int), 0)

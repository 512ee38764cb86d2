"""`BodyDrawing`: the bodies of a run in its recording, tinted by depth, and their waterline."""

import math

import numpy as np
import rerun as rr

from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.submersion.wetted_surface import Placed, cut_waterlines
from buoyancy_mj.viz.depth_tint import DepthTint
from buoyancy_mj.viz.entities import body_entity, geom_entity
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.placed_meshes import keep_mesh
from buoyancy_mj.viz.sites import draw_sites
from buoyancy_mj.viz.visible_foils import VisibleFoil, find_visible_foils
from buoyancy_mj.viz.visible_geoms import find_visible_geoms

TURN = [1, 2, 3, 0]
"""Order of a quaternion of MuJoCo as the viewer takes it, the scalar last."""
WATERLINE = (255, 255, 255)
RATE = 20.0
"""Times that the waterline is drawn in a second [Hz], at most."""


class BodyDrawing:
    """The bodies of a run.

    Args:
        run: the run.
        size: length of the vehicle [m].
    """

    def __init__(self, run: Run, size: float) -> None:
        self._run = run
        self._size = size
        self._geoms = [geom for geom in find_visible_geoms(run.model) if geom.moves]
        self._foils = list(find_visible_foils(run.model))
        bodies = {geom.body for geom in self._geoms} | {one.foil.body for one in self._foils}
        self._bodies = {body: body_entity(run.model, body) for body in sorted(bodies)}
        self._tint = DepthTint(
            run.buoyancy.water,
            np.array([geom.geom for geom in self._geoms], int),
            [geom_entity(run.model, geom.geom, geom.body) for geom in self._geoms],
            np.array([geom.colour for geom in self._geoms], np.uint8).reshape(-1, 4),
        )
        self._due = -math.inf

    def draw_static(self, log: Log) -> None:
        """Draw the geoms that move, and foils that are sites, in the frames of their bodies."""
        for geom in self._geoms:
            entity = geom_entity(self._run.model, geom.geom, geom.body)
            keep_mesh(log, entity, geom, geom.position, geom.rotation)
        for visible in self._foils:
            self._draw_foil(log, visible)
        draw_sites(log, self._run.model)
        radius = 0.003 * self._size
        log.keep("world/waterline", rr.LineStrips3D.from_fields(colors=[WATERLINE], radii=[radius]))

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw one frame: the poses of bodies, how deep they are, and the waterline."""
        # looked up once: each look at the engine's data makes an array
        places, turns = frame.data.xpos, frame.data.xquat[:, TURN]
        for body, entity in self._bodies.items():
            here = slice(body, body + 1)
            log.draw(entity, rr.Transform3D, translation=places[here], quaternion=turns[here])
        self._tint.draw(log, frame)
        if frame.time >= self._due:
            self._due = frame.time + 1.0 / RATE - 1e-6
            self._draw_waterline(log, frame)

    def _draw_foil(self, log: Log, visible: VisibleFoil) -> None:
        """Draw a foil that is a site in the frame of its body."""
        foil = visible.foil
        entity = (
            f"{body_entity(self._run.model, foil.body)}/{rr.escape_entity_path_part(foil.name)}"
        )
        keep_mesh(log, entity, visible.mesh, foil.middle, foil.body_from_foil, visible.colour)

    def _draw_waterline(self, log: Log, frame: Frame) -> None:
        """Draw the waterline on all hulls that the surface cuts."""
        hulls, places, turns = self._run.buoyancy.hulls, frame.data.geom_xpos, frame.data.geom_xmat
        cut = [
            Placed(hull.mesh, places[hull.geom], turns[hull.geom])
            # NaN from a method that does not know the area
            for hull, area in zip(hulls, frame.loads.waterplane_area.tolist(), strict=True)
            if area != 0.0
        ]
        lines = cut_waterlines(cut, self._run.buoyancy.water, frame.time)
        log.draw("world/waterline", rr.LineStrips3D, strips=lines)

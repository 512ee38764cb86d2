"""`StillGeoms`: floors, walls and other geoms that do not move, in a recording."""

import mujoco
import numpy as np

from buoyancy_mj.viz.endless_floor import EndlessFloor, is_endless_floor
from buoyancy_mj.viz.entities import geom_entity
from buoyancy_mj.viz.eye import Eye
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.placed_meshes import keep_mesh
from buoyancy_mj.viz.tiles import tile_geom
from buoyancy_mj.viz.visible_geoms import VisibleGeom, find_visible_geoms

LARGE = 3.0
"""Second longest side of a geom with tiles, over the side of one: of a floor or a wall."""


class StillGeoms:
    """The geoms of a model that do not move, large ones with tiles by which motion shows.

    Args:
        model: the model.
        eye: who looks at them.
        tile: side of a tile [m].
    """

    def __init__(self, model: mujoco.MjModel, eye: Eye, tile: float) -> None:
        self._tile = tile
        self._geoms: dict[str, VisibleGeom] = {}
        self._floors: list[EndlessFloor] = []
        for geom in find_visible_geoms(model):
            entity = geom_entity(model, geom.geom, geom.body)
            if is_endless_floor(model, geom):
                self._floors.append(EndlessFloor(geom, entity, eye, tile))
            elif not geom.moves:
                self._geoms[entity] = geom
        self.large = [entity for entity, geom in self._geoms.items() if self._is_large(geom)]
        """Entities of floors and walls."""

    @property
    def has_floor(self) -> bool:
        """Whether there are floors or walls."""
        return bool(self.large or self._floors)

    def draw_static(self, log: Log) -> None:
        """Draw them all."""
        for floor in self._floors:
            floor.draw_static(log)
        for entity, geom in self._geoms.items():
            keep_mesh(log, entity, geom, geom.position, geom.rotation, geom.colour)
            if entity in self.large:
                log.keep(entity, tile_geom(geom, self._tile))

    def draw(self, log: Log) -> None:
        """Bring floors without end to where the eye looks."""
        for floor in self._floors:
            floor.draw(log)

    def _is_large(self, geom: VisibleGeom) -> bool:
        """Whether a geom is a floor or a wall."""
        return bool(np.sort(np.ptp(geom.vertices, axis=0))[-2] >= LARGE * self._tile)

"""`StillGeoms`: floors, walls and other geoms that do not move, in a recording."""

import mujoco
import numpy as np
import rerun as rr

from buoyancy_mj.viz.entities import geom_entity
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.tiles import tile_geom
from buoyancy_mj.viz.visible_geoms import VisibleGeom, find_visible_geoms

LARGE = 3.0
"""Second longest side of a geom with tiles, over the side of one: of a floor or a wall."""


class StillGeoms:
    """The geoms of a model that do not move, large ones with tiles by which motion shows.

    Args:
        model: the model.
        tile: side of a tile [m].
    """

    def __init__(self, model: mujoco.MjModel, tile: float) -> None:
        self._tile = tile
        self._geoms = {
            geom_entity(model, geom.geom, geom.body): geom
            for geom in find_visible_geoms(model)
            if not geom.moves
        }
        self.large = [entity for entity, geom in self._geoms.items() if self._is_large(geom)]
        """Entities of floors and walls."""

    @property
    def has_floor(self) -> bool:
        """Whether there are floors or walls."""
        return bool(self.large)

    def draw_static(self, log: Log) -> None:
        """Draw them all."""
        for entity, geom in self._geoms.items():
            mesh = rr.Mesh3D(
                vertex_positions=geom.vertices,
                triangle_indices=geom.faces,
                vertex_normals=geom.normals,
                albedo_factor=geom.colour,
            )
            log.keep(entity, mesh)
            log.keep(entity, rr.Transform3D(translation=geom.position, mat3x3=geom.rotation))
            if entity in self.large:
                log.keep(entity, tile_geom(geom, self._tile))

    def _is_large(self, geom: VisibleGeom) -> bool:
        """Whether a geom is a floor or a wall."""
        return bool(np.sort(np.ptp(geom.vertices, axis=0))[-2] >= LARGE * self._tile)

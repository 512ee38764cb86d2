"""`EndlessFloor`: a level plane without end, which fades into the deep far off."""

import math

import mujoco
import numpy as np
import rerun as rr

from buoyancy_mj.drawing.looks import DAYLIGHT
from buoyancy_mj.drawing.sea_mesh import join_rings
from buoyancy_mj.viz.eye import Eye
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.textures import texture
from buoyancy_mj.viz.tiles import paint_tiles
from buoyancy_mj.viz.visible_geoms import VisibleGeom

SPOKES, RINGS = 48, 16
"""Number of its corners around, and of rings."""
REACH = 9.0
"""Distance at which it is lost in the deep, over that of the eye: that of the sea's waves."""


class EndlessFloor:
    """A disc around what the eye looks at, in tiles that lie still.

    Args:
        geom: the plane.
        entity: its entity.
        eye: who looks at it.
        tile: side of a tile [m].
    """

    def __init__(self, geom: VisibleGeom, entity: str, eye: Eye, tile: float) -> None:
        self._geom, self._entity, self._eye, self._tile = geom, entity, eye, tile
        self._centre = np.full(2, np.nan)

    def draw_static(self, log: Log) -> None:
        """Draw the disc."""
        radius = REACH * max(self._eye.distance, 0.5 * abs(self._height - self._eye.level))
        radii = np.linspace(0.0, radius, RINGS + 1)[1:]
        angles = 2.0 * math.pi / SPOKES * np.arange(SPOKES)
        ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(SPOKES)], axis=-1)
        corners = np.vstack([np.zeros((1, 3)), (radii[:, None, None] * ring).reshape(-1, 3)])
        away = np.linalg.norm(corners, axis=1, keepdims=True) / radius
        own, deep = self._geom.colour[:3] / 255.0, np.array(DAYLIGHT.haze)
        colours = own + (deep - own) * away**0.7
        log.keep(
            self._entity,
            rr.Mesh3D(
                vertex_positions=corners,
                triangle_indices=join_rings(RINGS, SPOKES),
                vertex_colors=np.rint(255.0 * colours).astype(np.uint8),
            ),
        )
        log.keep(self._entity, texture(paint_tiles(), corners[:, :2] / (2.0 * self._tile)))

    def draw(self, log: Log) -> None:
        """Bring the disc to what the eye looks at, by two whole tiles."""
        stride = 2.0 * self._tile
        centre = stride * np.round(self._eye.middle[:2] / stride)
        if not np.array_equal(centre, self._centre):
            self._centre = centre
            place = np.array([[*centre, self._height]])
            log.draw(self._entity, rr.Transform3D, translation=place)

    @property
    def _height(self) -> float:
        """Its height [m]."""
        return float(self._geom.position[2])


def is_endless_floor(model: mujoco.MjModel, geom: VisibleGeom) -> bool:
    """Whether a geom is a level plane without end."""
    is_plane = model.geom_type[geom.geom] == mujoco.mjtGeom.mjGEOM_PLANE
    is_endless = not geom.moves and (model.geom_size[geom.geom, :2] <= 0.0).all()
    return bool(is_plane and is_endless and abs(geom.rotation[2, 2]) > 1.0 - 1e-9)

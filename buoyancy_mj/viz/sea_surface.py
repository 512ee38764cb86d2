"""`SurfaceDrawing`: the sea around the vehicles in a recording, out to the horizon."""

import math

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.drawing.sea_mesh import Band, join_rings, split_waves
from buoyancy_mj.sea.water import Water
from buoyancy_mj.viz import sky
from buoyancy_mj.viz.eye import Eye
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.sea_grid import DARK, paint_grid
from buoyancy_mj.viz.sea_shades import OPACITY, Shades, see_through
from buoyancy_mj.viz.textures import texture

ENTITY, FAR = "world/water", "world/water/far"
"""The surface with its waves, and still water from there to the horizon."""
SPOKES = 28
"""Number of corners around a ring."""
INNER, OUTER = 0.25, 9.0
"""Radii of the first and of the last ring, over the distance of the eye."""
RATE, COLOUR_RATE = 30.0, 15.0
"""Times that heights and colours are drawn in a second [Hz], at most."""
FINE = 500.0
"""Distance of the eye over the step to which heights are rounded, so that they pack well."""
STALE = 0.1
"""Change of the eye's height, over its distance, with which colours are found anew."""


class SurfaceDrawing:
    """The surface of the sea, which follows the vehicles by cells of its grid.

    Its triangles stay, and of its corners only the heights change, so that little is sent.

    Args:
        water: the sea.
        eye: who looks at it.
        cell: side of a cell of the grid that lies on it [m].
    """

    def __init__(self, water: Water, eye: Eye, cell: float) -> None:
        self._water, self._eye, self._cell = water, eye, cell
        self._step = 2.0 ** math.floor(math.log2(eye.distance / FINE))
        growth = 1.0 + 2.0 * math.pi / SPOKES
        count = math.ceil(math.log(OUTER / INNER) / math.log(growth)) + 1
        radii = INNER * eye.distance * growth ** np.arange(count)
        self._radius = float(radii[-1])
        self._corners = np.vstack([np.zeros((1, 3), np.float32), _place_rings(radii)])
        self._faces = join_rings(count, SPOKES)
        # through the sky, without a gap
        far = np.geomspace(self._radius, 1.05 * eye.horizon, 8)
        self._far, self._far_faces = _place_rings(far), join_rings(8, SPOKES)[SPOKES:] - 1

        # waves fade where cells are too long for them, and towards the rim
        away = np.append(0.0, np.repeat(radii, SPOKES))
        cells = np.where(away < eye.distance, 0.0, away * (growth - 1.0))
        rim = np.clip((self._radius - away) / (0.4 * self._radius), 0.0, 1.0)
        self._bands = [
            Band(band.water, band.weights * rim[: len(band.weights)])
            for band in split_waves(water, cells)
        ]
        self._centre = np.full(2, np.nan)
        self._due = self._colours_due = -math.inf
        self._height = math.inf
        self._shades: Shades

    def draw_static(self, log: Log) -> None:
        """Draw what stays the same: triangles, and the grid on them."""
        places = self._corners[:, :2] / (2.0 * self._radius) + 0.5
        log.keep(ENTITY, rr.Mesh3D.from_fields(triangle_indices=self._faces))
        log.keep(ENTITY, texture(paint_grid(self._radius, self._cell), places))
        still = rr.Mesh3D.from_fields(vertex_positions=self._far, triangle_indices=self._far_faces)
        log.keep(FAR, still)

    def draw(self, log: Log, time: float) -> None:
        """Draw the surface at a time [s], around what the eye looks at."""
        if time < self._due:
            return
        self._due = time + 1.0 / RATE - 1e-6
        has_moved, has_turned = self._follow(log), self._look(log)
        # still water is the same but for its place and for who looks at it
        if not self._bands and not has_moved and not has_turned:
            return
        x, y = self._corners[:, 0] + self._centre[0], self._corners[:, 1] + self._centre[1]
        heights = np.zeros(len(self._corners))
        for band in self._bands:
            some = slice(len(band.weights))
            heights[some] += band.weights * band.water.elevation(x[some], y[some], time)
        self._corners[:, 2] = self._step * np.rint(heights / self._step)
        log.draw(ENTITY, rr.Mesh3D, vertex_positions=self._corners)

        if has_turned or time >= self._colours_due:
            self._colours_due = time + 1.0 / COLOUR_RATE - 1e-6
            slopes = np.zeros((len(self._corners), 2))
            for band in self._bands:
                some = slice(len(band.weights))
                slope = band.water.slope(x[some], y[some], time)
                slopes[some] += band.weights[:, None] * slope
            log.draw(ENTITY, rr.Mesh3D, vertex_colors=self._shades.paint(slopes))

    def _follow(self, log: Log) -> bool:
        """Move the sea to what the eye looks at, by whole cells; say whether it moved."""
        centre = self._cell * np.round(self._eye.middle[:2] / self._cell)
        if np.array_equal(centre, self._centre):
            return False
        self._centre = centre
        place = np.array([[*centre, self._water.level]])
        for entity in (ENTITY, sky.ENTITY):
            log.draw(entity, rr.Transform3D, translation=place)
        return True

    def _look(self, log: Log) -> bool:
        """Find the colours of the sea from where the eye is; say whether they are others."""
        height = float(self._eye.position[2]) - self._water.level
        is_below, was_below = height < 0.0, self._height < 0.0
        if is_below == was_below and abs(height - self._height) < STALE * self._eye.distance:
            return False
        self._height = height
        eye = np.array([*self._eye.offset[:2], height])
        self._shades = Shades(self._corners * [1.0, 1.0, 0.0], eye, DARK / 255.0)
        opacity = round(255 * OPACITY[is_below])
        log.draw(ENTITY, rr.Mesh3D, albedo_factor=np.array([0xFFFFFF00 + opacity], np.uint32))
        far = Shades(self._far, eye).paint(np.zeros((len(self._far), 2)))
        if not is_below:
            far = see_through(far, self._far, eye)
        log.draw(FAR, rr.Mesh3D, vertex_colors=far)
        return True


def _place_rings(radii: NDArray[np.floating]) -> NDArray[np.float32]:
    """Corners (n, 3) [m] of rings around the middle, z = 0."""
    angles = 2.0 * math.pi / SPOKES * np.arange(SPOKES)
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros(SPOKES)], axis=-1)
    corners: NDArray[np.float32] = (radii[:, None, None] * ring).astype(np.float32)
    return corners.reshape(-1, 3)

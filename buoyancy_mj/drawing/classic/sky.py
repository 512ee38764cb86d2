"""`add_sky`: the sky in a scene of the classic renderer, and the depths under water."""

import functools

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.classic.triangles import add_triangles
from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.drawing.sky import shade_depths, shade_sky

BANDS, SIDES = 180, 16
"""Bands between the poles of the sky, and sides of each."""
NARROW = 0.3
"""Width of the narrowest band over that of equal ones."""


def add_sky(
    scene: mujoco.MjvScene,
    eye: NDArray[np.float64],
    forward: NDArray[np.float64],
    *,
    far: float,
    is_below: bool,
    look: Look,
) -> None:
    """Add a sky around the camera to a scene, which keeps what is in it.

    Args:
        scene: the scene.
        eye: the camera (3,) [m].
        forward: unit vector (3,) along which it looks.
        far: radius of the sky [m].
        is_below: whether the camera is under water.
        look: its colours.
    """
    corners, colours = _dome(look, is_below)
    seen = (corners @ forward).max(axis=1) > 0.0
    add_triangles(scene, eye + far * corners[seen], colours[seen], eye, -1)


@functools.lru_cache(maxsize=4)
def _dome(look: Look, is_below: bool) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners (n, 3, 3) of a ball of triangles, and their colours (n, 4)."""
    # bands are narrow at the horizon, where colours change most
    parts = np.linspace(-1.0, 1.0, BANDS + 1)
    heights = 0.5 * np.pi * parts * (NARROW + (1.0 - NARROW) * np.abs(parts))
    turns = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    height, turn = np.meshgrid(heights, turns, indexing="ij")
    points = np.stack(
        [np.cos(height) * np.cos(turn), np.cos(height) * np.sin(turn), np.sin(height)], axis=-1
    )
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    corners = np.concatenate([np.stack([a, b, c], axis=2), np.stack([a, c, d], axis=2)])
    corners = corners.reshape(-1, 3, 3)
    # as the outside of a band is seen, at its middle
    middles = np.concatenate([a + c, a + c]).reshape(-1, 3)
    shade = shade_depths(look, middles) if is_below else shade_sky(look, middles, has_clouds=False)
    return corners, np.hstack([shade, np.ones((len(shade), 1))])

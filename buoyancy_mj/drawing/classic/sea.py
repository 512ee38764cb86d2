"""`add_sea`: the surface of the sea in a scene of the classic renderer."""

import functools
import math
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.classic.triangles import SEGMENT, add_triangles
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.sea_mesh import SeaMesh
from buoyancy_mj.drawing.sky import shade_sky
from buoyancy_mj.drawing.window import find_mirrored
from buoyancy_mj.errors import DrawingError
from buoyancy_mj.sea.water import Water

SPOKES = (24, 128)
"""Fewest and most vertices around a ring."""
MOST_TRIANGLES = 6000
"""Most triangles that the sea takes of a scene, if not told otherwise."""
WIDE = 2.5
"""Half the angle of the cone in which triangles are drawn, over that of the picture's height."""
FACING = 0.02
"""Part of the light that water turns back where one looks straight into it (Fresnel)."""


class Eye(NamedTuple):
    """Where one looks from, and at what."""

    position: NDArray[np.float64]
    """The camera (3,) [m]."""
    forward: NDArray[np.float64] | None = None
    """Unit vector (3,) along which it looks; None to draw what is behind it too."""
    spread: float = math.pi
    """Half the angle of the cone that it sees [rad]."""


def find_eye(scene: mujoco.MjvScene) -> Eye:
    """The camera of a scene, as `mjv_updateScene` left it.

    Raises:
        DrawingError: the scene was never updated.
    """
    # the middle between both eyes
    left, right = scene.camera[0], scene.camera[1]
    if not left.frustum_far > 0.0:
        raise DrawingError(
            "the scene has no camera yet; call renderer.update_scene(data, camera) first, or give "
            "eye=, the place of the camera"
        )
    half = left.frustum_top / left.frustum_near
    spread = min(WIDE * math.atan(half), 0.5 * math.pi)
    position = 0.5 * np.array([*left.pos, *right.pos]).reshape(2, 3).sum(axis=0)
    return Eye(position, np.array(left.forward, float), spread)


def add_sea(
    scene: mujoco.MjvScene,
    water: Water,
    centre: NDArray[np.float64],
    time: float,
    *,
    radius: float,
    eye: Eye,
    look: Look = DAYLIGHT,
    most: int = MOST_TRIANGLES,
) -> None:
    """Add the surface of the sea to a scene, which keeps what is in it.

    Args:
        scene: the scene. What it has room for decides how fine the surface is.
        water: the sea.
        centre: point around which the surface is finest, (2,) or (3,) [m].
        time: [s].
        radius: distance from there within which it is [m].
        eye: where one looks from.
        look: its colours.
        most: how many triangles it may take.

    Raises:
        DrawingError: the scene has no room.
    """
    room = min(most, scene.maxgeom - scene.ngeom)
    mesh = _find_mesh(radius, water.curvature, room, eye.forward is not None)
    surface = mesh.shape(water, centre[:2], time)
    vertices = surface.vertices + np.array([centre[0], centre[1], 0.0])
    corners, normals = vertices[mesh.faces], surface.normals[mesh.faces].mean(axis=1)

    # what the camera sees, the nearest first
    middles = corners.mean(axis=1)
    rays = middles - eye.position
    distances = np.linalg.norm(rays, axis=1)
    near = np.linalg.norm(corners - eye.position, axis=2).min(axis=1)
    order = np.argsort(near)
    if eye.forward is not None:
        long = 2.0 * np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        seen = rays @ eye.forward + long > math.cos(eye.spread) * distances
        order = order[seen[order]]
    order = order[:room]
    is_below = bool(water.depth(eye.position, time) > 0.0)
    shade = _shade_below if is_below else _shade_above
    colours = shade(look, rays[order] / distances[order, None], normals[order])
    add_triangles(scene, corners[order], colours, eye.position, SEGMENT)


@functools.lru_cache(maxsize=8)
def _find_mesh(radius: float, curvature: float, room: int, is_part: bool) -> SeaMesh:
    """The finest mesh of which what is seen fits into a number of geoms."""
    needed = 0
    for count in range(SPOKES[1], SPOKES[0] - 1, -8):
        mesh = SeaMesh(radius, curvature, spokes=(count, count))
        # a camera that looks one way sees less than half
        needed = len(mesh.faces) // (2 if is_part else 1)
        if needed <= room:
            return mesh
    raise DrawingError(
        f"the scene has room for {room} more geoms, and the sea takes {needed} at least; make the "
        "renderer with a larger max_geom"
    )


def _shade_above(
    look: Look, rays: NDArray[np.float64], normals: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Colours and opacities (n, 4) of the surface from above: water, and the sky in it."""
    facing = np.clip(-np.einsum("ni,ni->n", rays, normals), 0.0, 1.0)[:, None]
    part = FACING + (1.0 - FACING) * (1.0 - facing) ** 5
    mirrored = rays + 2.0 * facing * normals
    mirrored[:, 2] = np.abs(mirrored[:, 2])
    sky = shade_sky(look, mirrored, has_clouds=False)
    colour = (1.0 - part) * np.array(look.above.colour) + part * sky
    return np.hstack([colour, look.above.opacity + (1.0 - look.above.opacity) * part])


def _shade_below(
    look: Look, rays: NDArray[np.float64], normals: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Colours and opacities (n, 4) of the surface from below: light, or the depths in it."""
    part = find_mirrored(np.einsum("ni,ni->n", rays, normals))[:, None]
    colour = (1.0 - part) * np.array(look.bright) + part * np.array(look.haze)
    return np.hstack([colour, np.full_like(part, look.below.opacity)])

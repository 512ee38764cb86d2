"""Triangles in a scene of the classic renderer, each of one colour that no lamp changes."""

import mujoco
import numpy as np
from numpy.typing import NDArray

SEGMENT = 0x5EA
"""`objid` of what is drawn of the sea, whose `objtype` is unknown to MuJoCo."""
AMBIENT = 0.35
"""Ambient light where a scene does not know its lamps, as that of a viewer's user."""


def add_triangles(
    scene: mujoco.MjvScene,
    corners: NDArray[np.float64],
    colours: NDArray[np.float64],
    eye: NDArray[np.float64],
    segment: int,
) -> None:
    """Add triangles to a scene, as many as it has room for.

    Args:
        scene: the scene, which keeps all that is in it.
        corners: of each triangle (n, 3, 3) [m].
        colours: red, green, blue and opacity of each (n, 4), from 0 to 1.
        eye: where the camera is (3,) [m]; lamps shine on the sides that it does not see.
        segment: their `objid`; below 0 for what is nothing in a picture of segments.
    """
    # the normal follows from the order of corners
    start = corners[:, 0]
    normals = np.cross(corners[:, 1] - start, corners[:, 2] - start)
    is_dark = np.einsum("ni,ni->n", normals, start - eye)[:, None] > 0.0
    first = np.where(is_dark, corners[:, 1], corners[:, 2]) - start
    second = np.where(is_dark, corners[:, 2], corners[:, 1]) - start
    third = np.where(is_dark, normals, -normals) / np.linalg.norm(normals, axis=1)[:, None]
    rotations = np.stack([first, second, third], axis=2).reshape(-1, 9)
    rgba = colours.astype(np.float32)
    # what ambient light leaves, they shine of themselves
    lamps = scene.lights[: scene.nlight]
    ambient = sum(float(np.mean(lamp.ambient)) for lamp in lamps) if lamps else AMBIENT
    glow = max(0.0, 1.0 - ambient)
    geoms, size, kind = scene.geoms, np.ones(3), mujoco.mjtGeom.mjGEOM_TRIANGLE
    count = min(len(corners), scene.maxgeom - scene.ngeom)
    for row in range(count):
        geom = geoms[scene.ngeom + row]
        mujoco.mjv_initGeom(geom, kind, size, start[row], rotations[row], rgba[row])
        geom.emission, geom.specular = glow, 0.0
        geom.category = mujoco.mjtCatBit.mjCAT_DECOR
        geom.objtype, geom.objid = mujoco.mjtObj.mjOBJ_UNKNOWN, segment
        geom.segid = scene.ngeom + row if segment >= 0 else -1
    scene.ngeom += count

"""The sky of a browser: a dome around all, with a picture that shines by itself."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.drawing.sky import shade_sky
from buoyancy_mj.studio.grids import list_faces

RADIUS = 4000.0
"""Radius of the dome [m]."""
ROWS, COLUMNS = 32, 64
"""Number of its cells from below to above, and around."""
WIDTH, HEIGHT = 512, 256
"""Size of its picture [pixels]."""
HORIZON = (0.03, 0.12)
"""How far under the horizon the deep begins to show, and from where on it alone does [rad]."""
SHINE = 1.7
"""How much brighter the dome shines than its picture, to be as bright as what the sea mirrors."""


def add_dome(spec: mujoco.MjSpec, look: Look) -> None:
    """Add a dome with the sky on it, and the deep under the horizon, which the sea lets through."""
    turns = np.linspace(0.0, 2.0 * np.pi, COLUMNS + 1)
    heights = np.linspace(-0.5 * np.pi, 0.5 * np.pi, ROWS + 1)
    height, turn = (grid.ravel() for grid in np.meshgrid(heights, turns, indexing="ij"))
    rays = _ray(height, turn)
    mesh = spec.add_mesh(name="dome", inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
    mesh.uservert = (RADIUS * rays).ravel()
    mesh.usernormal = (-rays).ravel()
    mesh.usertexcoord = np.column_stack([turn / (2.0 * np.pi), 0.5 - height / np.pi]).ravel()
    mesh.userface = list_faces(ROWS + 1, COLUMNS + 1).ravel()

    picture = spec.add_texture(name="dome", type=mujoco.mjtTexture.mjTEXTURE_2D)
    picture.width, picture.height, picture.nchannel = WIDTH, HEIGHT, 3
    picture.colorspace = mujoco.mjtColorSpace.mjCOLORSPACE_SRGB
    picture.data = _paint(look).tobytes()

    # black, so that only what it shines by itself is seen
    material = spec.add_material(name="dome", rgba=[0.0, 0.0, 0.0, 1.0], emission=SHINE)
    material.specular, material.roughness, material.metallic = 0.0, 1.0, 0.0
    material.textures[int(mujoco.mjtTextureRole.mjTEXROLE_EMISSIVE)] = picture.name
    spec.worldbody.add_geom(
        name="dome",
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=mesh.name,
        material=material.name,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )


def _paint(look: Look) -> NDArray[np.uint8]:
    """The picture (HEIGHT, WIDTH, 3), as a map of the world has its lands."""
    height, turn = np.meshgrid(
        np.pi * (0.5 - (np.arange(HEIGHT) + 0.5) / HEIGHT),
        2.0 * np.pi * (np.arange(WIDTH) + 0.5) / WIDTH,
        indexing="ij",
    )
    rays = _ray(height, turn)
    colours = shade_sky(look, rays)
    begin, end = HORIZON
    part = np.clip((-rays[..., 2:] - begin) / (end - begin), 0.0, 1.0)
    colours += part * (np.array(look.deep) - colours)
    return np.rint(255.0 * colours).astype(np.uint8)


def _ray(height: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Unit vectors (..., 3) at heights over the horizon and turns about the vertical [rad]."""
    flat = np.cos(height)
    return np.stack([flat * np.cos(turn), flat * np.sin(turn), np.sin(height)], axis=-1)

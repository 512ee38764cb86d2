"""The sky, the sun and a far horizon for a dry copy, where nothing else draws them."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import Look
from buoyancy_mj.drawing.sky import paint_sky, sun_ray
from buoyancy_mj.studio.dome import add_dome

PIXELS = 128
"""Pixels along an edge of the sky."""
FAR = 10_000.0
"""Distance of the farthest that is drawn [m]."""
NEAR = 0.02
"""Distance of the nearest that is drawn, over the size of what is looked at."""


def frame_scene(spec: mujoco.MjSpec, middle: NDArray[np.float64], size: float) -> None:
    """Let a window open with a look at a place, from a little above, out to the horizon.

    Args:
        spec: of the scene.
        middle: what is looked at (3,) [m].
        size: its size [m].
    """
    spec.stat.center = middle
    spec.stat.extent = size
    spec.visual.map.zfar = FAR / size
    spec.visual.map.znear = NEAR
    spec.visual.global_.azimuth = 140.0
    spec.visual.global_.elevation = -18.0


def add_sky(spec: mujoco.MjSpec, look: Look) -> None:
    """Put a sky with its sun in the place of the sky and the lights that a model brings.

    The sky is a dome with a picture on it. Studio 4.0.0 leaves the sky of a model black as soon as
    there are more than a few geoms and sites; light from that sky it does take.
    """
    for texture in list(spec.textures):
        if texture.type == mujoco.mjtTexture.mjTEXTURE_SKYBOX:
            spec.delete(texture)
    for light in list(spec.lights):
        spec.delete(light)
    sky = spec.add_texture(name="sky", type=mujoco.mjtTexture.mjTEXTURE_CUBE)
    sky.width, sky.height, sky.nchannel = PIXELS, 6 * PIXELS, 3
    sky.data = paint_sky(look, PIXELS).tobytes()
    spec.worldbody.add_light(
        name="glow",
        type=mujoco.mjtLightType.mjLIGHT_IMAGE,
        texture=sky.name,
        intensity=look.skylight,
    )
    spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=-sun_ray(look),
        pos=20.0 * sun_ray(look),
        diffuse=look.sun,
        intensity=look.sunlight,
        # a skin would throw a shadow on all that is under water
        castshadow=False,
    )
    add_dome(spec, look)

"""Pictures of the sky: a cube around the camera, with the sun and clouds."""

import functools
import math
import random

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import Look

SIDES = (
    ((0, 0, -1), (0, -1, 0), (1, 0, 0)),
    ((0, 0, 1), (0, -1, 0), (-1, 0, 0)),
    ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
    ((1, 0, 0), (0, 0, -1), (0, -1, 0)),
    ((1, 0, 0), (0, -1, 0), (0, 0, 1)),
    ((-1, 0, 0), (0, -1, 0), (0, 0, -1)),
)
"""Sides of a cube texture in the order +x, -x, +y, -y, +z, -z: where its picture's right, its
picture's bottom and its outside point, in the frame of OpenGL, whose y points up."""
PUFFS = 48
"""Number of cosines that clouds are made of."""


@functools.lru_cache(maxsize=4)
def paint_sky(look: Look, size: int, *, has_clouds: bool = True) -> NDArray[np.uint8]:
    """The sky as the six sides (6, size, size, 3) of a cube texture, in sRGB.

    Args:
        look: its colours.
        size: pixels along an edge.
        has_clouds: as for `shade_sky`.
    """
    return _paint(shade_sky(look, _cube_rays(size), has_clouds=has_clouds))


@functools.lru_cache(maxsize=4)
def paint_depths(look: Look, size: int) -> NDArray[np.uint8]:
    """The water all around a camera under it, as `paint_sky` paints the sky."""
    return _paint(shade_depths(look, _cube_rays(size)))


def shade_depths(look: Look, rays: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours of water without end (..., 3), as `shade_sky` has those of the sky."""
    height = rays[..., 2:] / np.linalg.norm(rays, axis=-1, keepdims=True)
    haze, bright, dark = (np.array(one) for one in (look.haze, look.bright, look.dark))
    return np.where(
        height > 0.0,
        _mix(haze, bright, _smoothstep(height)),
        _mix(haze, dark, _smoothstep(-height)),
    )


def shade_sky(
    look: Look, rays: NDArray[np.float64], *, has_clouds: bool = True
) -> NDArray[np.float64]:
    """Colours of the sky (..., 3), from 0 to 1.

    Args:
        look: its colours.
        rays: where one looks (..., 3), world frame, of any length.
        has_clouds: whether there are clouds, which take time.
    """
    rays = rays / np.linalg.norm(rays, axis=-1, keepdims=True)
    height = np.clip(rays[..., 2:], 0.0, 1.0)
    colour = _mix(np.array(look.horizon), np.array(look.zenith), 1.0 - (1.0 - height) ** 4)
    # other waves, which a steep wave reflects, hide where the sea begins
    colour = _mix(colour, np.array(look.deep), _smoothstep(rays[..., 2:] / -0.6))

    # clouds on a plane overhead, which thin out towards the horizon
    if has_clouds:
        up = height[..., 0] > 0.0
        flat = rays[up, :2] / (height[up] + 0.12)
        puff = _smoothstep((_billow(flat) - 1.0 + 2.0 * look.cloud_cover) / 1.2)
        part = 0.85 * puff * _smoothstep(height[up] / 0.25)
        colour[up] = _mix(colour[up], np.array(look.cloud), part)

    # the sun and its glow
    cosine = np.clip(rays @ sun_ray(look), 0.0, 1.0)[..., None]
    glow = 0.35 * cosine**24 + 0.5 * cosine**300 + _smoothstep((cosine - 0.9994) / 0.0004)
    return np.clip(_mix(colour, np.array(look.sun), np.clip(glow, 0.0, 1.0)), 0.0, 1.0)


def sun_ray(look: Look) -> NDArray[np.float64]:
    """The unit vector (3,) that points to the sun, world frame."""
    flat = math.cos(look.sun_height)
    return np.array(
        [
            flat * math.cos(look.sun_azimuth),
            flat * math.sin(look.sun_azimuth),
            math.sin(look.sun_height),
        ]
    )


def _cube_rays(size: int) -> NDArray[np.float64]:
    """Where the pixels of a cube texture lie (6, size, size, 3), world frame."""
    along = (np.arange(size) + 0.5) / size * 2.0 - 1.0
    right, down = along[None, :, None], along[:, None, None]
    sides = np.array(SIDES, float)
    rays = (
        sides[:, None, None, 2] + right * sides[:, None, None, 0] + down * sides[:, None, None, 1]
    )
    # y points up there, z here
    return np.stack([rays[..., 0], -rays[..., 2], rays[..., 1]], axis=-1)


def _paint(colours: NDArray[np.float64]) -> NDArray[np.uint8]:
    """Colours from 0 to 1 as pixels."""
    pixels: NDArray[np.uint8] = np.rint(255.0 * colours).astype(np.uint8)
    return pixels


def _billow(places: NDArray[np.float64]) -> NDArray[np.float64]:
    """A smooth random height (..., 1) at places (..., 2), about from -1 to 1."""
    draw = random.Random(3)
    places = places.astype(np.float32)
    total = np.zeros(places.shape[:-1], np.float32)
    for index in range(PUFFS):
        # an octave more for each eighth of them, half as high
        scale = 1.2 * 2.0 ** (4.0 * index / PUFFS)
        turn, phase = draw.uniform(0.0, 2.0 * math.pi), draw.uniform(0.0, 2.0 * math.pi)
        wave = np.array([scale * math.cos(turn), 1.6 * scale * math.sin(turn)], np.float32)
        total += np.cos(places @ wave + phase) / scale**0.8
    return (total.astype(np.float64) / 2.2)[..., None]


def _mix(
    a: NDArray[np.float64], b: NDArray[np.float64], part: NDArray[np.float64]
) -> NDArray[np.float64]:
    """`a` where the part (..., 1) is 0, `b` where it is 1."""
    return a + (b - a) * part


def _smoothstep(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """0 up to 0, 1 from 1 on, and smooth between them."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)

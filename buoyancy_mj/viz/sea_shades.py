"""`Shades`: colours of the sea by how it slopes and whence one looks, as light is reflected."""

import functools

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.drawing.looks import DAYLIGHT
from buoyancy_mj.drawing.sky import shade_depths, shade_sky

STEPS, VEILS = 256, 32
"""Numbers of colours by the angle of the surface, and by how much water is before it."""
OPACITY = 0.55, 0.95
"""How little shows through the surface, 0 to 1, from above and from below."""
LEAST = 0.10
"""Least cosine between the surface and the ray, as short waves have it on a surface that grazes."""
AIR = 8000.0
"""Distance over which air takes the colour of what one sees [m]."""
WINDOW = 0.66
"""Cosine of the angle to the vertical within which the sky is seen from below (Snell)."""


class Shades:
    """Colours of points of the surface, seen from one place.

    Args:
        points: relative to the middle of the sea (n, 3) [m].
        eye: where one looks from (3,) [m], likewise. Below 0 it is under water.
        dimmed: brightness of a picture on the surface, 0 to 1, which the colours make up for.
    """

    def __init__(
        self, points: NDArray[np.floating], eye: NDArray[np.float64], dimmed: float = 1.0
    ) -> None:
        rays = eye - points
        distances = np.linalg.norm(rays, axis=1)
        rays /= np.maximum(distances, 1e-9)[:, None]
        if eye[2] < 0.0:
            rays = -rays
        self._x, self._y, self._z = ((STEPS - 1) * rays.T).astype(np.float32)
        veils = 1.0 - 0.05 ** (distances / DAYLIGHT.visibility) if eye[2] < 0.0 else 0.0 * distances
        self._rows = STEPS * np.rint((VEILS - 1) * veils).astype(np.int32)
        self._table = _tabulate(dimmed, below=bool(eye[2] < 0.0))

    def paint(self, slopes: NDArray[np.floating]) -> NDArray[np.uint32]:
        """Colours (n,) as 0xRRGGBBAA, for slopes (n, 2) of the surface along x and y."""
        cosines = self._z - self._x * slopes[:, 0] - self._y * slopes[:, 1]
        steps = np.clip(cosines, 0.0, STEPS - 1.0).astype(np.int32)
        colours: NDArray[np.uint32] = self._table[self._rows + steps]
        return colours


def see_through(
    colours: NDArray[np.uint32], points: NDArray[np.floating], eye: NDArray[np.float64]
) -> NDArray[np.uint32]:
    """Colours (n,) of opaque points (n, 3) [m] that look as if the deep showed through them.

    In the distance air is before them.
    """
    surface = _to_linear(_unpack(colours)[:, :3] / 255.0)
    rays = points - eye
    behind = _to_linear(shade_depths(DAYLIGHT, rays))
    light = behind + OPACITY[0] * (surface - behind)
    air = 1.0 - np.exp(-np.linalg.norm(rays, axis=1, keepdims=True) / AIR)
    return _pack(_to_screen(light + (_to_linear(np.array(DAYLIGHT.horizon)) - light) * air))


@functools.cache
def _tabulate(dimmed: float, *, below: bool) -> NDArray[np.uint32]:
    """Colours (VEILS * STEPS,) by how much water is before them, and by the cosine."""
    cosine = np.maximum(np.linspace(0.0, 1.0, STEPS), LEAST)[:, None]
    if below:
        # sky within Snell's window, and the deep mirrored around it
        part = np.clip((cosine - WINDOW + 0.12) / 0.24, 0.0, 1.0)
        mirrored = np.array(DAYLIGHT.haze) * 0.85
        colours = mirrored + (np.array(DAYLIGHT.below.colour) - mirrored) * part
    else:
        # Schlick's approximation of Fresnel's reflection
        mirror = 0.02 + 0.98 * (1.0 - cosine) ** 5
        rays = np.hstack([-np.sqrt(1.0 - cosine**2), np.zeros_like(cosine), cosine])
        sky = shade_sky(DAYLIGHT, rays, has_clouds=False)
        deep = np.array(DAYLIGHT.above.colour)
        colours = deep + (sky - deep) * mirror
    veils = np.linspace(0.0, 1.0, VEILS)[:, None, None]
    veiled = (colours + (np.array(DAYLIGHT.haze) - colours) * veils).reshape(-1, 3)
    return _pack(_to_screen(_to_linear(veiled) / _to_linear(np.array(dimmed))))


def _pack(colours: NDArray[np.float64]) -> NDArray[np.uint32]:
    """Colours (n, 3) from 0 to 1 as 0xRRGGBBAA (n,), opaque."""
    bytes_ = np.full((len(colours), 4), 255, np.uint8)
    bytes_[:, :3] = np.rint(255.0 * np.clip(colours, 0.0, 1.0))
    return bytes_.view(">u4").astype(np.uint32).ravel()


def _unpack(colours: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """Red, green, blue, alpha (n, 4) of 0xRRGGBBAA (n,)."""
    return colours.astype(">u4").view(np.uint8).reshape(-1, 4)


def _to_linear(colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """Colours as light adds up, for some as screens show them (IEC 61966-2-1)."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def _to_screen(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """The inverse of `_to_linear`."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)

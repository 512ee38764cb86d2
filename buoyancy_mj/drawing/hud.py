"""`Hud`: time, sea and scale, written over a picture."""

import math

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

TEXT, SHADOW = (255, 255, 255), (0, 20, 30)
HEIGHT = 1.0 / 30.0
"""Height of letters over that of the picture."""
LEAST = 9
"""Least height of letters [pixels]."""
BAR = 1.0 / 5.0
"""Most that the scale is long, over the width of the picture."""


class Hud:
    """What is written over the pictures of a film.

    Args:
        size: width and height of a picture [pixels].
        sea: the sea in a few words.
    """

    def __init__(self, size: tuple[int, int], sea: str) -> None:
        self._width, self._height = size
        self._sea = sea
        self._letters = max(LEAST, round(HEIGHT * self._height))
        self._font = ImageFont.load_default(self._letters)

    def write(self, pixels: NDArray[np.uint8], time: float, pixel: float) -> NDArray[np.uint8]:
        """The same picture (height, width, 3) with time, sea and scale on it.

        Args:
            pixels: the picture.
            time: [s].
            pixel: how much a pixel shows where the vehicles are [m].
        """
        picture = Image.fromarray(pixels)
        draw = ImageDraw.Draw(picture)
        edge = self._letters
        self._text(draw, (edge, edge), f"{time:.2f} s", "la")
        self._text(draw, (edge, self._height - edge), self._sea, "ld")

        # the scale
        length = round_down(BAR * self._width * pixel)
        right, base = self._width - edge, self._height - edge
        left = right - length / pixel
        tick = self._letters // 3
        line = [(left, base - tick), (left, base), (right, base), (right, base - tick)]
        width = max(1, self._letters // 10)
        draw.line([(x + width, y + width) for x, y in line], SHADOW, width)
        draw.line(line, TEXT, width)
        self._text(draw, (0.5 * (left + right), base - tick), _length(length), "md")
        return np.asarray(picture)

    def _text(
        self, draw: ImageDraw.ImageDraw, place: tuple[float, float], text: str, anchor: str
    ) -> None:
        """Write a text with a shadow, which shows on any ground."""
        width = max(1, self._letters // 16)
        draw.text(place, text, TEXT, self._font, anchor, stroke_width=width, stroke_fill=SHADOW)


def round_down(length: float) -> float:
    """The longest of 1, 2 and 5 times a power of ten that is no longer than a length."""
    power = 10.0 ** math.floor(math.log10(length))
    return power * max(part for part in (1.0, 2.0, 5.0) if part * power <= length * (1.0 + 1e-9))


def _length(length: float) -> str:
    """A length with a unit."""
    if length >= 1000.0:
        return f"{length / 1000.0:g} km"
    return f"{length:g} m" if length >= 1.0 else f"{100.0 * length:g} cm"

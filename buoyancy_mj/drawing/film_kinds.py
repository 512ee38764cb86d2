"""Kinds of films: MP4, GIF and WebP, and how each is made of the one that grew."""

import dataclasses
import itertools
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import numpy as np
from PIL import Image

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.files import replace_file

PALETTE_FROM = 12
"""Pictures whose colours a GIF's palette is made of."""
FASTEST_GIF = 50
"""Pictures in a second that viewers of GIF show at most."""


@dataclasses.dataclass(frozen=True)
class Kind:
    """A kind of film."""

    codec: str
    """How it is encoded while it grows, in FFmpeg's words."""
    pixels: str
    """How its pixels are kept then."""
    quality: str
    """The constant rate factor then: 0 loses nothing."""
    finish: Callable[[Path, Path, int], None]
    """Makes the film at the second path of the one that grew at the first, for a rate [1/s]."""

    def check(self, path: Path, size: tuple[int, int], fps: int) -> None:
        """Check that there is such a film.

        Raises:
            RecordingError: it has an odd size, or is too fast.
        """
        if self.pixels == "yuv420p" and any(side % 2 for side in size):
            width, height = (side + side % 2 for side in size)
            raise RecordingError(
                f"the size is {size[0]}x{size[1]}, and MP4 takes even numbers of pixels; take "
                f"{width}x{height}"
            )
        if path.suffix == ".gif" and fps > FASTEST_GIF:
            raise RecordingError(
                f"fps is {fps}, and a GIF shows {FASTEST_GIF} pictures in a second at most; take "
                f"{FASTEST_GIF} or less"
            )


def _make_mp4(source: Path, path: Path, _: int) -> None:
    """Put the pictures, as they are encoded, into an MP4 that plays while it loads."""
    options = {"movflags": "+faststart"}
    with (
        replace_file(path) as part,
        av.open(source) as film,
        av.open(part, "w", format="mp4", options=options) as made,
    ):
        stream = made.add_stream_from_template(film.streams.video[0])
        for packet in film.demux(video=0):
            # the last one is empty
            if packet.size:
                packet.stream, packet.dts = stream, packet.pts
                made.mux(packet)


def _make_gif(source: Path, path: Path, fps: int) -> None:
    """Make a GIF with one palette for all pictures."""
    count = sum(1 for _ in _read_pictures(source))
    sample = [one for row, one in enumerate(_read_pictures(source)) if row % _stride(count) == 0]
    mosaic = Image.fromarray(np.concatenate([np.asarray(one) for one in sample]))
    palette = mosaic.quantize(256, method=Image.Quantize.MEDIANCUT)
    pictures = (one.quantize(palette=palette) for one in _read_pictures(source))
    # times are in hundredths of a second there
    ends = [round(100.0 * row / fps) for row in range(count + 1)]
    durations = [10 * (end - start) for start, end in itertools.pairwise(ends)]
    _save(pictures, path, duration=durations, optimize=False)


def _make_webp(source: Path, path: Path, fps: int) -> None:
    """Make an animated WebP."""
    count = sum(1 for _ in _read_pictures(source))
    ends = [round(1000.0 * row / fps) for row in range(count + 1)]
    durations = [end - start for start, end in itertools.pairwise(ends)]
    _save(_read_pictures(source), path, duration=durations, quality=80, method=4)


def _save(pictures: Iterator[Image.Image], path: Path, **options: object) -> None:
    """Save pictures as an animation that repeats for ever."""
    with replace_file(path) as part:
        first = next(pictures)
        first.save(part, save_all=True, append_images=pictures, loop=0, **options)


def _stride(count: int) -> int:
    """Each how many pictures one is looked at for the palette."""
    return max(1, count // PALETTE_FROM)


def _read_pictures(path: Path) -> Iterator[Image.Image]:
    """The pictures of a film."""
    with av.open(path) as film:
        for frame in film.decode(video=0):
            yield frame.to_image()


KINDS = {
    ".mp4": Kind("libx264", "yuv420p", "18", _make_mp4),
    ".gif": Kind("libx264rgb", "rgb24", "10", _make_gif),
    ".webp": Kind("libx264rgb", "rgb24", "10", _make_webp),
}
"""Kinds of films by the ends of their names."""

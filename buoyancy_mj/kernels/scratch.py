"""`Scratch`: arrays to work in, for one thread."""

import math
import mmap
from collections.abc import Mapping, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import cuts, halving, swell
from buoyancy_mj.kernels.arrays import Corners, Doubles, Field, fields
from buoyancy_mj.kernels.blocks import BlockStore
from buoyancy_mj.kernels.heads import HEAD
from buoyancy_mj.kernels.quadrature import AREA, PLACES
from buoyancy_mj.kernels.tiles import TileStore

_PRIVATE: Mapping[str, Any] = (
    {"flags": mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS} if hasattr(mmap, "MAP_PRIVATE") else {}
)
"""What keeps memory from being shared with other processes; Windows shares none."""


class CutScratch(NamedTuple):
    """For `clip` and `waterplane`."""

    seen: Annotated[Doubles, (4, "v")]
    """The vertices of a leaf, seen from above, and their depths under plane and surface."""
    sorted: Annotated[Corners, (4, "v")]
    """The faces of a leaf, sorted by `leaves`."""
    cuts: Annotated[Doubles, (cuts.ROOM,)]
    """The triangles of `cuts`."""
    stack: Annotated[Doubles, (halving.DEEP, halving.COLUMNS)]
    """The triangles of `halving`."""
    swell: Annotated[Doubles, ("w", swell.COLUMNS)]
    """The near waves of `swell`."""
    store: TileStore
    """The tiles of the sea that are known."""


class PressureScratch(NamedTuple):
    """For `pressure`."""

    store: BlockStore
    """The blocks of the sea that are known."""
    points: Annotated[Doubles, (AREA + 3, PLACES)]
    """The points of `quadrature`."""
    corners: Annotated[Doubles, (HEAD + 1, "v")]
    """The vertices of a leaf, in the world, and their depths."""
    sums: Annotated[Doubles, (6,)]
    """Force and torque."""


class Scratch(NamedTuple):
    """Arrays that kernels write to. From one call to the next they hold tiles and blocks alone."""

    cut: CutScratch
    pressure: PressureScratch


def new_scratches(count: int, vertices: int, waves: int) -> list[Scratch]:
    """Scratches for leaves of so many vertices, and for so many waves.

    Each array of all of them is one block, of which what nobody writes to costs no memory.
    """
    return _new_blocks(Scratch, count, {"v": vertices, "w": waves})


def _new_blocks(kind: type, count: int, sizes: Mapping[str, int]) -> list[Any]:
    """Scratch of a kind, `count` times, whose arrays are parts of one block each."""
    parts = [
        _new_blocks(field, count, sizes)
        if not isinstance(field, Field)
        else list(_new_block((count, *_lengths(field, sizes)), field.dtype))
        for field in fields(kind)
    ]
    return [kind(*members) for members in zip(*parts, strict=True)]


def _new_block(shape: Sequence[int], dtype: Any) -> NDArray[Any]:
    """An array of zeros, whose pages come from the system when they are written to.

    Those of `numpy.zeros` do so only as long as the heap has no room for them.
    """
    # at least one byte, and not shared with children that are forked
    count = math.prod(shape)
    size = max(count * np.dtype(dtype).itemsize, 1)
    room = mmap.mmap(-1, size, **_PRIVATE)
    return np.frombuffer(room, dtype, count).reshape(shape)


def _lengths(field: Field, sizes: Mapping[str, int]) -> list[int]:
    """The shape of a field."""
    return [sizes[n] if isinstance(n, str) else n for n in field.shape]

"""`Scratch`: arrays to work in, for one thread."""

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels import cuts, local, swell
from buoyancy_mj.kernels.arrays import Corners, Doubles, Words, leaves
from buoyancy_mj.kernels.expansions import NODES
from buoyancy_mj.kernels.quadrature import PLACES


class CutScratch(NamedTuple):
    """For `clip` and `waterplane`."""

    seen: Annotated[Doubles, (6, "v")]
    """The vertices of a leaf, seen from above, their depths, and what these are found by."""
    sorted: Annotated[Corners, (3, "v")]
    """The faces of a leaf, sorted by `leaves`."""
    cuts: Annotated[Doubles, (cuts.ROOM,)]
    """The triangles of `cuts`."""
    swell: Annotated[Doubles, ("w", swell.COLUMNS)]
    """The near waves of `swell`."""
    flat: Annotated[Doubles, (local.FLAT,)]
    """The polynomial of `swell`."""


class PressureScratch(NamedTuple):
    """For `pressure`."""

    depths: Annotated[Doubles, ("v",)]
    """Depths of the vertices of a leaf."""
    corners: Annotated[Doubles, (local.ROOM, "v")]
    """A room of `local` for the vertices of a leaf."""
    near: Annotated[Doubles, ("n",)]
    """The waves around a hull, a row of `local`."""
    points: Annotated[Doubles, (local.ROOM + 3, PLACES)]
    """The points of `quadrature`."""
    asked: Annotated[Doubles, (local.ROOM, PLACES)]
    """The places of `expansions`."""
    nodes: Annotated[Words, (NODES,)]
    """The nodes of `expansions`."""
    sums: Annotated[Doubles, (6,)]
    """Force and torque on triangles."""
    turned: Annotated[Doubles, (6,)]
    """Force and torque on nodes, in the frame of the hull."""


class Scratch(NamedTuple):
    """Arrays that kernels write to and that hold nothing from one call to the next."""

    cut: CutScratch
    pressure: PressureScratch


def new_scratches(count: int, vertices: int, waves: int) -> list[Scratch]:
    """Scratches for leaves of so many vertices, and no more faces, and for so many waves.

    Each array of all of them is one block: of a large block, what nobody writes to costs no memory.
    """
    sizes = {"v": vertices, "w": waves, "n": local.NEAR + local.WAVE * waves}
    cut, pressure = (_new_blocks(kind, count, sizes) for kind in (CutScratch, PressureScratch))
    return [
        Scratch(
            CutScratch(*(block[i] for block in cut)),
            PressureScratch(*(block[i] for block in pressure)),
        )
        for i in range(count)
    ]


def _new_blocks(kind: type, count: int, sizes: Mapping[str, int]) -> list[NDArray[Any]]:
    """A block for each array of a kind of scratch, `count` times its shape."""
    return [
        np.empty((count, *(sizes[n] if isinstance(n, str) else n for n in leaf.shape)), leaf.dtype)
        for leaf in leaves(kind)
    ]

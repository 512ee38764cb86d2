"""`Scratch`: arrays to work in, for one thread."""

from typing import Annotated, NamedTuple

import numpy as np

from buoyancy_mj.kernels import local, swell
from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.expansions import NODES
from buoyancy_mj.kernels.quadrature import PLACES


class CutScratch(NamedTuple):
    """For `clip` and `waterplane`."""

    depths: Annotated[Doubles, (5, "v")]
    """Depths of the vertices of a leaf, and what they are found by."""
    swell: Annotated[Doubles, ("w", swell.COLUMNS)]
    """The near waves of `swell`."""
    flat: Annotated[Doubles, (local.FLAT,)]
    """The polynomial of `swell`."""
    ray: Annotated[Doubles, (local.MOST + 1,)]
    """That polynomial along a ray."""


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


def new_scratch(vertices: int, waves: int) -> Scratch:
    """Scratch for leaves of so many vertices, and for so many waves."""
    cut = CutScratch(
        depths=np.empty((5, vertices)),
        swell=np.empty((waves, swell.COLUMNS)),
        flat=np.empty(local.FLAT),
        ray=np.empty(local.MOST + 1),
    )
    pressure = PressureScratch(
        depths=np.empty(vertices),
        corners=np.empty((local.ROOM, vertices)),
        near=np.empty(local.NEAR + local.WAVE * waves),
        points=np.empty((local.ROOM + 3, PLACES)),
        asked=np.empty((local.ROOM, PLACES)),
        nodes=np.empty(NODES, np.int64),
        sums=np.empty(6),
        turned=np.empty(6),
    )
    return Scratch(cut, pressure)

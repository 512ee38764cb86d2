"""`Hulls`: meshes packed into one set of arrays, with the names of the columns of its rows."""

from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Corners, Doubles, Words
from buoyancy_mj.kernels.blocks import Blocks
from buoyancy_mj.kernels.rules import POINTS
from buoyancy_mj.kernels.tiles import Tiles

WHOLE_VOLUME, WHOLE_CENTROID, WHOLE_AREA, WHOLE_MIDDLE, WHOLE_HALF = 0, 1, 4, 5, 8
FILL, ALLOWED, COLUMNS = 11, 12, 13
"""Columns of `Hulls.whole`, and how many: volume that the whole hull displaces, its centroid (3),
the area of its faces, middle (3) and half sides (3) of its bounding box, the part of its volume
that displaces water, and by how much a straight edge that lies in the surface may be off, see
`halving` [m]."""


class Hulls(NamedTuple):
    """All hulls of a model, each in its own frame, and the trees over their triangles."""

    vertices: Annotated[Doubles, ("v", 3)]
    """Of all meshes [m]; leaf by leaf, so that leaves share none."""
    faces: Annotated[Corners, ("f", 3)]
    """Indices into the vertices, in the order of the leaves."""
    areas: Annotated[Doubles, ("f", 3)]
    """Vector area of each face, times the part of its hull that displaces [m^2]."""
    sizes: Annotated[Doubles, ("f",)]
    """Area of each face [m^2]."""
    nodes: Annotated[Words, ("h",)]
    """First node of each hull, from which `tree.BEHIND` leads to its end. Hulls of one mesh that
    displace in the same part share their nodes."""
    spans: Annotated[Words, ("n", 5)]
    """What lies under each node."""
    boxes: Annotated[Doubles, ("n", 6)]
    """Bounding box of each node: middle and half sides [m]."""
    moments: Annotated[Doubles, ("n", 31)]
    """Moments of the vector area under each node, times the part that displaces; and the area."""
    rules: Annotated[Doubles, ("r", 3 * POINTS)]
    """Vector areas of the points of each node's rule, times the part that displaces, see `rules`;
    none where nobody asks for pressures."""
    edges: Annotated[Doubles, ("n",)]
    """Longest edge of the faces of each leaf, 0 for other nodes [m]."""
    whole: Annotated[Doubles, ("h", COLUMNS)]
    """Each hull as a whole, in columns `WHOLE_VOLUME` to `ALLOWED`."""
    typical: Annotated[Doubles, ("d",)]
    """Typical wave numbers of the sea by depth, see `pressure.typical` [rad/m]."""
    tiles: Tiles
    """The surface around them."""
    blocks: Blocks
    """The pressure around them."""
    frames: Annotated[Words, ("h",)]
    """Index of the frame of each hull among the geoms."""

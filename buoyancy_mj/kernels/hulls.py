"""`Hulls`: meshes packed into one set of arrays, with the names of the columns of its rows."""

from typing import Annotated, NamedTuple

from buoyancy_mj.kernels.arrays import Corners, Doubles, Words

WHOLE_VOLUME, WHOLE_CENTROID, WHOLE_AREA, WHOLE_MIDDLE, WHOLE_HALF = 0, 1, 4, 5, 8
FILL, DEGREE, LIMIT, BOTTOM_DEGREE = 11, 12, 13, 14
"""Columns of `Hulls.whole`: volume that the whole hull displaces, its centroid (3), the area of its
faces, middle (3) and half sides (3) of its bounding box, the part of its volume that displaces
water, and its `planning.plan` (3)."""
AREA_OF_FACE = 3
"""Column of `Hulls.areas` behind the vector area (3)."""


class Hulls(NamedTuple):
    """All hulls of a model, each in its own frame, and the trees over their triangles."""

    vertices: Annotated[Doubles, ("v", 3)]
    """Of all meshes [m]; leaf by leaf, so that leaves share none."""
    faces: Annotated[Corners, ("f", 3)]
    """Indices into the vertices, in the order of the leaves."""
    areas: Annotated[Doubles, ("f", 4)]
    """Vector area of each face, times the part of its hull that displaces, and its area [m^2]."""
    nodes: Annotated[Words, ("h",)]
    """First node of each hull, from which `tree.BEHIND` leads to its end. Hulls of one mesh that
    displace in the same part share their nodes."""
    spans: Annotated[Words, ("n", 5)]
    """What lies under each node."""
    boxes: Annotated[Doubles, ("n", 6)]
    """Bounding box of each node: middle and half sides [m]."""
    moments: Annotated[Doubles, ("n", 31)]
    """Moments of the vector area under each node, times the part that displaces; and the area."""
    whole: Annotated[Doubles, ("h", 15)]
    """Each hull as a whole, in columns `WHOLE_VOLUME` to `BOTTOM_DEGREE`."""
    typical: Annotated[Doubles, ("d",)]
    """Typical wave numbers of the sea by depth, see `pressure.typical` [rad/m]."""
    frames: Annotated[Words, ("h",)]
    """Index of the frame of each hull among the geoms."""

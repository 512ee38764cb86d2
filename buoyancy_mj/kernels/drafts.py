"""The draft of a vehicle: the depth of the deepest corner of its hulls, found among a few.

The corners of each body stand in a tree of boxes. Within a radius the surface leaves its tangent
plane by no more than half its greatest curvature times the square of the radius, so that few boxes,
and of these few corners, can hold the deepest.
"""

import math
from typing import Annotated, NamedTuple

from numba import int64

from buoyancy_mj.kernels.arrays import Doubles, Words
from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.vectors import place, rotate_back, triple
from buoyancy_mj.kernels.waves import ROWS, elevation, tangent

BODY, FIRST, LAST, NEXT, SPAN = range(5)
"""Columns of a box's words: its body, its first corner and the one after its last, and the box that
follows after all that are inside it; their number. The boxes inside one follow it at once."""
CENTRE, HALF, RADIUS, SIZE = 0, 3, 6, 7
"""Columns of a box's numbers: its centre (3) and half lengths (3), and the greatest distance of a
corner in it from the body's origin; their number."""
HAIR = 1e-9
"""Rounding of a depth [m], at most."""


class Corners(NamedTuple):
    """The corners of a vehicle, and the surface over them."""

    corners: Annotated[Doubles, ("n", 3)]
    """Those of the convex hulls of its bodies, in the frames of these [m]."""
    spans: Annotated[Words, ("m", SPAN)]
    """Which of them each box holds."""
    boxes: Annotated[Doubles, ("m", SIZE)]
    """Where the boxes are [m]."""
    root: int
    """Index of the root body."""
    waves: Annotated[Doubles, (ROWS, "w")]
    """The waves, see `kernels.waves`."""
    level: float
    """Height of the still surface [m]."""
    curvature: float
    """Greatest curvature of the surface [1/m]."""


class Plane(NamedTuple):
    """A plane that touches the surface."""

    x: float
    """Where it does [m]."""
    y: float
    """Where it does [m]."""
    height: float
    """The surface there [m]."""
    along: float
    """How it rises along x."""
    across: float
    """How it rises along y."""


@njit(cache=True, error_model="numpy")
def find_draft(known, xpos, xmat, time, least):
    """Depth [m] of the deepest corner in poses (nbody, 3), (nbody, 9) at a time [s].

    Args:
        known: the `Corners`.
        xpos: origins of all bodies [m].
        xmat: their rotations world_from_body.
        time: [s].
        least: depth [m] of which it is asked whether a corner is deeper; it is given back if none
            is.
    """
    corners, spans = known.corners, known.spans
    x, y = xpos[known.root, 0], xpos[known.root, 1]
    plane = _touch(known, x, y, time)
    leaf = _descend(known, xpos, xmat, plane, least)
    if leaf < 0:
        return least

    # a corner that is deep
    body, depth, deep = spans[leaf, BODY], -math.inf, spans[leaf, FIRST]
    for n in range(spans[leaf, FIRST], spans[leaf, LAST]):
        under = _under(plane, _corner(corners, n, xpos[body], xmat[body]))
        if under > depth:
            depth, deep = under, n
    x, y, z = _corner(corners, deep, xpos[body], xmat[body])
    best = max(least, known.level + elevation(known.waves, x, y, time) - z)
    near = _touch(known, x, y, time) if known.curvature > 0.0 else plane

    # all others that may be deeper
    box = int64(0)
    while box < spans.shape[0]:
        if _bound(known, xpos, xmat, plane, box) <= best:
            box = spans[box, NEXT]
            continue
        if spans[box, NEXT] == box + 1:
            body = spans[box, BODY]
            for n in range(spans[box, FIRST], spans[box, LAST]):
                x, y, z = _corner(corners, n, xpos[body], xmat[body])
                away = (x - near.x) ** 2 + (y - near.y) ** 2
                if _under(near, (x, y, z)) + 0.5 * known.curvature * away + HAIR > best:
                    best = max(best, known.level + elevation(known.waves, x, y, time) - z)
        box += 1
    return best


@njit(cache=True, error_model="numpy")
def _descend(known, xpos, xmat, plane, least):
    """The innermost box that reaches deep under a plane; -1 if no corner may be under `least`."""
    spans = known.spans
    most, top, box = -math.inf, -1, int64(0)
    while box < spans.shape[0]:
        if not _bound(known, xpos, xmat, plane, box) <= least:
            reach = _reach(known, xpos, xmat, plane, box)
            if top < 0 or reach > most:
                most, top = reach, box
        box = spans[box, NEXT]
    while top >= 0 and spans[top, NEXT] > top + 1:
        one, two = top + 1, spans[top + 1, NEXT]
        deeper = _reach(known, xpos, xmat, plane, two) > _reach(known, xpos, xmat, plane, one)
        top = two if deeper else one
    return top


@njit(cache=True, error_model="numpy")
def _bound(known, xpos, xmat, plane, box):
    """Depth [m] that no corner in a box exceeds, by the plane that touches the surface at the root.

    The box is at most its distance and its radius away from there.
    """
    body, root = known.spans[box, BODY], known.root
    away = math.hypot(xpos[body, 0] - xpos[root, 0], xpos[body, 1] - xpos[root, 1])
    away += known.boxes[box, RADIUS]
    reach = _reach(known, xpos, xmat, plane, box)
    return reach + 0.5 * known.curvature * away * away + HAIR


@njit(cache=True, error_model="numpy")
def _touch(known, x, y, time):
    """The plane that touches the surface over a place."""
    eta, along, across = tangent(known.waves, x, y, time)
    return Plane(x, y, known.level + eta, along, across)


@njit(cache=True, error_model="numpy")
def _corner(corners, n, origin, r):
    """A corner in the world [m]."""
    x, y, z = triple(corners, n, 0)
    return place(origin, r, x, y, z)


@njit(cache=True, error_model="numpy")
def _under(plane, point):
    """Depth under a plane of a point [m]."""
    x, y, z = point
    return plane.height + plane.along * (x - plane.x) + plane.across * (y - plane.y) - z


@njit(cache=True, error_model="numpy")
def _reach(known, xpos, xmat, plane, box):
    """Depth under a plane [m] of the deepest corner of a box itself."""
    boxes, body = known.boxes, known.spans[box, BODY]
    r = xmat[body]
    g0, g1, g2 = rotate_back(r, plane.along, plane.across, -1.0)
    h0, h1, h2 = triple(boxes, box, HALF)
    c0, c1, c2 = triple(boxes, box, CENTRE)
    middle = place(xpos[body], r, c0, c1, c2)
    return _under(plane, middle) + abs(g0) * h0 + abs(g1) * h1 + abs(g2) * h2

"""Triangles near the surface, halved until straight cuts follow the waves.

A straight edge of length l differs from a surface of curvature c by up to c l^2 / 8. That matters
where the edge lies nearly in the surface: where it crosses steeply, what is cut off wrongly is thin
and shallow. An edge that needs it is halved, and the surface found above its middle. Whether it
needs it depends on the edge alone, so that neighbours agree on every edge they share.

A triangle stands in a row: for each corner x, y seen from above, its depth d under a plane, and its
depth w under the surface; then its part of the area of the face that it belongs to.
"""

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.surface import tangent_at

CORNER, PART, COLUMNS = 4, 12, 13
"""Columns of a corner; the column of the part of the area; how many there are."""
DEEP = 48
"""Triangles that wait at most: as many as one is halved, one after the other, and one more."""
STEEP = 1.0
"""The part of what is allowed, about twice over, that is left where edges cross steeply."""
_THREE = (0, 1, 2)


@njit(cache=True, error_model="numpy", inline="always")
def bends(ax, ay, aw, bx, by, bw, curvature, allowed):
    """Whether an edge is to be halved: a surface so curved may be off by more than is allowed."""
    off = 0.125 * curvature * ((ax - bx) * (ax - bx) + (ay - by) * (ay - by))
    near = min(abs(aw), abs(bw)) < off or (aw > 0.0) != (bw > 0.0)
    return near and off * off > allowed * max(STEEP * abs(aw - bw), off)


@njit(cache=True, error_model="numpy", _nrt=False)
def split(stack, top, curvature, allowed, sea, place, touch, time):
    """Halve the triangle on top of a stack if one of its edges bends, see `bends`.

    The longest that bends is halved, and two triangles stand there instead of one.

    Args:
        stack: rows of triangles (DEEP, COLUMNS).
        top: the row of the triangle.
        curvature: bound of the surface's [1/m].
        allowed: by how much a straight edge that lies in the surface may be off [m].
        sea: `tiles.Tiles`, and a `tiles.TileStore`.
        place: where x and y count from (2,) [m].
        touch: elevation there of the plane that d is the depth under, and its gradient (2,).
        time: [s].

    Returns:
        The row on top then.
    """
    if top + 1 >= DEEP:
        return top
    longest, first = 0.0, -1
    for a in _THREE:
        i, j = CORNER * a, CORNER * ((a + 1) % 3)
        ax, ay, aw = stack[top, i], stack[top, i + 1], stack[top, i + 3]
        bx, by, bw = stack[top, j], stack[top, j + 1], stack[top, j + 3]
        length = (ax - bx) * (ax - bx) + (ay - by) * (ay - by)
        if length > longest and bends(ax, ay, aw, bx, by, bw, curvature, allowed):
            longest, first = length, a
    if first < 0:
        return top

    # the middle of the edge, where neighbours find the same
    i, j = CORNER * first, CORNER * ((first + 1) % 3)
    x, y = 0.5 * (stack[top, i] + stack[top, j]), 0.5 * (stack[top, i + 1] + stack[top, j + 1])
    d = 0.5 * (stack[top, i + 2] + stack[top, j + 2])
    tiles, store = sea
    eta, _, _ = tangent_at(tiles, store, place[0] + x, place[1] + y, time)
    w = d + eta - (touch[0] + touch[1] * x + touch[2] * y)
    for c in range(COLUMNS):
        stack[top + 1, c] = stack[top, c]
    for row, corner in ((top, j), (top + 1, i)):
        stack[row, corner], stack[row, corner + 1] = x, y
        stack[row, corner + 2], stack[row, corner + 3] = d, w
        stack[row, PART] *= 0.5
    return top + 1

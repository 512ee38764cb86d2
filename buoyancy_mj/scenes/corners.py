"""Corners of a vehicle's hulls in a tree of boxes, among which compiled code finds the deepest."""

from collections.abc import Sequence

import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.kernels.drafts import (
    BODY,
    CENTRE,
    FIRST,
    HALF,
    LAST,
    NEXT,
    RADIUS,
    SIZE,
    SPAN,
    Corners,
)
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.sea.water import Water

LEAF = 16
"""Most corners of an innermost box."""


def gather_corners(vehicle: Vehicle, water: Water) -> Corners:
    """The corners of a vehicle that can be deepest, and the waves over them.

    The deepest point of a body is a corner of one of its convex hulls.

    Args:
        vehicle: the vehicle.
        water: the sea.
    """
    corners: list[NDArray[np.float64]] = []
    spans: list[list[int]] = []
    boxes: list[NDArray[np.float64]] = []
    for body in sorted({hull.body for hull in vehicle.hulls}):
        _grow(_convex_corners(vehicle.hulls, body), body, corners, spans, boxes)
    amplitude, kx, ky, *_ = water.rows.T
    return Corners(
        corners=np.concatenate(corners),
        spans=np.array(spans),
        boxes=np.array(boxes),
        root=vehicle.root,
        waves=water.table,
        level=water.level,
        curvature=float(np.abs(amplitude) @ (kx * kx + ky * ky)),
    )


def _grow(
    points: NDArray[np.float64],
    body: int,
    corners: list[NDArray[np.float64]],
    spans: list[list[int]],
    boxes: list[NDArray[np.float64]],
) -> None:
    """Add the box of points (n, 3) [m] of a body and those inside it, halved along long sides."""
    low, high = points.min(axis=0), points.max(axis=0)
    box = np.zeros(SIZE)
    box[CENTRE : CENTRE + 3] = 0.5 * (low + high)
    box[HALF : HALF + 3] = 0.5 * (high - low)
    box[RADIUS] = np.linalg.norm(points, axis=1).max()
    boxes.append(box)
    span = [0] * SPAN
    spans.append(span)
    first = sum(map(len, corners))
    if len(points) <= LEAF:
        corners.append(points)
    else:
        order = np.argsort(points[:, np.argmax(high - low)], kind="stable")
        for half in np.array_split(points[order], 2):
            _grow(half, body, corners, spans, boxes)
    span[BODY], span[FIRST], span[LAST], span[NEXT] = body, first, first + len(points), len(spans)


def _convex_corners(hulls: Sequence[Hull], body: int) -> NDArray[np.float64]:
    """Vertices (n, 3) [m] of the convex hulls of a body's hulls, in its frame."""
    corners = []
    for vertices in (hull.mesh_in_body.vertices for hull in hulls if hull.body == body):
        try:
            corners.append(vertices[scipy.spatial.ConvexHull(vertices).vertices])
        except scipy.spatial.QhullError:
            # so thin that it has no convex hull
            corners.append(vertices)
    return np.vstack(corners)

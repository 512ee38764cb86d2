"""Parts of a mesh in the order or at the heights that the source paper's methods ask for."""

import numpy as np

from buoyancy_mj.kernels.compiling import njit
from buoyancy_mj.kernels.triangles import lone_corner, turn
from buoyancy_mj.kernels.vectors import rotate, triple
from buoyancy_mj.kernels.waves import elevation


@njit(cache=True, error_model="numpy")
def place(
    vertices,  # (v, 3) in the frame of the hull
    order,  # (n,) which of them, one after the other
    until_dry,  # stop behind the first that is dry
    origin,  # (3,) of the frame in the world
    r,  # (9,) world_from_frame, row-major
    level,
    waves,  # see `waves`
    time,
    out,  # (>= n, 4) x, y, z relative to the origin, turned as the world, and depth
):
    """Place vertices in the world; how many were looked at."""
    for n in range(order.shape[0]):
        x, y, z = triple(vertices, order[n], 0)
        out[n, 0], out[n, 1], out[n, 2] = rotate(r, x, y, z)
        surface = level + elevation(waves, origin[0] + out[n, 0], origin[1] + out[n, 1], time)
        out[n, 3] = surface - (origin[2] + out[n, 2])
        if until_dry and not out[n, 3] > 0.0:
            return n + 1
    return order.shape[0]


@njit(cache=True, error_model="numpy")
def sections(
    points,  # (v, 3) in axes u, v, s, right-handed
    faces,  # (f, 3)
    heights,  # (n,) ascending values of s
    out,  # (n, 3) area and its first moments int u dA, int v dA
):
    """Write cross-sections of a closed mesh perpendicular to s, just above each height, to `out`.

    Returns how many triangles they meet.

    Each triangle that a section meets gives it one edge, its inside on the left, and by Green the
    area is half the sum of cross products of the edges' ends: no contour has to be joined up.
    """
    out[:, :] = 0.0
    crossings = 0
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        low = min(points[a, 2], points[b, 2], points[c, 2])
        high = max(points[a, 2], points[b, 2], points[c, 2])
        first = np.searchsorted(heights, low)
        for i in range(first, heights.shape[0]):
            s = heights[i]
            if s >= high:
                break
            crossings += 1
            # turn the triangle so that corner p is alone on its side
            lone = lone_corner(points[a, 2] > s, points[b, 2] > s, points[c, 2] > s)
            p, q, r = turn(lone, a, b, c)
            x, y, z = triple(points, p, 0)
            up = z > s
            j, k = (s - z) / (points[q, 2] - z), (s - z) / (points[r, 2] - z)
            u0, v0 = x + j * (points[q, 0] - x), y + j * (points[q, 1] - y)
            u1, v1 = x + k * (points[r, 0] - x), y + k * (points[r, 1] - y)
            cross = u0 * v1 - u1 * v0 if up else u1 * v0 - u0 * v1
            out[i, 0] += cross / 2.0
            out[i, 1] += cross * (u0 + u1) / 6.0
            out[i, 2] += cross * (v0 + v1) / 6.0
    return crossings

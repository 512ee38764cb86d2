"""Parts of a mesh in the order or at the heights that the source paper's methods ask for."""

from numba import njit

from buoyancy_mj.kernels.waves import elevation


@njit(cache=True, error_model="numpy")
def place(
    vertices,  # (v, 3) in the frame of the hull
    order,  # (n,) which of them, one after the other
    until_dry,  # stop behind the first that is dry
    origin,  # (3,) of the frame in the world
    r,  # (9,) world_from_frame, row-major
    level,
    waves,  # (w, 6)
    time,
    out,  # (>= n, 4) x, y, z relative to the origin, turned as the world, and depth
):
    """Place vertices in the world; how many were looked at."""
    for n in range(order.shape[0]):
        x, y, z = vertices[order[n], 0], vertices[order[n], 1], vertices[order[n], 2]
        out[n, 0] = r[0] * x + r[1] * y + r[2] * z
        out[n, 1] = r[3] * x + r[4] * y + r[5] * z
        out[n, 2] = r[6] * x + r[7] * y + r[8] * z
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
    """Cross-sections of a closed mesh perpendicular to s, just above each height; how many triangles they meet.

    Each triangle that a section meets gives it one edge, its inside on the left, and by Green the
    area is half the sum of cross products of the edges' ends: no contour has to be joined up.
    """
    out[:, :] = 0.0
    crossings = 0
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        low = min(points[a, 2], points[b, 2], points[c, 2])
        high = max(points[a, 2], points[b, 2], points[c, 2])
        # the first height not below the lowest corner
        first, end = 0, heights.shape[0]
        while first < end:
            middle = (first + end) // 2
            if heights[middle] < low:
                first = middle + 1
            else:
                end = middle
        for i in range(first, heights.shape[0]):
            s = heights[i]
            if s >= high:
                break
            crossings += 1
            # turn the triangle so that corner p is alone on its side
            up_a, up_b, up_c = points[a, 2] > s, points[b, 2] > s, points[c, 2] > s
            if up_b == up_c:
                p, q, r, up = a, b, c, up_a
            elif up_a == up_c:
                p, q, r, up = b, c, a, up_b
            else:
                p, q, r, up = c, a, b, up_c
            x, y, z = points[p, 0], points[p, 1], points[p, 2]
            j, k = (s - z) / (points[q, 2] - z), (s - z) / (points[r, 2] - z)
            u0, v0 = x + j * (points[q, 0] - x), y + j * (points[q, 1] - y)
            u1, v1 = x + k * (points[r, 0] - x), y + k * (points[r, 1] - y)
            cross = u0 * v1 - u1 * v0 if up else u1 * v0 - u0 * v1
            out[i, 0] += cross / 2.0
            out[i, 1] += cross * (u0 + u1) / 6.0
            out[i, 2] += cross * (v0 + v1) / 6.0
    return crossings

"""A mesh as parallel rays see it: what they meet first, and how often it encloses space."""

import math

import numpy as np
from numba import boolean

from buoyancy_mj.kernels.compiling import inner, njit


@njit(cache=True, error_model="numpy", inline="always")
def _left(u, v, i, j, x, y):
    """Whether (x, y) lies left of the edge from i to j.

    The two faces of an edge never agree, so no ray slips between them.
    """
    if i < j:
        return (u[j] - u[i]) * (y - v[i]) - (v[j] - v[i]) * (x - u[i]) >= 0.0
    return not (u[i] - u[j]) * (y - v[j]) - (v[i] - v[j]) * (x - u[j]) >= 0.0


@njit(cache=True, error_model="numpy", inline="always")
def _covers(u, v, face, x, y):
    """1 where a face that winds left covers (x, y), -1 where it winds right, else 0."""
    left = _left(u, v, face[0], face[1], x, y)
    if _left(u, v, face[1], face[2], x, y) != left or _left(u, v, face[2], face[0], x, y) != left:
        return 0
    return 1 if left else -1


@njit(cache=True, error_model="numpy", inline="always")
def _height(x, y, z, face, px, py):
    """Height of a face's plane over (px, py), held within the face."""
    i, j, k = face[0], face[1], face[2]
    twice = (x[j] - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (y[j] - y[i])
    low, high = min(z[i], z[j], z[k]), max(z[i], z[j], z[k])
    if twice == 0.0:
        return 0.5 * (low + high)
    s = ((px - x[i]) * (y[k] - y[i]) - (x[k] - x[i]) * (py - y[i])) / twice
    t = ((x[j] - x[i]) * (py - y[i]) - (px - x[i]) * (y[j] - y[i])) / twice
    return min(max(z[i] + s * (z[j] - z[i]) + t * (z[k] - z[i]), low), high)


@njit(cache=True, error_model="numpy", inline="always")
def _cells(a, b, c, low, step, count):
    """First and last grid line whose centre lies between the extremes of three coordinates."""
    first = int(math.ceil((min(a, b, c) - low) / step - 0.5))
    last = int(math.floor((max(a, b, c) - low) / step - 0.5))
    return max(first, 0), min(last, count - 1)


@njit(cache=True, error_model="numpy")
def see(u, v, w, faces, low, step, seen):
    """Write the face that a ray along w meets first, and the one that it meets last.

    Rays run through the centres of cells, low + (i + 1/2) step along u and v. The indices go to
    `seen` (2, n, m); it keeps what it holds where a ray meets nothing. A ray enters a closed mesh
    where faces wind right, and leaves it where they wind left.
    """
    depths = np.full(seen.shape, math.inf)
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        twice = (u[j] - u[i]) * (v[k] - v[i]) - (u[k] - u[i]) * (v[j] - v[i])
        if twice == 0.0:
            continue
        side = int(twice > 0.0)

        # its plane, turned so that what is met first or last is least
        sign = 1.0 if side == 0 else -1.0
        along_u = sign * ((w[j] - w[i]) * (v[k] - v[i]) - (w[k] - w[i]) * (v[j] - v[i])) / twice
        along_v = sign * ((u[j] - u[i]) * (w[k] - w[i]) - (u[k] - u[i]) * (w[j] - w[i])) / twice
        lowest, highest = sign * w[i], sign * w[i]
        for corner in (j, k):
            lowest, highest = min(lowest, sign * w[corner]), max(highest, sign * w[corner])
        first_u, last_u = _cells(u[i], u[j], u[k], low[0], step[0], seen.shape[1])
        first_v, last_v = _cells(v[i], v[j], v[k], low[1], step[1], seen.shape[2])
        for p in range(first_u, last_u + 1):
            x = low[0] + (p + 0.5) * step[0]
            for q in range(first_v, last_v + 1):
                y = low[1] + (q + 0.5) * step[1]
                depth = sign * w[i] + along_u * (x - u[i]) + along_v * (y - v[i])
                depth = min(max(depth, lowest), highest)
                if depth < depths[side, p, q] and _covers(u, v, faces[f], x, y) != 0:
                    depths[side, p, q], seen[side, p, q] = depth, f


@njit(cache=True, error_model="numpy")
def count_windings(vertices, faces, points, windings):
    """Write how often a mesh encloses each point to `windings` (n,), by rays upwards.

    The points (n, 3) stand in the order of their x.
    """
    x, y, z = vertices[:, 0], vertices[:, 1], vertices[:, 2]
    windings[:] = 0
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        low, high = min(x[i], x[j], x[k]), max(x[i], x[j], x[k])
        front, back = min(y[i], y[j], y[k]), max(y[i], y[j], y[k])

        # the first point that is not beside the face
        first, last = 0, points.shape[0]
        while first < last:
            middle = (first + last) // 2
            if points[middle, 0] < low:
                first = middle + 1
            else:
                last = middle
        for n in range(first, points.shape[0]):
            px, py, pz = points[n, 0], points[n, 1], points[n, 2]
            if px > high:
                break
            if py < front or py > back:
                continue
            side = _covers(x, y, faces[f], px, py)
            if side != 0 and _height(x, y, z, faces[f], px, py) > pz:
                windings[n] += side


@njit(cache=True, error_model="numpy")
def misenclosed(vertices, faces, count):
    """Volumes enclosed more than once and less than never, by count * count vertical rays.

    Along each ray the winding number goes up by one where it enters (n_z < 0) and down where it
    leaves; space with winding 0 is outside, 1 is inside, anything else is a mesh that crosses
    itself.
    """
    low, high = vertices[0].copy(), vertices[0].copy()
    for i in range(vertices.shape[0]):
        for c in range(3):
            low[c], high[c] = min(low[c], vertices[i, c]), max(high[c], vertices[i, c])
    # a grid slightly off the bounds, so that rays miss edges aligned with it
    step = (high - low) / (count - 0.3819660113)
    low = low - 0.1180339887 * step

    # count the hits of each ray, then list them
    starts = np.zeros(count * count + 1, np.int64)
    heights, signs = np.zeros(0), np.zeros(0, np.int8)
    _hit(vertices, faces, low, step, count, boolean(0), starts[1:], heights, signs)
    for ray in range(count * count):
        starts[ray + 1] += starts[ray]
    heights, signs = np.zeros(starts[-1]), np.zeros(starts[-1], np.int8)
    _hit(vertices, faces, low, step, count, boolean(1), starts[:-1].copy(), heights, signs)

    # walk up each ray
    doubled = inverted = 0.0
    for ray in range(count * count):
        first, last = starts[ray], starts[ray + 1]
        doubled, inverted = _misenclosed_along(
            heights[first:last], signs[first:last], doubled, inverted
        )
    cell = step[0] * step[1]
    return doubled * cell, inverted * cell


@inner
def _hit(vertices, faces, low, step, count, listing, places, heights, signs):
    """Count the hits of each ray in `places`; or, listing, write their heights and signs.

    When listing, `places` says where those of each ray go.
    """
    x, y, z = vertices[:, 0], vertices[:, 1], vertices[:, 2]
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        first_x, last_x = _cells(x[i], x[j], x[k], low[0], step[0], count)
        first_y, last_y = _cells(y[i], y[j], y[k], low[1], step[1], count)
        for p in range(first_x, last_x + 1):
            for q in range(first_y, last_y + 1):
                rx, ry = low[0] + (p + 0.5) * step[0], low[1] + (q + 0.5) * step[1]
                side = _covers(x, y, faces[f], rx, ry)
                if side == 0:
                    continue
                ray = p * count + q
                if listing:
                    heights[places[ray]] = _height(x, y, z, faces[f], rx, ry)
                    signs[places[ray]] = -side
                places[ray] += 1


@njit(cache=True, error_model="numpy")
def _misenclosed_along(heights, signs, doubled, inverted):
    """Add to lengths enclosed more than once and less than never those of one ray, by its hits."""
    # the kind of sort that trees use, so that no other is compiled
    order = np.argsort(heights, kind="mergesort")
    winding = 0
    for n in range(heights.shape[0] - 1):
        winding += signs[order[n]]
        length = heights[order[n + 1]] - heights[order[n]]
        if winding > 1:
            doubled += (winding - 1) * length
        elif winding < 0:
            inverted -= winding * length
    return doubled, inverted

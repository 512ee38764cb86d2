"""Refinement: the same surface in smaller triangles."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.surface import Surface

SLENDER = 0.7
"""Shortest side, over the longest edge wished for, up to which a long triangle is cut in slices."""


def refine(vertices: NDArray[np.float64], faces: NDArray[np.int64], edge: float) -> Surface:
    """Cut a surface into about as few triangles as edges of about `edge` [m] at most take.

    Edges are halved until they are short enough, so that neighbours have the same ones. Well-shaped
    triangles are halved across their longest edge. Slender ones are cut in slices at once; their
    diagonals may be a quarter longer than `edge`.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
        edge: longest edge wished for [m].

    Returns:
        Vertices and faces; the very arrays that came in if every edge is short enough.
    """
    # an edge of just so many times the length is not too long by its rounding
    edge *= 1.0 + 1e-9
    v, f, done = vertices, faces, []
    while len(f):
        # turn each face so that its longest edge runs from corner 0 to corner 1
        lengths = _edge_lengths(v, f)
        f = _turn(f, lengths.argmax(axis=1))
        longest = lengths.max(axis=1)
        long = longest > edge
        slender = long & (lengths.min(axis=1) <= SLENDER * edge)
        done.append(f[~long])

        # slice the slender ones
        v, slices = _slice_all(v, f[slender], edge)
        done += slices

        # halve the others
        f = f[long & ~slender]
        m = len(v) + np.arange(len(f))
        v = np.vstack([v, 0.5 * (v[f[:, 0]] + v[f[:, 1]])])
        f = np.vstack(
            [np.column_stack([f[:, 0], m, f[:, 2]]), np.column_stack([m, f[:, 1], f[:, 2]])]
        )
    if len(v) == len(vertices):
        return vertices, faces

    # neighbours have halved their common edge each for itself
    places, inverse = np.unique(v, axis=0, return_inverse=True)
    return places, inverse.ravel()[np.vstack(done)]


def _edge_lengths(v: NDArray[np.float64], f: NDArray[np.int64]) -> NDArray[np.float64]:
    """Lengths (m, 3) [m] of the edges from corners 0, 1 and 2 to the next."""
    a, b, c = v[f.T]
    return np.stack([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=1)


def _turn(f: NDArray[np.int64], first: NDArray[np.intp]) -> NDArray[np.int64]:
    """The same faces, each with corner `first` (m,) in front."""
    return np.take_along_axis(f, (first[:, None] + np.arange(3)) % 3, axis=1)


def _slice_all(
    v: NDArray[np.float64], f: NDArray[np.int64], edge: float
) -> tuple[NDArray[np.float64], list[NDArray[np.int64]]]:
    """Cut slender triangles in slices; returns all vertices, and lists of the new faces."""
    # the tip lies opposite the shortest edge, and each side from there is halved so many times
    f = _turn(f, np.roll(_edge_lengths(v, f), -1, axis=1).argmin(axis=1))
    sides = _edge_lengths(v, f)[:, [0, 2]]
    parts = 2 ** np.ceil(np.log2(np.maximum(sides / edge, 1.0))).astype(np.int64)
    slices = []
    for left, right in np.unique(parts, axis=0):
        v, faces = _slice(v, f[(parts == (left, right)).all(axis=1)], int(left), int(right))
        slices.append(faces)
    return v, slices


def _slice(v: NDArray[np.float64], f: NDArray[np.int64], left: int, right: int) -> Surface:
    """Cut triangles whose sides from corner 0 are divided in so many parts."""
    rails = []
    for corner, count in ((1, left), (2, right)):
        # down each side, from the tip to the corner itself
        part = np.arange(1, count)[:, None, None] / count
        rail = len(v) + np.arange((count - 1) * len(f)).reshape(count - 1, len(f))
        tip, end = v[f[:, 0]], v[f[:, corner]]
        v = np.vstack([v, ((1.0 - part) * tip + part * end).reshape(-1, 3)])
        rails.append(np.vstack([f[None, :, 0], rail, f[None, :, corner]]))

    # from the tip, and from each rung to the next, on the side where that is nearer
    lefts, rights = rails
    i, j, steps = 1, 1, [(lefts[1], rights[1], lefts[0])]
    while i < left or j < right:
        if (i + 1) * right <= (j + 1) * left:
            steps.append((lefts[i], lefts[i + 1], rights[j]))
            i += 1
        else:
            steps.append((lefts[i], rights[j + 1], rights[j]))
            j += 1
    return v, np.array(steps).transpose(0, 2, 1).reshape(-1, 3)

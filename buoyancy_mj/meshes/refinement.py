"""Refinement: the same surface in smaller triangles."""

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.surface import Surface

SLENDER = 0.7
"""Shortest side, over the edge wished for, up to which a long triangle is cut into slices.

Slices are no deeper than this either: across right angles their diagonals are sqrt(2) 0.7 = 0.99.
"""


def refine(vertices: NDArray[np.float64], faces: NDArray[np.int64], edge: float) -> Surface:
    """Cut a surface into about as few triangles as edges of about `edge` [m] at most take.

    Well-shaped triangles are halved across their longest edge. Slender ones are cut across their
    two long edges at once, where a diagonal may reach 1.4 `edge`. Neighbours may be cut at
    different places along their common edge.

    Args:
        vertices: corners (n, 3) [m].
        faces: indices of the corners of each triangle (m, 3).
        edge: longest edge wished for [m].

    Returns:
        Vertices and faces; the very arrays that came in if every edge is short enough.
    """
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
        counts = np.ceil(longest[slender] / (SLENDER * edge)).astype(np.int64)
        for count in np.unique(counts):
            v, slices = _slice(v, f[slender][counts == count], int(count))
            done.append(slices)

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


def _slice(v: NDArray[np.float64], f: NDArray[np.int64], count: int) -> Surface:
    """Cut triangles into `count` slices parallel to their shortest edge."""
    # the tip lies opposite the shortest edge
    f = _turn(f, np.roll(_edge_lengths(v, f), -1, axis=1).argmin(axis=1))
    tip, left, right = v[f.T]

    # rungs of a ladder between the two long sides
    part = np.arange(1, count)[:, None, None] / count
    rungs = np.concatenate([tip + part * (left - tip), tip + part * (right - tip)]).reshape(-1, 3)

    # indices (count, n) down the left and the right side, ending at the corners themselves
    new = len(v) + np.arange(2 * (count - 1) * len(f)).reshape(2, count - 1, len(f))
    lefts = np.vstack([new[0], f[None, :, 1]])
    rights = np.vstack([new[1], f[None, :, 2]])

    # a triangle at the tip, two between each pair of rungs
    tips = np.column_stack([f[:, 0], lefts[0], rights[0]])
    upper = np.stack([lefts[:-1], lefts[1:], rights[1:]], axis=-1).reshape(-1, 3)
    lower = np.stack([lefts[:-1], rights[1:], rights[:-1]], axis=-1).reshape(-1, 3)
    return np.vstack([v, rungs]), np.vstack([tips, upper, lower])

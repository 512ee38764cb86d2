"""The triangles of a leaf at the surface: sorted, cut and summed many at once."""

import numpy as np
import pytest

from buoyancy_mj.kernels import cuts, leaves

COUNT = 40


def _triangles(seed):
    """Vertices seen from above, their depths, and faces among them."""
    rng = np.random.default_rng(seed)
    x, y, d, w = rng.normal(size=(4, COUNT))
    faces = np.array([rng.choice(COUNT, 3, replace=False) for _ in range(60)], np.uint32)
    return x, y, d, w, faces


def _clip(corners):
    """The wet part of a triangle (3, 4) as a polygon, side by side; w is the last column."""
    polygon = []
    for p, q in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if p[3] > 0.0:
            polygon.append(p)
        if (p[3] > 0.0) != (q[3] > 0.0):
            polygon.append(p + p[3] / (p[3] - q[3]) * (q - p))
    return np.array(polygon)


def _integrals(polygon):
    """Integrals of d, x d, y d, d^2 and 1 over a polygon, by triangles and their edges' middles."""
    total = np.zeros(5)
    for k in range(1, len(polygon) - 1):
        corners = polygon[[0, k, k + 1]]
        (ax, ay), (bx, by) = corners[1:, :2] - corners[0, :2]
        x, y, d, _ = 0.5 * (corners + np.roll(corners, -1, axis=0)).T
        values = np.array([d, x * d, y * d, d * d, np.ones(3)])
        total += 0.5 * (ax * by - bx * ay) * values.mean(axis=1)
    return total


def _sort(faces, w):
    lists = np.zeros((3, len(faces)), np.uint32)
    counts = leaves.sort_faces.py_func(
        faces, 0, len(faces), np.uint64(0), w, lists[0], lists[1], lists[2]
    )
    return [list(row[: int(n)]) for row, n in zip(lists, counts, strict=True)]


def _sum(picked, faces, sizes, x, y, d):
    return np.array(
        leaves.sum_faces.py_func(faces, sizes, np.uint64(0), picked, len(picked), x, y, d)
    )


def test_faces_are_sorted_by_how_many_of_their_corners_are_wet():
    _, _, _, w, faces = _triangles(0)
    wet = (w[faces.astype(int)] > 0.0).sum(axis=1)

    most, others, crossed = _sort(faces, w)

    assert most == list(np.flatnonzero(wet >= 2))
    assert others == list(np.flatnonzero(wet < 2))
    assert crossed == list(np.flatnonzero((wet == 1) | (wet == 2)))


@pytest.mark.parametrize("seed", range(3))
def test_faces_with_most_corners_wet_and_signed_cuts_make_the_wet_part(seed):
    x, y, d, w, faces = _triangles(seed)
    sizes = np.arange(1.0, len(faces) + 1.0)
    most, _, crossed = _sort(faces, w)
    room = np.zeros(cuts.ROOM)
    for n, face in enumerate(crossed):
        leaves.let_wait.py_func(room, n, face, faces, sizes, np.uint64(0), x, y, d, w)

    found = _sum(most, faces, sizes, x, y, d) + np.array(cuts.sum_cuts.py_func(room, len(crossed)))

    polygons = [_clip(np.column_stack([x, y, d, w])[face.astype(int)]) for face in faces]
    wanted = sum(_integrals(polygon) for polygon in polygons if len(polygon))
    np.testing.assert_allclose(found[:5], wanted, atol=1e-12 * np.abs(wanted).max())


def test_the_waterplane_lies_to_the_left_of_a_cut():
    # a triangle that faces up, wet at its corner at the origin, then wet at the two others
    x, y = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, 1.0])
    faces, sizes = np.array([[0, 1, 2]], np.uint32), np.array([0.5])
    for sign in (1.0, -1.0):
        room, w = np.zeros(cuts.ROOM), sign * np.array([1.0, -1.0, -1.0])
        leaves.let_wait.py_func(room, 0, 0, faces, sizes, np.uint64(0), x, y, w, w)

        area = cuts.sum_cuts.py_func(room, 1).area

        p = room[[cuts.P_X, cuts.P_Y]]
        q = room[[cuts.Q_X, cuts.Q_Y]]
        assert area == pytest.approx(sign * 0.125)
        ends = [[0.0, 0.5], [0.5, 0.0]] if sign > 0.0 else [[0.5, 0.0], [0.0, 0.5]]
        np.testing.assert_allclose([p, q], ends)

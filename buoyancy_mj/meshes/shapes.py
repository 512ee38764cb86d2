"""MuJoCo's primitive geoms as closed meshes.

A faceted solid inscribed in a round one is too small. It is scaled until its volume is the true
one, which leaves a draft or a centroid wrong by less than 0.1 % of the longest side at this
resolution.
"""

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.meshes.mesh import TriMesh

SUBDIVISIONS = 4
"""Subdivisions of an icosahedron for a sphere or an ellipsoid: 5120 triangles."""
SECTIONS = 64
"""Facets around a cylinder."""
ROWS = 8
"""Rows of triangles on each end of a capsule, which has 576 of them."""


def box(half_sizes: ArrayLike) -> TriMesh:
    """A box from its half sizes (3,) [m], as in MuJoCo."""
    import trimesh

    unit = trimesh.creation.box(extents=(2.0, 2.0, 2.0))
    return TriMesh(unit.vertices * np.asarray(half_sizes, float), unit.faces)


def ellipsoid(radii: ArrayLike) -> TriMesh:
    """An ellipsoid from its semi-axes (3,) [m]."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=SUBDIVISIONS)
    scale = np.cbrt(4.0 / 3.0 * np.pi / ball.volume)
    return TriMesh(ball.vertices * scale * np.asarray(radii, float), ball.faces)


def sphere(radius: float) -> TriMesh:
    """A sphere from its radius [m]."""
    return ellipsoid((radius, radius, radius))


def cylinder(radius: float, half_length: float) -> TriMesh:
    """A cylinder along z from its radius and half length [m]."""
    solid = _revolve([[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]], np.pi * 2.0)
    return TriMesh(solid.vertices * [radius, radius, half_length], solid.faces)


def capsule(radius: float, half_length: float) -> TriMesh:
    """A capsule along z from its radius and the half length [m] of its cylindrical part."""
    dome = _make_dome()
    top = radius * dome.vertices + [0.0, 0.0, half_length]
    count, number = len(top), 4 * ROWS

    # the facets between the two rims
    rim = np.arange(count - number, count)
    after = np.roll(rim, -1)
    low, low_after = rim + count, after + count
    sides = [np.column_stack([low, low_after, after]), np.column_stack([low, after, rim])]
    faces = np.vstack([dome.faces, dome.faces[:, ::-1] + count, *sides])
    return TriMesh(np.vstack([top, top * [1.0, 1.0, -1.0]]), faces)


class _Dome(NamedTuple):
    """Half a ball of radius 1, above z = 0."""

    vertices: NDArray[np.float64]
    """(n, 3), the pole first, those on the rim last."""
    faces: NDArray[np.int64]
    """(m, 3), none of them in the plane of the rim."""


@functools.cache
def _make_dome() -> _Dome:
    """Half a ball of the true volume, whose rim has the area of the circle.

    Its faces are those of half an octahedron, each of them in `ROWS` rows of triangles: as
    symmetric as a square, so that what is found for a capsule is so, too.
    """
    vertices, faces = [(0.0, 0.0, 1.0)], []
    for row in range(1, ROWS + 1):
        latitude = 0.5 * np.pi * (1.0 - row / ROWS)
        for n in range(4 * row):
            turn = 0.5 * np.pi * n / row
            across = np.cos(latitude) * np.cos(turn), np.cos(latitude) * np.sin(turn)
            vertices.append((*across, np.sin(latitude)))

            # an upright triangle, and one upside down between it and the last on the same side
            apex = n - n // row
            faces.append([_count(row, n), _count(row, n + 1), _count(row - 1, apex)])
            if n % row:
                faces.append([_count(row - 1, apex - 1), _count(row, n), _count(row - 1, apex)])
    return _Dome(_round_out(np.array(vertices), np.array(faces)), np.array(faces))


def _count(row: int, n: int) -> int:
    """Where the nth vertex of a row of a dome stands among all."""
    return 1 + 2 * row * (row - 1) + n % (4 * row) if row else 0


def _round_out(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """Move the vertices of a dome outward, so that its facets are as far out as they lie within.

    A flat triangle of sides a, b, c lies (a^2 + b^2 + c^2) / 24 within the unit sphere through its
    corners in the mean over its area, but for the fourth powers of its sides.
    """
    corners = vertices[faces]
    sides = corners - np.roll(corners, 1, axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    lack = (sides**2).sum(axis=(1, 2)) / 24.0
    around = faces.ravel()
    weights = np.bincount(around, np.repeat(area, 3))
    vertices *= (1.0 + np.bincount(around, np.repeat(area * lack, 3)) / weights)[:, None]

    # the pole is where it was, the rim has the area of the circle, the others make up the volume
    pole, others, rim = np.split(vertices, [1, len(vertices) - 4 * ROWS])
    pole[:] = 0.0, 0.0, 1.0
    angle = 0.5 * np.pi / ROWS
    rim *= np.sqrt(angle / np.sin(angle)) / np.linalg.norm(rim, axis=1, keepdims=True)
    rim[:, 2] = 0.0
    for _ in range(20):
        volume = np.linalg.det(vertices[faces]).sum() / 6.0
        others *= np.cbrt(2.0 / 3.0 * np.pi / volume)
    return vertices


def _revolve(profile: ArrayLike, volume: float) -> TriMesh:
    """Revolve a profile (n, 2) of radius and height about z, and widen it to a volume."""
    # the poles, and a ring of vertices for each point of the profile between them
    r, z = np.asarray(profile, float).T
    turn = 2.0 * np.pi * np.arange(SECTIONS) / SECTIONS
    rings = np.stack([np.outer(r[1:-1], np.cos(turn)), np.outer(r[1:-1], np.sin(turn))], axis=-1)
    heights = np.repeat(z[1:-1], SECTIONS)
    vertices = np.vstack(
        [[0.0, 0.0, z[0]], np.column_stack([rings.reshape(-1, 2), heights]), [0.0, 0.0, z[-1]]]
    )

    # around each pole a fan
    first = 1 + SECTIONS * np.arange(len(r) - 2)[:, None] + np.arange(SECTIONS)
    after = np.roll(first, -1, axis=1)
    bottom = np.column_stack([np.zeros(SECTIONS, int), after[0], first[0]])
    top = np.column_stack([np.full(SECTIONS, len(vertices) - 1), first[-1], after[-1]])

    # between two rings a band
    low, low_after = first[:-1].ravel(), after[:-1].ravel()
    high, high_after = first[1:].ravel(), after[1:].ravel()
    bands = np.vstack(
        [np.column_stack([low, low_after, high_after]), np.column_stack([low, high_after, high])]
    )

    # as wide as the volume asks
    solid = TriMesh(vertices, np.vstack([bottom, bands, top]))
    across = np.sqrt(volume / solid.volume)
    return TriMesh(solid.vertices * [across, across, 1.0], solid.faces)

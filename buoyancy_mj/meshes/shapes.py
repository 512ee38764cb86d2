"""MuJoCo's primitive geoms as closed meshes.

A faceted solid inscribed in a round one is too small. The vertices are moved outward by what the
facets around them lack, and the whole has the volume of the true shape. At any attitude in which at
least a twentieth is in the water, and a twentieth out of it, the volume under water is then wrong
by less than 0.05 % of the whole, and the height at which it floats and the centre of buoyancy by
less than 0.1 % of the longest side. The waterplane's area is wrong by 0.1 % and its moments by
0.3 % (root mean square); in the worst attitude of a short capsule by 0.6 % and 1.2 %, of the other
shapes by 0.2 % and 0.5 %.

Vertices stand out of the true shape by up to 1 % of the radius of a capsule and 0.3 % of that of
a sphere. The poles of a capsule, and the vertices of a sphere on its axes, do not.
"""

import functools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.meshes.mesh import TriMesh

SUBDIVISIONS = 3
"""Subdivisions of an icosahedron for a sphere or an ellipsoid: 1280 triangles."""
SECTIONS = 64
"""Facets around a cylinder: 256 triangles."""
RINGS = 8
"""Rings of vertices on each end of a capsule: 576 triangles."""


def box(half_sizes: ArrayLike) -> TriMesh:
    """A box from its half sizes (3,) [m], as in MuJoCo."""
    import trimesh

    unit = trimesh.creation.box(extents=(2.0, 2.0, 2.0))
    return TriMesh(unit.vertices * np.asarray(half_sizes, float), unit.faces)


def ellipsoid(radii: ArrayLike) -> TriMesh:
    """An ellipsoid from its semi-axes (3,) [m]."""
    ball = _unit_ball()
    return TriMesh(ball.vertices * np.asarray(radii, float), ball.faces)


def sphere(radius: float) -> TriMesh:
    """A sphere from its radius [m]."""
    return ellipsoid((radius, radius, radius))


def cylinder(radius: float, half_length: float) -> TriMesh:
    """A cylinder along z from its radius and half length [m]."""
    # as wide as the area of the base asks
    angle = 2.0 * np.pi / SECTIONS
    across = radius * np.sqrt(angle / np.sin(angle))
    bottom = [_Ring(0.0, -half_length, 1), _Ring(across, -half_length, SECTIONS)]
    top = [ring._replace(height=half_length) for ring in reversed(bottom)]
    return _stack([*bottom, *top])


def capsule(radius: float, half_length: float) -> TriMesh:
    """A capsule along z from its radius and the half length [m] of its cylindrical part.

    Its two ends are turned against each other by half a facet. So the facets of the cylindrical
    part point up and down in turn, and however it is rolled, each of its sides lies as far out as
    that of the true shape in the mean over its length.
    """
    dome = [_scale(ring, radius) for ring in _unit_dome()]
    turn = 0.5 / dome[0].number
    top = [ring._replace(height=half_length + ring.height, turn=turn) for ring in dome]
    bottom = [ring._replace(height=-ring.height, turn=0.0) for ring in reversed(top)]
    return _stack([*bottom, *top])


# what they are made of


class _Ring(NamedTuple):
    """Vertices around the z axis."""

    radius: float
    """Their distance from the axis [m]; 0 for a pole."""
    height: float
    """Their height [m]."""
    number: int
    """How many they are; 1 for a pole."""
    turn: float = 0.0
    """How far the first lies past the x axis [turns]."""


@functools.cache
def _unit_ball() -> TriMesh:
    """A sphere of radius 1."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=SUBDIVISIONS)
    lack = _find_lack(ball.vertices, ball.faces)
    # those on the axes stay, so that it is as long, as wide and as tall as it should be
    lack[np.abs(ball.vertices).max(axis=1) > 1.0 - 1e-9] = 0.0
    vertices = ball.vertices * (1.0 + lack)[:, None]
    scale = np.cbrt(4.0 / 3.0 * np.pi / TriMesh(vertices, ball.faces).volume)
    return TriMesh(vertices * scale, ball.faces)


@functools.cache
def _unit_dome() -> tuple[_Ring, ...]:
    """Half a sphere of radius 1 as rings, from the rim at height 0 to the pole.

    Each ring has four vertices less than the one below it, as on an octahedron.
    """
    latitudes = np.linspace(0.0, 0.5 * np.pi, RINGS + 1)[:-1]
    counts = 4 * np.arange(RINGS, 0, -1)
    bottom, pole = _Ring(0.0, 0.0, 1), _Ring(0.0, 1.0, 1)
    rings = [
        _Ring(float(np.cos(angle)), float(np.sin(angle)), int(count))
        for angle, count in zip(latitudes, counts, strict=True)
    ]

    # outward by what the facets around each ring lack
    solid = _stack([bottom, *rings, pole])
    lack = _find_lack(solid.vertices[1:], solid.faces[solid.faces.min(axis=1) > 0] - 1)
    of_rings = np.add.reduceat(lack[:-1], np.cumsum(counts) - counts) / counts
    rings = [_scale(ring, 1.0 + part) for ring, part in zip(rings, of_rings, strict=True)]

    # the rim as wide as the cylindrical part of a capsule asks: a section of that is a mixture of
    # the polygons at its ends, whose areas and mixed area weigh 2/3 and 1/3 over its length
    angle = np.pi / counts[0]
    area = counts[0] * (np.sin(2.0 * angle) + np.sin(angle)) / 3.0
    rings[0] = rings[0]._replace(radius=float(np.sqrt(np.pi / area)))

    # and the others as the volume asks
    for _ in range(12):
        scale = np.cbrt(2.0 / 3.0 * np.pi / _stack([bottom, *rings, pole]).volume)
        rings[1:] = [_scale(ring, scale) for ring in rings[1:]]
    return (*rings, pole)


def _scale(ring: _Ring, factor: float) -> _Ring:
    """A ring farther from the origin, or nearer to it."""
    return ring._replace(radius=ring.radius * factor, height=ring.height * factor)


def _find_lack(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.float64]:
    """How far the facets around each vertex of a unit sphere lie within it in the mean (n,).

    A flat triangle of sides a, b, c lies (a^2 + b^2 + c^2) / 24 within the sphere through its
    corners in the mean over its area, but for the fourth powers of its sides.
    """
    corners = vertices[faces]
    sides = corners - np.roll(corners, 1, axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    lack = (sides**2).sum(axis=(1, 2)) / 24.0
    around = faces.ravel()
    return np.bincount(around, np.repeat(area * lack, 3)) / np.bincount(around, np.repeat(area, 3))


def _stack(rings: Sequence[_Ring]) -> TriMesh:
    """The solid through rings of vertices, from its lower pole to its upper one."""
    starts = np.cumsum([0, *(ring.number for ring in rings)])
    vertices = np.empty((starts[-1], 3))
    for start, ring in zip(starts[:-1], rings, strict=True):
        angles = 2.0 * np.pi * (np.arange(ring.number) / ring.number + ring.turn)
        of_ring = vertices[start : start + ring.number]
        of_ring[:, 0], of_ring[:, 1] = ring.radius * np.cos(angles), ring.radius * np.sin(angles)
        of_ring[:, 2] = ring.height
    pairs = zip(rings, starts[:-1], rings[1:], starts[1:], strict=False)
    bands = [_join(*pair) for pair in pairs]
    return TriMesh(vertices, np.vstack(bands))


def _join(low: _Ring, first: int, high: _Ring, second: int) -> NDArray[np.int64]:
    """The faces (m, 3) between two rings, whose vertices begin at `first` and `second`.

    Each edge of a ring makes a triangle with the vertex of the other ring that is nearest to its
    middle. Of two that are as near, an edge of the lower ring takes the one, and an edge of the
    upper ring the other.
    """
    below, above, tie = np.arange(low.number), np.arange(high.number), 1e-9
    turns = (below + 0.5) / low.number + low.turn - high.turn
    over = np.ceil(turns * high.number - 0.5 - tie).astype(int) % high.number
    turns = (above + 0.5) / high.number + high.turn - low.turn
    under = np.ceil(turns * low.number - 0.5 + tie).astype(int) % low.number
    lower = np.column_stack([first + below, first + (below + 1) % low.number, second + over])
    upper = np.column_stack([second + above, first + under, second + (above + 1) % high.number])
    faces = np.vstack([lower, upper])

    # a pole has no edges
    edged: NDArray[np.int64] = faces[(faces[:, 0] != faces[:, 1]) & (faces[:, 0] != faces[:, 2])]
    return edged

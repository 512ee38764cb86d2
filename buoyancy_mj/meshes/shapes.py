"""MuJoCo's primitive geoms as closed meshes.

A faceted solid inscribed in a round one is too small. It is scaled until its volume is the true
one, which leaves a draft or a centroid wrong by less than 0.1 % of the size at this resolution.
"""

import numpy as np
from numpy.typing import ArrayLike

from buoyancy_mj.meshes.mesh import TriMesh

SUBDIVISIONS = 4
"""Subdivisions of an icosahedron for a sphere or an ellipsoid: 5120 triangles."""
SECTIONS = 64
"""Facets around a cylinder or a capsule."""


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
    # a quarter circle in units of the radius; the poles lie on the axis exactly
    angle = np.linspace(0.0, 0.5 * np.pi, SECTIONS // 4 + 1)
    cap = np.column_stack([np.cos(angle), half_length / radius + np.sin(angle)])
    cap[-1, 0] = 0.0

    # the profile from pole to pole, and the volume that it must have
    profile = np.vstack([cap[::-1] * [1.0, -1.0], cap])
    solid = _revolve(profile, np.pi * (2.0 * half_length / radius + 4.0 / 3.0))
    return TriMesh(solid.vertices * radius, solid.faces)


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

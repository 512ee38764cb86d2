"""MuJoCo's primitive geoms as meshes, scaled so that their volume is the true one.

A faceted solid inscribed in a round one is too small; scaling makes the volume exact and leaves a
draft or a centroid wrong by less than 0.1 % of the size at the resolution used here.
"""

import numpy as np
import trimesh
from numpy.typing import ArrayLike

from buoyancy_mj.meshes.mesh import TriMesh

SUBDIVISIONS = 4
"""Of an icosahedron for a sphere or an ellipsoid: 5120 triangles."""
SECTIONS = 64
"""Facets around a cylinder or a capsule."""


def box(half_sizes: ArrayLike) -> TriMesh:
    """A box from its half sizes (3,) [m], as in MuJoCo."""
    unit = trimesh.creation.box(extents=(2.0, 2.0, 2.0))
    return TriMesh(unit.vertices * np.asarray(half_sizes, float), unit.faces)


def ellipsoid(radii: ArrayLike) -> TriMesh:
    """An ellipsoid from its semi-axes (3,) [m]."""
    ball = trimesh.creation.icosphere(subdivisions=SUBDIVISIONS)
    scale = np.cbrt(4.0 / 3.0 * np.pi / ball.volume)
    return TriMesh(ball.vertices * scale * np.asarray(radii, float), ball.faces)


def sphere(radius: float) -> TriMesh:
    """A sphere from its radius [m]."""
    return ellipsoid((radius, radius, radius))


def cylinder(radius: float, half_length: float) -> TriMesh:
    """A cylinder along z from its radius and half length [m]."""
    solid = _revolved([[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]], np.pi * 2.0)
    return TriMesh(solid.vertices * [radius, radius, half_length], solid.faces)


def capsule(radius: float, half_length: float) -> TriMesh:
    """A capsule along z from its radius and the half length [m] of its cylindrical part."""
    angle = np.linspace(0.0, 0.5 * np.pi, SECTIONS // 4 + 1)
    # in radii; the poles lie on the axis exactly
    cap = np.column_stack([np.cos(angle), half_length / radius + np.sin(angle)])
    cap[-1, 0] = 0.0
    solid = _revolved(
        np.vstack([cap[::-1] * [1.0, -1.0], cap]), np.pi * (2.0 * half_length / radius + 4.0 / 3.0)
    )
    return TriMesh(solid.vertices * radius, solid.faces)


def _revolved(profile: ArrayLike, volume: float) -> TriMesh:
    """A profile (n, 2) of radius and height turned about z, widened until it has `volume`."""
    r, z = np.asarray(profile, float).T
    turn = 2.0 * np.pi * np.arange(SECTIONS) / SECTIONS
    rings = np.stack([np.outer(r[1:-1], np.cos(turn)), np.outer(r[1:-1], np.sin(turn))], axis=-1)
    heights = np.repeat(z[1:-1], SECTIONS)
    vertices = np.vstack(
        [[0.0, 0.0, z[0]], np.column_stack([rings.reshape(-1, 2), heights]), [0.0, 0.0, z[-1]]]
    )
    # around each pole a fan, between two rings a band
    first = 1 + SECTIONS * np.arange(len(r) - 2)[:, None] + np.arange(SECTIONS)
    after = np.roll(first, -1, axis=1)
    bottom = np.column_stack([np.zeros(SECTIONS, int), after[0], first[0]])
    top = np.column_stack([np.full(SECTIONS, len(vertices) - 1), first[-1], after[-1]])
    low, low_after, high, high_after = (
        ring.ravel() for ring in (first[:-1], after[:-1], first[1:], after[1:])
    )
    bands = np.vstack(
        [np.column_stack([low, low_after, high_after]), np.column_stack([low, high_after, high])]
    )
    solid = TriMesh(vertices, np.vstack([bottom, bands, top]))
    across = np.sqrt(volume / solid.volume)
    return TriMesh(solid.vertices * [across, across, 1.0], solid.faces)

"""MuJoCo's primitive geoms as meshes, scaled so that their volume is the true one.

A faceted solid inscribed in a round one is too small; scaling makes the volume exact and leaves a
draft or a centroid wrong by less than 0.1 % of the size at the resolution used here.
"""

import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.mesh import TriMesh

SUBDIVISIONS = 4
"""Of an icosahedron for a sphere or an ellipsoid: 5120 triangles."""
SECTIONS = 64
"""Facets around a cylinder or a capsule."""


def box(half_sizes: ArrayLike) -> TriMesh:
    """A box from its half sizes (3,) [m], as in MuJoCo."""
    return _hull(trimesh.creation.box(extents=2.0 * np.asarray(half_sizes, float)))


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
    solid = trimesh.creation.cylinder(radius=radius, height=2.0 * half_length, sections=SECTIONS)
    return _widened(solid, np.pi * radius**2 * 2.0 * half_length)


def capsule(radius: float, half_length: float) -> TriMesh:
    """A capsule along z from its radius and the half length [m] of its cylindrical part."""
    solid = trimesh.creation.capsule(radius=radius, height=2.0 * half_length, count=[SECTIONS // 2, SECTIONS])
    solid.apply_translation(-solid.bounds.mean(axis=0))
    return _widened(solid, np.pi * radius**2 * (2.0 * half_length + 4.0 / 3.0 * radius))


def _widened(solid: trimesh.Trimesh, volume: float) -> TriMesh:
    """`solid` scaled across z until it has `volume` [m^3]."""
    across = np.sqrt(volume / abs(solid.volume))
    return _hull(solid, np.array([across, across, 1.0]))


def _hull(solid: trimesh.Trimesh, scale: NDArray[np.float64] | float = 1.0) -> TriMesh:
    """A trimesh solid as a `TriMesh`."""
    return TriMesh(np.asarray(solid.vertices) * scale, np.asarray(solid.faces))

"""The bodies that the reproduction compares: what the paper dropped, and shapes on which a convex hull must fail."""

import functools
from collections.abc import Sequence

import mujoco
import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.hulls.geoms import find_hulls
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.scenes import catalog
from buoyancy_mj.submersion.methods import Method
from buoyancy_mj.submersion.submerge import submerge

# the hourglass that ships, see models/hourglass/README.md [m]
BASE_RADIUS, NECK_RADIUS, HALF_HEIGHT = 0.15, 0.04, 0.20
RINGS, SECTIONS = 24, 96


def hourglass(rings: int = RINGS, sections: int = SECTIONS) -> TriMesh:
    """Two frusta of cones, neck to neck, z up, its middle at the origin; `rings` of vertices in each."""
    z = np.linspace(-HALF_HEIGHT, HALF_HEIGHT, 2 * rings + 1)
    radius = NECK_RADIUS + (BASE_RADIUS - NECK_RADIUS) * np.abs(z) / HALF_HEIGHT
    profile = np.column_stack([np.r_[0.0, radius, 0.0], np.r_[z[0], z, z[-1]]])
    return _tri_mesh(trimesh.creation.revolve(profile, sections=sections))


def hourglass_area(height: NDArray[np.float64], sections: float = np.inf) -> NDArray[np.float64]:
    """Area [m^2] of the section at a height above the base [m]; of polygons if there are finitely many `sections`."""
    return _polygon(sections) * _hourglass_radius(height) ** 2


def hourglass_volume(height: NDArray[np.float64], sections: float = np.inf) -> NDArray[np.float64]:
    """Volume [m^3] of the hourglass up to a height above its base [m]: the integral of `hourglass_area`."""
    t = np.clip(np.asarray(height, float), 0.0, 2.0 * HALF_HEIGHT)
    # int r^2 dt along a cone is r^3 / 3 times dt/dr
    slope = HALF_HEIGHT / (3.0 * (BASE_RADIUS - NECK_RADIUS))
    r = _hourglass_radius(t)
    below = np.where(
        t <= HALF_HEIGHT, BASE_RADIUS**3 - r**3, BASE_RADIUS**3 - 2.0 * NECK_RADIUS**3 + r**3
    )
    return _polygon(sections) * slope * below


def _hourglass_radius(height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius [m] at a height above the base [m]."""
    return (
        NECK_RADIUS
        + (BASE_RADIUS - NECK_RADIUS)
        * np.abs(np.asarray(height, float) - HALF_HEIGHT)
        / HALF_HEIGHT
    )


def _polygon(sections: float) -> float:
    """Area of a regular polygon in the unit circle, which itself has infinitely many corners."""
    return float(np.pi if np.isinf(sections) else 0.5 * sections * np.sin(2.0 * np.pi / sections))


@functools.cache
def model_of(name: str) -> mujoco.MjModel:
    """A vehicle that ships."""
    return mujoco.MjModel.from_xml_path(str(catalog.models()[name]))


@functools.cache
def auv() -> tuple[TriMesh, ...]:
    """The meshes of the SAUVC vehicle that displace water, in the frame of its body."""
    return tuple(hull.mesh_in_body for hull in find_hulls(model_of("sauvc_auv")))


@functools.cache
def family(name: str, level: int) -> tuple[TriMesh, ...]:
    """The meshes of a body at a density of vertices that grows with `level` from 0, z up, bodies about 1 m or less.

    Args:
        name: one of `FAMILIES`.
        level: each has about four times as many vertices as the last.
    """
    finer = 2**level
    if name == "sphere":
        return (_tri_mesh(trimesh.creation.icosphere(subdivisions=level + 1, radius=0.3)),)
    if name == "hourglass":
        return (hourglass(3 * finer, 12 * finer),)
    if name == "torus":
        return (
            _tri_mesh(
                trimesh.creation.torus(
                    0.3, 0.1, major_sections=16 * finer, minor_sections=8 * finer
                )
            ),
        )
    if name == "catamaran":
        return (_subdivided(_catamaran(), level),)
    parts = tuple(_subdivided(mesh, level) for mesh in auv())
    if name == "AUV":
        return parts
    return (
        TriMesh(*trimesh.util.append_faces([m.vertices for m in parts], [m.faces for m in parts])),
    )


FAMILIES = {
    "sphere": "a ball",
    "hourglass": "the hourglass",
    "torus": "a torus, its hole filled by a hull",
    "catamaran": "two hulls under a deck",
    "AUV": "the SAUVC vehicle, its 15 meshes one by one",
    "AUV as one mesh": "the same, exported as one mesh",
}
"""Bodies of `family`."""


def wet_volume(
    meshes: Sequence[TriMesh],
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
    method: str | Method = "exact",
) -> float:
    """Volume [m^3] of meshes that move together under still water, by a method."""
    return sum(submerge(mesh, position, rotation, method=method).volume for mesh in meshes)


def at_draft(
    meshes: Sequence[TriMesh], fraction: float, rotation: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Position (3,) [m] at which meshes, turned, reach under the surface by a fraction of their height."""
    z = np.concatenate([mesh.vertices @ rotation[2] for mesh in meshes])
    return np.array([0.0, 0.0, -(z.min() + fraction * np.ptp(z))])


def _catamaran() -> TriMesh:
    lengthwise = trimesh.transformations.rotation_matrix(np.pi / 2.0, [0.0, 1.0, 0.0])
    floats = [
        trimesh.creation.capsule(height=0.7, radius=0.08, count=[24, 24])
        .apply_translation([0.0, 0.0, -0.35])
        .apply_transform(lengthwise)
        .apply_translation([0.0, y, 0.0])
        for y in (-0.25, 0.25)
    ]
    deck = trimesh.creation.box([0.5, 0.6, 0.03]).apply_translation([0.0, 0.0, 0.085])
    return _tri_mesh(trimesh.boolean.union([*floats, deck]))


def _subdivided(mesh: TriMesh, times: int) -> TriMesh:
    """Every triangle cut into four, some times over."""
    v, f = mesh.vertices, mesh.faces
    for _ in range(times):
        v, f = trimesh.remesh.subdivide(v, f)
    return TriMesh(v, f)


def _tri_mesh(solid: trimesh.Trimesh) -> TriMesh:
    return TriMesh(solid.vertices, solid.faces)

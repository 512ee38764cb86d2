"""The bodies that the studies compare: the paper's, and shapes on which a convex hull must fail."""

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
BASE_RADIUS = 0.15
NECK_RADIUS = 0.04
HALF_HEIGHT = 0.20
RINGS = 24
"""Rings of vertices in each cone of the hourglass that ships."""
SIDES = 96
"""Sides around the axis of the hourglass that ships."""
UPRIGHT = np.eye(3)
"""The rotation of a body that is not turned."""

FAMILIES = {
    "sphere": "a ball",
    "hourglass": "the hourglass",
    "torus": "a torus, its hole filled by a hull",
    "catamaran": "two hulls under a deck",
    "AUV": "the SAUVC vehicle, its 15 meshes one by one",
    "AUV as one mesh": "the same, exported as one mesh",
}
"""The bodies of `family`, described."""


# the hourglass, which has a closed form


def hourglass(rings: int = RINGS, sides: int = SIDES) -> TriMesh:
    """Two frusta of cones, neck to neck, z up, the middle at the origin.

    Args:
        rings: of vertices in each frustum.
        sides: of the polygons around the axis.
    """
    z = np.linspace(-HALF_HEIGHT, HALF_HEIGHT, 2 * rings + 1)
    radius = NECK_RADIUS + (BASE_RADIUS - NECK_RADIUS) * np.abs(z) / HALF_HEIGHT
    profile = np.column_stack([np.r_[0.0, radius, 0.0], np.r_[z[0], z, z[-1]]])
    return _tri_mesh(trimesh.creation.revolve(profile, sections=sides))


def hourglass_area(height: NDArray[np.float64], sides: float = np.inf) -> NDArray[np.float64]:
    """Area [m^2] of the hourglass's section at a height above its base [m].

    Args:
        height: above the base [m].
        sides: of the polygons around the axis; infinitely many make circles.
    """
    return _polygon_area(sides) * _hourglass_radius(height) ** 2


def hourglass_volume(height: NDArray[np.float64], sides: float = np.inf) -> NDArray[np.float64]:
    """Volume [m^3] of the hourglass up to a height above its base: the integral of its area.

    Args:
        height: above the base [m].
        sides: of the polygons around the axis; infinitely many make circles.
    """
    t = np.clip(np.asarray(height, float), 0.0, 2.0 * HALF_HEIGHT)

    # int r^2 dt along a cone is r^3 / 3 times dt/dr
    slope = HALF_HEIGHT / (3.0 * (BASE_RADIUS - NECK_RADIUS))
    r = _hourglass_radius(t)
    lower = BASE_RADIUS**3 - r**3
    upper = BASE_RADIUS**3 - 2.0 * NECK_RADIUS**3 + r**3
    volume: NDArray[np.float64] = (
        _polygon_area(sides) * slope * np.where(t <= HALF_HEIGHT, lower, upper)
    )
    return volume


def immersions(count: int) -> tuple[NDArray[np.float64], list[NDArray[np.float64]]]:
    """Lower the hourglass upright into still water.

    Args:
        count: of steps from dry to wholly wet.

    Returns:
        dz, the immersion of the base (count,) [m], and the position (3,) [m] at each.
    """
    dz = np.linspace(0.0, 2.0 * HALF_HEIGHT, count)
    return dz, [np.array([0.0, 0.0, HALF_HEIGHT - t]) for t in dz]


def _hourglass_radius(height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Radius [m] at a height above the base [m]."""
    from_neck = np.abs(np.asarray(height, float) - HALF_HEIGHT)
    return NECK_RADIUS + (BASE_RADIUS - NECK_RADIUS) * from_neck / HALF_HEIGHT


def _polygon_area(sides: float) -> float:
    """Area of a regular polygon in the unit circle, or of that circle for infinitely many sides."""
    return float(np.pi if np.isinf(sides) else 0.5 * sides * np.sin(2.0 * np.pi / sides))


# the vehicles that ship


@functools.cache
def load_model(name: str) -> mujoco.MjModel:
    """Load a vehicle that ships, by its name."""
    return mujoco.MjModel.from_xml_path(str(catalog.models()[name]))


@functools.cache
def auv() -> tuple[TriMesh, ...]:
    """The meshes of the SAUVC vehicle that displace water, in the frame of its body."""
    return tuple(hull.mesh_in_body for hull in find_hulls(load_model("sauvc_auv")))


def auv_parts() -> dict[str, list[TriMesh]]:
    """The meshes of `auv` by kind, in the order of its model."""
    kinds = [
        *["pressure hull", "battery pod", "frame", "foam", "foam", "ballast", "ballast"],
        *["thrusters"] * 8,
    ]
    parts: dict[str, list[TriMesh]] = {}
    for kind, mesh in zip(kinds, auv(), strict=True):
        parts.setdefault(kind, []).append(mesh)
    return parts


# bodies of growing density of vertices


@functools.cache
def family(name: str, level: int) -> tuple[TriMesh, ...]:
    """The meshes of a body with a chosen density of vertices, z up, about 1 m in size or less.

    Args:
        name: one of `FAMILIES`.
        level: from 0; each level has about four times as many vertices as the last.
    """
    finer = 2**level
    if name == "sphere":
        return (_tri_mesh(trimesh.creation.icosphere(subdivisions=level + 1, radius=0.3)),)
    if name == "hourglass":
        return (hourglass(3 * finer, 12 * finer),)
    if name == "torus":
        ring = trimesh.creation.torus(0.3, 0.1, major_sections=16 * finer, minor_sections=8 * finer)
        return (_tri_mesh(ring),)
    if name == "catamaran":
        return (_subdivide(_catamaran(), level),)

    parts = tuple(_subdivide(mesh, level) for mesh in auv())
    if name == "AUV":
        return parts
    return (
        TriMesh(*trimesh.util.append_faces([m.vertices for m in parts], [m.faces for m in parts])),
    )


def _catamaran() -> TriMesh:
    """Two capsules along x under a deck."""
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


def _subdivide(mesh: TriMesh, times: int) -> TriMesh:
    """Cut every triangle into four, so many times over."""
    vertices, faces = mesh.vertices, mesh.faces
    for _ in range(times):
        vertices, faces = trimesh.remesh.subdivide(vertices, faces)
    return TriMesh(vertices, faces)


def _tri_mesh(solid: trimesh.Trimesh) -> TriMesh:
    return TriMesh(solid.vertices, solid.faces)


# bodies in still water


def submerged_volume(
    meshes: Sequence[TriMesh],
    position: NDArray[np.float64],
    rotation: NDArray[np.float64],
    method: str | Method = "exact",
) -> float:
    """Volume [m^3] that meshes, moved together, have under still water.

    Args:
        meshes: of one body.
        position: of its frame (3,) [m].
        rotation: world_from_body (3, 3).
        method: that computes the submersion.
    """
    return sum(submerge(mesh, position, rotation, method=method).volume for mesh in meshes)


def position_at_draft(
    meshes: Sequence[TriMesh], fraction: float, rotation: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Position (3,) [m] at which a turned body has a draft of a fraction of its height."""
    z = np.concatenate([mesh.vertices @ rotation[2] for mesh in meshes])
    return np.array([0.0, 0.0, -(z.min() + fraction * np.ptp(z))])

"""The union of closed meshes, and how it is symmetric."""

from collections.abc import Sequence

import manifold3d
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import Surface, to_manifold

FINE = 1e-4
"""What the union may lose of the detail of its surface, as a part of its longest side."""
THIN = 0.003
"""The same at most, as a part of its mean thickness: twice its volume over its surface."""
MANY = 8000
"""Triangles of a union that may lose more detail, by doublings of what it may lose."""
LOSS = 0.005
"""Part of its volume that it may lose by that."""
ALIKE = 1e-3
"""Part of the volume that a body and its image may have apart and still count as symmetric."""


def unite(meshes: Sequence[TriMesh]) -> Surface | None:
    """The surface of the union of meshes, without needless triangles; None if one is no manifold.

    Each edge has two faces: where the union touches itself, it has two vertices in one place.
    """
    solids = [to_manifold(*mesh.compact) for mesh in meshes]
    manifolds = [solid for solid in solids if solid is not None]
    if len(manifolds) < len(solids):
        return None
    union = manifold3d.Manifold.batch_boolean(manifolds, manifold3d.OpType.Add)
    mesh = _drop_detail(union).to_mesh64()
    vertices = np.array(mesh.vert_properties)[:, :3].copy()
    return vertices, np.asarray(mesh.tri_verts).astype(np.int64)


def _drop_detail(solid: manifold3d.Manifold) -> manifold3d.Manifold:
    """A solid without triangles that say little, and with more loss if there are too many."""
    x0, y0, z0, x1, y1, z1 = solid.bounding_box()
    thickness = 2.0 * solid.volume() / solid.surface_area()
    tolerance = min(FINE * max(x1 - x0, y1 - y0, z1 - z0), THIN * thickness)
    simple = solid.simplify(tolerance)
    for _ in range(6):
        if simple.num_tri() <= MANY:
            break
        tolerance *= 2.0
        simpler = solid.simplify(tolerance)
        if abs(simpler.volume() / solid.volume() - 1.0) > LOSS:
            break
        simple = simpler
    return simple


def find_symmetries(mesh: TriMesh) -> NDArray[np.float64]:
    """The rotations and reflections (n, 3, 3) about its centroid by which a mesh goes into itself.

    Those among the 48 of a cube, along the axes of its frame or along its principal axes.
    The identity is always there.

    Args:
        mesh: the mesh, a manifold as `unite` makes it.
    """
    vertices, faces = mesh.compact
    vertices = vertices - mesh.centroid
    solid = to_manifold(vertices, faces)
    assert solid is not None
    largest = [np.eye(3)]
    for axes in (np.eye(3), _find_principal_axes(vertices, faces)):
        found = [
            one for one in _GENERATORS if _maps_to_itself(solid, vertices, axes @ one @ axes.T)
        ]
        group = _close(found)
        if len(group) > len(largest):
            largest = [axes @ one @ axes.T for one in group]
    return np.array(largest)


def _maps_to_itself(
    solid: manifold3d.Manifold, vertices: NDArray[np.float64], turn: NDArray[np.float64]
) -> bool:
    """Whether a solid about its centroid and its image are the same, but for `ALIKE`."""
    # most that are not differ in their bounding boxes
    turned = vertices @ turn.T
    ends, others = (np.stack([v.min(axis=0), v.max(axis=0)]) for v in (vertices, turned))
    if np.abs(ends - others).max() > ALIKE * float(np.ptp(ends, axis=0).max()):
        return False
    image = solid.transform(np.column_stack([turn, np.zeros(3)]))
    return bool((solid ^ image).volume() >= (1.0 - ALIKE) * solid.volume())


def _find_principal_axes(
    vertices: NDArray[np.float64], faces: NDArray[np.int64]
) -> NDArray[np.float64]:
    """The axes, as columns (3, 3), of the second moments of a volume about the origin."""
    corners = vertices[faces]
    sums = corners.sum(axis=1)
    volumes = np.linalg.det(corners)
    spread = np.einsum("n,nij,nik->jk", volumes, corners, corners)
    axes: NDArray[np.float64] = np.linalg.eigh(
        spread + np.einsum("n,nj,nk->jk", volumes, sums, sums)
    )[1]
    return axes


def _close(found: Sequence[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """All products of matrices whose entries are -1, 0 and 1."""
    group = {tuple(np.eye(3).ravel()): np.eye(3)}
    new = list(group.values())
    while new:
        products = [one @ two for one in new for two in found]
        new = []
        for product in products:
            key = tuple((product + 0.0).ravel())
            if key not in group:
                group[key] = product
                new.append(product)
    return list(group.values())


def _list_generators() -> list[NDArray[np.float64]]:
    """Mirrors across the three planes, exchanges of two axes, and half turns about the three."""
    mirrors = [np.diag(np.where(np.arange(3) == axis, -1.0, 1.0)) for axis in range(3)]
    exchanges = [np.eye(3)[order] for order in ([1, 0, 2], [0, 2, 1], [2, 1, 0])]
    return [*mirrors, *exchanges, *(-mirror for mirror in mirrors)]


_GENERATORS = _list_generators()

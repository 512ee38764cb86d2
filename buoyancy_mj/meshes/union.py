"""The union of closed meshes, and how it is symmetric."""

from collections.abc import Sequence

import manifold3d
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.surface import Surface, to_manifold

FINE = 1e-4
"""What the union may lose of the detail of its surface, as a part of its longest side."""
KEPT = 0.99
"""Part of its area that the union keeps at least, however thin its plates are."""
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
    mesh = _simplify(union).to_mesh64()
    vertices = np.array(mesh.vert_properties)[:, :3].copy()
    return vertices, np.asarray(mesh.tri_verts).astype(np.int64)


def _simplify(union: manifold3d.Manifold) -> manifold3d.Manifold:
    """A solid without needless triangles; plates that are thinner than `FINE` stay."""
    x0, y0, z0, x1, y1, z1 = union.bounding_box()
    fine, area = FINE * max(x1 - x0, y1 - y0, z1 - z0), union.surface_area()
    for part in (1.0, 1e-2, 1e-4):
        simple = union.simplify(part * fine)
        if simple.surface_area() >= KEPT * area:
            return simple
    return union


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
    largest, principal = [np.eye(3)], _find_principal_axes(vertices, faces)
    along_frame = np.abs(principal).max(axis=0).min() > 1.0 - 1e-9
    for axes in (np.eye(3),) if along_frame else (np.eye(3), principal):
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

"""`keep_mesh`: a mesh that stays as it is in the frame of its body, in a recording."""

import rerun as rr
from numpy.typing import ArrayLike

from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.triangles import SmoothMesh
from buoyancy_mj.viz.visible_geoms import VisibleGeom


def keep_mesh(
    log: Log,
    entity: str,
    mesh: SmoothMesh | VisibleGeom,
    position: ArrayLike,
    rotation: ArrayLike,
    colour: ArrayLike | None = None,
) -> None:
    """Log a mesh and where it is.

    Args:
        log: where to.
        entity: the entity, below that of its body.
        mesh: its corners, triangles and normals.
        position: origin of its frame in the body's (3,) [m].
        rotation: body_from_mesh (3, 3).
        colour: red, green, blue and alpha (4,); None for what changes.
    """
    shape = rr.Mesh3D(
        vertex_positions=mesh.vertices,
        triangle_indices=mesh.faces,
        vertex_normals=mesh.normals,
        albedo_factor=colour,
    )
    log.keep(entity, shape)
    log.keep(entity, rr.Transform3D(translation=position, mat3x3=rotation))

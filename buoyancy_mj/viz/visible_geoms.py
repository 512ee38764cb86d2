"""The geoms of a model as MuJoCo's viewer would draw them: meshes, colours and poses."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import find_mocap_bodies, find_moving_bodies
from buoyancy_mj.hulls.geoms import read_geom_mesh
from buoyancy_mj.viz.triangles import SmoothMesh, rectangle, smooth_mesh

SHOWN_GROUPS = 3
"""Number of geom groups that MuJoCo's viewer shows at first: 0, 1, 2."""
DEFAULT_RGBA = np.array([0.5, 0.5, 0.5, 1.0], np.float32)
"""Colour of a geom whose file sets none; only then the colour of its material shows."""
ENDLESS = 20.0
"""Half length at which an endless plane is cut off [m]."""


@dataclasses.dataclass(frozen=True)
class VisibleGeom:
    """A geom as it is drawn."""

    geom: int
    """Index of the geom in the model."""
    body: int
    """Index of its body; 0, the world, for all that does not move."""
    colour: NDArray[np.uint8]
    """Red, green, blue, alpha (4,), of the geom or of its material."""
    position: NDArray[np.float64]
    """Origin of the geom's frame in that body's frame (3,) [m]."""
    rotation: NDArray[np.float64]
    """Rotation body_from_geom (3, 3)."""
    vertices: NDArray[np.float64]
    """Corners in the geom's frame (n, 3) [m], doubled along sharp edges."""
    faces: NDArray[np.int64]
    """Indices of the corners of each triangle (m, 3)."""
    normals: NDArray[np.float64]
    """Unit normals at the corners (n, 3)."""

    @property
    def moves(self) -> bool:
        """Whether the geom belongs to a body that can move."""
        return self.body != 0


def find_visible_geoms(model: mujoco.MjModel) -> Iterator[VisibleGeom]:
    """Find every geom that MuJoCo's viewer would show at first, or all if it would show none."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    geoms = np.flatnonzero(model.geom_group < SHOWN_GROUPS)
    can_move = find_moving_bodies(model) | find_mocap_bodies(model)
    for geom in map(int, geoms if len(geoms) else range(model.ngeom)):
        body = int(model.geom_bodyid[geom])
        moves = bool(can_move[body])
        rgba = choose_colour(model, model.geom_rgba[geom], model.geom_matid[geom])
        mesh = _mesh(model, geom)
        if mesh is None or rgba[3] == 0.0:
            continue

        # what does not move stands in the frame of the world
        owner = body if moves else 0
        owner_from_world = data.xmat[owner].reshape(3, 3).T
        yield VisibleGeom(
            geom=geom,
            body=owner,
            colour=(255.0 * rgba).astype(np.uint8),
            position=owner_from_world @ (data.geom_xpos[geom] - data.xpos[owner]),
            rotation=owner_from_world @ data.geom_xmat[geom].reshape(3, 3),
            vertices=mesh.vertices,
            faces=mesh.faces,
            normals=mesh.normals,
        )


def choose_colour(
    model: mujoco.MjModel, rgba: NDArray[np.float32], material: int
) -> NDArray[np.float32]:
    """Red, green, blue, alpha (4,) from 0 to 1, as MuJoCo's viewer chooses them.

    Args:
        model: the model.
        rgba: those of a geom or a site (4,).
        material: index of its material; below 0 if it has none.
    """
    if material >= 0 and np.array_equal(rgba, DEFAULT_RGBA):
        rgba = model.mat_rgba[material]
    return rgba


def _mesh(model: mujoco.MjModel, geom: int) -> SmoothMesh | None:
    """The triangles of a geom in its frame; None if it has none."""
    is_plane = model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE
    half = [side if side > 0.0 else ENDLESS for side in model.geom_size[geom, :2]]
    arrays = rectangle(half) if is_plane else read_geom_mesh(model, geom)
    if arrays is None:
        return None
    vertices, faces = arrays
    return smooth_mesh(vertices, faces)

"""The geoms of a model as MuJoCo's viewer would draw them: meshes, colours, and where they stand."""

import dataclasses
from collections.abc import Iterator

import mujoco
import numpy as np
import trimesh
from numpy.typing import NDArray

from buoyancy_mj.hulls import geoms
from buoyancy_mj.meshes.refinement import refine

SHOWN_GROUPS = 3
"""Geom groups that MuJoCo's viewer shows at first: 0, 1, 2."""
DEFAULT_RGBA = np.array([0.5, 0.5, 0.5, 1.0], np.float32)
"""Colour of a geom that was given none; only then does its material's show."""
FINENESS = 12.0
"""Length of a moving geom over its longest edge: fine enough to show by its vertices what of it is wet."""


@dataclasses.dataclass(frozen=True)
class VisibleGeom:
    """A geom as it is drawn."""

    geom: int
    """Index of the geom in the model."""
    body: int
    """Index of its body; 0, the world, for all that does not move."""
    colour: NDArray[np.uint8]
    """Red, green, blue, alpha (4,), its own or its material's."""
    position: NDArray[np.float64]
    """Origin of its frame in that body (3,) [m]."""
    rotation: NDArray[np.float64]
    """Rotation (3, 3) from its frame to that body's."""
    vertices: NDArray[np.float64]
    """Corners in its frame (n, 3) [m], doubled along sharp edges."""
    faces: NDArray[np.int64]
    """Their indices (m, 3)."""
    normals: NDArray[np.float64]
    """Unit normals at the corners (n, 3)."""

    @property
    def moves(self) -> bool:
        """Whether it belongs to a body that can move."""
        return self.body != 0


def find_visible_geoms(model: mujoco.MjModel) -> Iterator[VisibleGeom]:
    """Every geom that MuJoCo's viewer would show at first, or all of them if it would show none."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    shown = [g for g in range(model.ngeom) if model.geom_group[g] < SHOWN_GROUPS] or list(
        range(model.ngeom)
    )
    for g in shown:
        material = model.geom_matid[g]
        rgba = model.geom_rgba[g]
        if material >= 0 and np.array_equal(rgba, DEFAULT_RGBA):
            rgba = model.mat_rgba[material]
        is_plane = model.geom_type[g] == mujoco.mjtGeom.mjGEOM_PLANE
        arrays = _plane(model.geom_size[g]) if is_plane else geoms.read_geom_mesh(model, g)
        if arrays is None or rgba[3] == 0.0:
            continue
        vertices, faces = arrays
        body = int(model.geom_bodyid[g])
        if model.body_weldid[body] or model.body_mocapid[body] >= 0:
            vertices, faces = refine(
                vertices, faces, float(np.ptp(vertices, axis=0).max()) / FINENESS
            )
        else:
            body = 0
        smooth = trimesh.graph.smooth_shade(
            trimesh.Trimesh(vertices, faces, process=False), angle=0.6
        )
        world_from_body = data.xmat[body].reshape(3, 3)
        yield VisibleGeom(
            geom=g,
            body=body,
            colour=(255.0 * rgba).astype(np.uint8),
            position=world_from_body.T @ (data.geom_xpos[g] - data.xpos[body]),
            rotation=world_from_body.T @ data.geom_xmat[g].reshape(3, 3),
            vertices=np.asarray(smooth.vertices),
            faces=np.asarray(smooth.faces),
            normals=np.asarray(smooth.vertex_normals),
        )


def _plane(size: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """A plane as a rectangle; an endless one ends 20 m away."""
    half = [length if length > 0.0 else 20.0 for length in size[:2]]
    corners = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    return corners * [*half, 0.0], np.array([[0, 1, 2], [0, 2, 3]])

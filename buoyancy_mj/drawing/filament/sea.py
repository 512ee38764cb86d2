"""`FilamentSea`: the surface of the sea and the haze under it, in a scene of Filament."""

from typing import Any

import numpy as np
from mujoco import mjrf
from numpy.typing import NDArray

from buoyancy_mj.drawing.filament.graphics import upload_normals
from buoyancy_mj.drawing.filament.haze import set_haze
from buoyancy_mj.drawing.looks import DAYLIGHT, Look
from buoyancy_mj.drawing.ripples import paint_ripples
from buoyancy_mj.drawing.sea_mesh import SeaMesh
from buoyancy_mj.drawing.sky import sun_ray
from buoyancy_mj.drawing.window import find_mirrored
from buoyancy_mj.sea.water import Water

SEGMENT = 0xFFFFFF
"""What marks the sea in a picture of segments; MuJoCo counts its own from 1."""
PIXELS = 512
"""Pixels along a side of the ripples."""
DRIFT = np.array([0.05, 0.03])
"""Speed of ripples over the water [m/s]."""


class FilamentSea:
    """A sea in a scene, beside whatever else is in it.

    Args:
        context: an `mjrf.Context`.
        scene: an `mjrf.Scene` of it.
        radius: distance from the middle of the sea within which its surface is exact [m].
        curvature: bound of the curvature of its surface [1/m], see `Water.curvature`.
        look: its colours.
    """

    def __init__(
        self,
        context: Any,
        scene: Any,
        radius: float,
        curvature: float = 0.0,
        look: Look = DAYLIGHT,
    ) -> None:
        self.is_below: bool | None = None
        """Whether the camera was under water when the sea was drawn; None before."""
        self._scene, self._look = scene, look
        # where the surface mirrors the depths, no sun falls through
        self._away = -sun_ray(look)
        self._mesh = SeaMesh(radius, curvature)
        self._tile = look.ripple_length * radius

        # triangles with both windings, so that the surface is there from below too
        faces = np.vstack([self._mesh.faces, self._mesh.faces[:, ::-1]])
        self._indices = np.ascontiguousarray(faces, np.uint32).tobytes()
        self._config = _configure(self._mesh.count, faces.size)
        self._buffer = context.create_mesh(self._config)
        self._ripples = upload_normals(context, paint_ripples(PIXELS, look.ripple))

        params = mjrf.RenderableParams(cast_shadow=False, receive_shadow=False, blend_order=4)
        self._renderable = context.create_renderable(params)
        self._renderable.set_mesh(self._buffer, 0, faces.size)
        scene.add_renderable(self._renderable)

    def draw(
        self,
        water: Water,
        centre: NDArray[np.float64],
        time: float,
        eye: NDArray[np.float64],
        visibility: float | None = None,
    ) -> None:
        """Draw the sea as it is at a time.

        Args:
            water: the sea.
            centre: the middle of its mesh, (2,) or (3,) [m].
            time: [s].
            eye: where the camera is (3,) [m]; under water it sees the haze and the surface from
                below.
            visibility: how far one sees under water [m]; None for that of the look.
        """
        is_below = bool(water.depth(eye, time) > 0.0)
        if is_below is not self.is_below:
            self.is_below = is_below
            far = self._look.visibility if visibility is None else visibility
            set_haze(self._scene, self._look, far if is_below else None)
        self._paint(time)

        surface = self._mesh.shape(water, centre[:2], time)
        vertices = surface.vertices.copy()
        vertices[:, :2] += centre[:2]
        ripples = vertices[:, :2] / self._tile
        data = mjrf.MeshData(compute_bounds=True)
        normals: NDArray[np.floating] = surface.normals
        if is_below:
            rays = vertices - eye
            upward = rays[:, 2] / np.linalg.norm(rays, axis=1)
            normals = normals + find_mirrored(upward)[:, None] * self._away
        columns = (vertices, normals, ripples)
        packed = b"".join(np.ascontiguousarray(one, np.float32).tobytes() for one in columns)
        data.set_vertices(self._config, packed)
        data.set_indices(self._config, self._indices)
        self._buffer.upload(data)

    def remove(self) -> None:
        """Take the sea and its haze out of the scene."""
        self._scene.remove_renderable(self._renderable)
        set_haze(self._scene, self._look, None)

    def _paint(self, time: float) -> None:
        """Give the surface its colour, which depends on the side that one sees."""
        look = self._look
        shade = look.below if self.is_below else look.above
        material = mjrf.Material(
            color=[*shade.colour, shade.opacity],
            roughness=shade.roughness,
            metallic=0.0,
            segmentation_id=SEGMENT,
            uv_offset=[*(DRIFT * time / self._tile % 1.0), 0.0],
        )
        material.normal_texture = self._ripples
        self._renderable.set_material(material)


def _configure(vertices: int, indices: int) -> Any:
    """How the mesh lies in memory: positions, normals, and coordinates of the ripples."""
    usage, kind = mjrf.VertexAttributeUsage, mjrf.VertexAttributeType
    layout = (
        (usage.VERTEX_ATTRIBUTE_USAGE_POSITION, kind.VERTEX_ATTRIBUTE_TYPE_FLOAT3),
        (usage.VERTEX_ATTRIBUTE_USAGE_NORMAL, kind.VERTEX_ATTRIBUTE_TYPE_FLOAT3),
        (usage.VERTEX_ATTRIBUTE_USAGE_UV, kind.VERTEX_ATTRIBUTE_TYPE_FLOAT2),
    )
    return mjrf.MeshConfig(
        max_vertices=vertices,
        max_indices=indices,
        attributes=[mjrf.VertexAttribute(usage=use, type=form) for use, form in layout],
        interleaved=False,
        index_type=mjrf.IndexType.INDEX_TYPE_U32,
        primitive_type=mjrf.MeshPrimitiveType.MESH_PRIMITIVE_TYPE_TRIANGLES,
    )

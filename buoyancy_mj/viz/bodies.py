"""`BodyDrawing`: the bodies of a run in its recording, what of them is wet, and their waterline."""

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.hulls.names import body_name, geom_name
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.submersion.wetted_surface import cut_waterline
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.visible_foils import VisibleFoil, find_visible_foils
from buoyancy_mj.viz.visible_geoms import VisibleGeom, find_visible_geoms

WET = np.array([25, 90, 190])
"""Colour that water adds to a wet geom."""
WATERLINE = (255, 255, 255)


class BodyDrawing:
    """The bodies of a run.

    Args:
        run: the run.
        size: length of the vehicle [m].
    """

    def __init__(self, run: Run, size: float) -> None:
        self.wet: dict[int, NDArray[np.bool_]] = {}
        """Which vertices (n,) of each moving geom are wet, by its index, as last drawn."""
        self._whole: dict[int, bool | None] = {}
        self._run = run
        self._size = size
        self._geoms = list(find_visible_geoms(run.model))
        self._moving = [geom for geom in self._geoms if geom.moves]
        self._foils = list(find_visible_foils(run.model))
        bodies = {geom.body for geom in self._moving} | {one.foil.body for one in self._foils}
        self._bodies = {body: self._body_entity(body) for body in sorted(bodies)}
        self._colours = {geom.geom: _mix_colours(geom) for geom in self._moving}
        self._entities = {geom.geom: self._geom_entity(geom) for geom in self._moving}

    def draw_static(self, log: Log) -> None:
        """Draw all geoms, and foils that are sites, in the frames of their bodies."""
        for geom in self._geoms:
            entity = self._geom_entity(geom)
            mesh = rr.Mesh3D(
                vertex_positions=geom.vertices,
                triangle_indices=geom.faces,
                vertex_normals=geom.normals,
            )
            pose = rr.Transform3D(translation=geom.position, mat3x3=geom.rotation)
            log.keep(entity, mesh)
            log.keep(entity, pose)
            if not geom.moves:
                log.keep(entity, rr.Mesh3D.from_fields(albedo_factor=geom.colour))
        for visible in self._foils:
            self._draw_foil(log, visible)
        radius = 0.003 * self._size
        log.keep("world/waterline", rr.LineStrips3D.from_fields(colors=[WATERLINE], radii=[radius]))

    def draw(self, log: Log, frame: Frame) -> None:
        """Draw one frame: the poses of bodies, what of them is wet, and the waterline."""
        data = frame.data
        for body, entity in self._bodies.items():
            # rotations by columns, as the viewer takes them
            columns = data.xmat[body].reshape(3, 3).T.reshape(1, 9)
            log.draw(entity, rr.Transform3D, translation=data.xpos[body][None], mat3x3=columns)
        self._draw_wetness(log, frame)
        self._draw_waterline(log, frame)

    def _draw_foil(self, log: Log, visible: VisibleFoil) -> None:
        """Draw a foil that is a site in the frame of its body."""
        foil, mesh = visible.foil, visible.mesh
        entity = f"{self._body_entity(foil.body)}/{rr.escape_entity_path_part(foil.name)}"
        plate = rr.Mesh3D(
            vertex_positions=mesh.vertices,
            triangle_indices=mesh.faces,
            vertex_normals=mesh.normals,
            albedo_factor=visible.colour,
        )
        log.keep(entity, plate)
        log.keep(entity, rr.Transform3D(translation=foil.middle, mat3x3=foil.body_from_foil))

    def _draw_wetness(self, log: Log, frame: Frame) -> None:
        """Colour the geoms of which other vertices are wet than in the last frame."""
        uncut = self._uncut_hulls(frame)
        for geom in self._moving:
            whole = uncut.get(geom.geom)
            if whole is not None and whole is self._whole.get(geom.geom):
                continue
            self._whole[geom.geom] = whole
            if whole is not None:
                wet = np.full(len(geom.vertices), whole)
            else:
                wet = self._find_wet_vertices(geom, frame)
            if geom.geom in self.wet and np.array_equal(wet, self.wet[geom.geom]):
                continue
            self.wet[geom.geom] = wet
            dry, dyed = self._colours[geom.geom]
            colours = np.where(wet, dyed, dry)
            log.draw(self._entities[geom.geom], rr.Mesh3D, vertex_colors=colours)

    def _uncut_hulls(self, frame: Frame) -> dict[int, bool]:
        """Whether each geom that the surface does not cut is wet, by its index."""
        loads = frame.loads
        is_wet, areas = (loads.hull.volume > 0.0).tolist(), loads.waterplane_area.tolist()
        return {
            hull.geom: wet
            for hull, wet, area in zip(self._run.buoyancy.hulls, is_wet, areas, strict=True)
            if area == 0.0
        }

    def _find_wet_vertices(self, geom: VisibleGeom, frame: Frame) -> NDArray[np.bool_]:
        """Which vertices (n,) of a geom are under water."""
        world_from_geom = frame.data.geom_xmat[geom.geom].reshape(3, 3)
        points = geom.vertices @ world_from_geom.T + frame.data.geom_xpos[geom.geom]
        wet: NDArray[np.bool_] = self._run.buoyancy.water.depth(points, frame.time) > 0.0
        return wet

    def _draw_waterline(self, log: Log, frame: Frame) -> None:
        """Draw the waterline on all hulls that the surface cuts."""
        data = frame.data
        water = self._run.buoyancy.water
        hulls = self._run.buoyancy.hulls
        lines = [
            cut_waterline(
                hull.mesh, data.geom_xpos[hull.geom], data.geom_xmat[hull.geom], water, frame.time
            )
            for hull, waterplane in zip(hulls, frame.loads.waterplane_area, strict=True)
            # NaN from a method that does not know the area
            if waterplane != 0.0
        ]
        strips = np.concatenate([np.zeros((0, 2, 3)), *lines])
        log.draw("world/waterline", rr.LineStrips3D, strips=strips)

    def _body_entity(self, body: int) -> str:
        """The entity of a body."""
        if body == 0:
            return "world/environment"
        return f"world/bodies/{rr.escape_entity_path_part(body_name(self._run.model, body))}"

    def _geom_entity(self, geom: VisibleGeom) -> str:
        """The entity of a geom."""
        name = geom_name(self._run.model, geom.geom)
        return f"{self._body_entity(geom.body)}/{rr.escape_entity_path_part(name)}"


def _mix_colours(geom: VisibleGeom) -> NDArray[np.uint32]:
    """The colours of a geom where it is dry and where it is wet (2,), as 0xRRGGBBAA."""
    water = np.append(WET, geom.colour[3])
    dyed = (0.45 * geom.colour + 0.55 * water).astype(np.uint8)
    return np.array([geom.colour, dyed], np.uint8).view(">u4").astype(np.uint32).ravel()

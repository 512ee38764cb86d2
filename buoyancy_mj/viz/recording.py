"""`Recording`: a run as Rerun data; static things once, the rest per frame, scalars as columns."""

import contextlib
import os
import sys
import uuid
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyWarning, RecordingError
from buoyancy_mj.hulls.names import body_name, geom_name
from buoyancy_mj.scenes.frames import Frame, Summary
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.submersion.wetted_surface import cut_wetted_surface
from buoyancy_mj.viz import plots
from buoyancy_mj.viz.plots import COLOURS, NEUTRAL, TIMELINE
from buoyancy_mj.viz.rrd import RrdFile
from buoyancy_mj.viz.visible_geoms import VisibleGeom, find_visible_geoms

SURFACE_CELLS = 24
"""Cells along each side of the water's surface."""
SURFACE_WIDTH = 4.0
"""Its side, over the length of the vehicle."""
FLUSH_EVERY = 0.25
"""Simulated time [s] after which what is buffered goes to the file, so that little is lost when a run is killed."""

WATER = (70, 150, 215, 45)
GRID = (190, 225, 250, 45)
WET = np.array([25, 90, 190])
WATERLINE = (255, 255, 255)


class Recording:
    """Frames to a file, to a live viewer, or to both.

    The file grows under the name `NAME.partial.rrd` and takes its own at the end, so that a file
    which was there is replaced as a whole or not at all. A run that breaks off leaves what was
    recorded until then, readable, under the name that `close` returns.

    Args:
        simulation: the run, for its model and scene.
        path: the file; None for none.
        live: stream to a Rerun viewer, which is started if none runs.

    Raises:
        RecordingError: the file cannot be written, or no viewer could be started.
    """

    def __init__(
        self, simulation: Simulation, path: Path | None = None, *, live: bool = False
    ) -> None:
        self.simulation = simulation
        self._file = RrdFile(path) if path is not None else None
        identity = str(uuid.uuid4())
        self._streams = [
            rr.RecordingStream("buoyancy_mj", recording_id=identity)
            for _ in range((path is not None) + live)
        ]
        if self._file is not None:
            self._file.follow(self._streams[0])
        if live:
            try:
                _spawn(self._streams[-1])
            except RecordingError:
                if self._file is not None:
                    self._file.discard()
                raise
        self._scalars: dict[plots.Line, list[float]] = {}
        self._times: list[float] = []
        self._surface_centre: NDArray[np.float64] | None = None
        self._size = 2.0 * max(
            float(np.linalg.norm(hull.position)) + hull.mesh.radius for hull in simulation.hulls
        )
        self._drawn = list(find_visible_geoms(simulation.model))
        self._wet: dict[int, NDArray[np.bool_]] = {}
        self._bodies = sorted({shape.body for shape in self._drawn if shape.moves})
        self._log_static()

    def __del__(self) -> None:
        # a stream that is dropped with data still in it may wait for ever
        for stream in getattr(self, "_streams", ()):
            with contextlib.suppress(Exception):
                stream.flush(timeout_sec=5.0)

    @property
    def closed(self) -> bool:
        """Whether the file has its name already."""
        return self._file is not None and self._file.closed

    def add(self, frame: Frame) -> None:
        """Record one frame.

        Raises:
            RecordingError: the disk is full or the file was taken away; what was written stays.
        """
        for stream in self._streams:
            stream.set_time(TIMELINE, duration=frame.time)
        self._log_bodies(frame)
        self._log_water(frame)
        self._log_forces(frame)
        self._times.append(frame.time)
        for line, value in plots.values(frame, self.simulation.weight).items():
            self._scalars.setdefault(line, []).append(value)
        if self._times[-1] - self._times[0] >= FLUSH_EVERY:
            self._send_scalars()
            self._write()

    def close(self, summary: Summary | None = None, *, complete: bool = True) -> Path | None:
        """Send what is buffered, add the summary and give the file its name; the path under which it lies.

        Raises:
            RecordingError: the last data could not be written.
        """
        if summary is not None:
            self._log(
                "summary",
                rr.TextDocument(_summary_text(summary), media_type="text/markdown"),
                static=True,
            )
        self._send_scalars()
        try:
            for stream in self._streams:
                stream.flush(timeout_sec=60.0)
        except RuntimeError as error:
            warnings.warn(
                f"the live viewer did not take everything: {error}", BuoyancyWarning, stacklevel=2
            )
        if self._file is None:
            return None
        self._file.write()
        return self._file.close(complete=complete)

    def _log(self, entity: str, *data: Any, static: bool = False) -> None:
        for stream in self._streams:
            stream.log(entity, *data, static=static)

    def _write(self) -> None:
        if self._file is not None:
            self._file.write()

    # static things ----------------------------------------------------------------------------------

    def _log_static(self) -> None:
        scene = self.simulation.scene
        look_at = np.array([*scene.start.position[:2], scene.water.level])
        for stream in self._streams:
            stream.send_blueprint(plots.blueprint(scene.title, look_at, self._size))
        self._log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._log(
            "scene",
            rr.TextDocument(f"```toml\n{scene.text}\n```", media_type="text/markdown"),
            static=True,
        )
        for shape in self._drawn:
            entity = self._entity(shape)
            mesh = rr.Mesh3D(
                vertex_positions=shape.vertices,
                triangle_indices=shape.faces,
                vertex_normals=shape.normals,
            )
            self._log(entity, mesh, static=True)
            self._log(
                entity,
                rr.Transform3D(translation=shape.position, mat3x3=shape.rotation),
                static=True,
            )
            if not shape.moves:
                self._log(entity, rr.Mesh3D.from_fields(albedo_factor=shape.colour), static=True)
        hulls = [hull.name for hull in self.simulation.buoyancy.hulls]
        for line, style in plots.styles(self.simulation.buoyancy.causes, hulls).items():
            self._log(plots.entity(line), style, static=True)
        self._write()

    # one frame --------------------------------------------------------------------------------------

    def _log_bodies(self, frame: Frame) -> None:
        """Poses of bodies, what of them is wet, and the waterline on the hulls."""
        data, water = frame.data, self.simulation.scene.water
        for body in self._bodies:
            self._log(
                self._body_entity(body),
                rr.Transform3D(translation=data.xpos[body], mat3x3=data.xmat[body].reshape(3, 3)),
            )
        self._log_wetness(frame)
        lines = [
            cut_wetted_surface(
                hull.mesh, data.geom_xpos[hull.geom], data.geom_xmat[hull.geom], water, frame.time
            )[1]
            for hull, waterplane in zip(
                self.simulation.buoyancy.hulls, frame.loads.waterplane_area, strict=True
            )
            # NaN from a method that does not know it
            if waterplane != 0.0
        ]
        strips = np.concatenate([np.zeros((0, 2, 3)), *lines])
        self._log(
            "world/waterline",
            rr.LineStrips3D(strips, colors=[WATERLINE], radii=[0.003 * self._size]),
        )

    def _log_wetness(self, frame: Frame) -> None:
        """Colours of the vertices that moved through the surface since the last frame."""
        data, water = frame.data, self.simulation.scene.water
        # hulls that the surface does not cut are wholly wet or dry
        hulls, loads = self.simulation.buoyancy.hulls, frame.loads
        uncut = {
            hull.geom: bool(volume > 0.0)
            for hull, volume, waterplane in zip(
                hulls, loads.hull.volume, loads.waterplane_area, strict=True
            )
            if waterplane == 0.0
        }
        for shape in self._drawn:
            if not shape.moves:
                continue
            if shape.geom in uncut:
                wet = np.full(len(shape.vertices), uncut[shape.geom])
            else:
                points = (
                    shape.vertices @ data.geom_xmat[shape.geom].reshape(3, 3).T
                    + data.geom_xpos[shape.geom]
                )
                wet = water.depth(points, frame.time) > 0.0
            if shape.geom in self._wet and np.array_equal(wet, self._wet[shape.geom]):
                continue
            self._wet[shape.geom] = wet
            dyed = (0.45 * shape.colour + 0.55 * np.append(WET, shape.colour[3])).astype(np.uint8)
            self._log(
                self._entity(shape),
                rr.Mesh3D.from_fields(vertex_colors=np.where(wet[:, None], dyed, shape.colour)),
            )

    def _log_water(self, frame: Frame) -> None:
        """The surface around the vehicle; it moves in whole cells, and still water only when it has to."""
        water = self.simulation.scene.water
        width = SURFACE_WIDTH * self._size
        cell = width / SURFACE_CELLS
        centre = np.round(frame.centre_of_mass[:2] / (4.0 * cell)) * 4.0 * cell
        if (
            not water.waves
            and self._surface_centre is not None
            and np.array_equal(centre, self._surface_centre)
        ):
            return
        if self._surface_centre is None:
            corner = np.arange(SURFACE_CELLS)[:, None] * (SURFACE_CELLS + 1) + np.arange(
                SURFACE_CELLS
            )
            a, b = corner.ravel(), corner.ravel() + SURFACE_CELLS + 1
            faces = np.vstack([np.column_stack([a, b, b + 1]), np.column_stack([a, b + 1, a + 1])])
            self._log(
                "world/water",
                rr.Mesh3D.from_fields(triangle_indices=faces, albedo_factor=WATER),
                static=True,
            )
        self._surface_centre = centre
        along = (np.arange(SURFACE_CELLS + 1) / SURFACE_CELLS - 0.5) * width
        x, y = np.meshgrid(centre[0] + along, centre[1] + along, indexing="ij")
        z = water.elevation(x, y, frame.time)
        slope_x, slope_y = np.gradient(z, cell)
        normals = np.stack([-slope_x, -slope_y, np.ones_like(z)], axis=-1).reshape(-1, 3)
        positions = np.stack([x, y, z], axis=-1).reshape(-1, 3)
        self._log(
            "world/water", rr.Mesh3D.from_fields(vertex_positions=positions, vertex_normals=normals)
        )
        lattice = positions.reshape(SURFACE_CELLS + 1, SURFACE_CELLS + 1, 3)[::2, ::2]
        lines = np.concatenate([lattice, lattice.swapaxes(0, 1)])
        self._log(
            "world/water/grid", rr.LineStrips3D(lines, colors=[GRID], radii=[0.0015 * self._size])
        )

    def _log_forces(self, frame: Frame) -> None:
        """Centres of gravity and buoyancy, and an arrow for each force, as long as half the vehicle for its weight."""
        loads, centre = frame.loads, frame.centre_of_mass
        weight = self.simulation.weight
        self._log(
            "world/centres/gravity",
            rr.Points3D([centre], colors=[COLOURS["weight"]], radii=[0.02 * self._size]),
        )
        wet = loads.hull.volume > 0.0
        hulls = loads.hull.centroid[wet]
        self._log(
            "world/centres/buoyancy_of_hulls",
            rr.Points3D(hulls, colors=[COLOURS["buoyancy"]], radii=[0.01 * self._size]),
        )
        total = loads.total.centroid[None] if wet.any() else np.zeros((0, 3))
        self._log(
            "world/centres/buoyancy",
            rr.Points3D(total, colors=[COLOURS["buoyancy"]], radii=[0.02 * self._size]),
        )
        arrows = {"weight": (centre, np.array([0.0, 0.0, -weight]))}
        for cause, rows in loads.by_cause.items():
            arrows[cause] = (loads.total.centroid if wet.any() else centre, rows[:, :3].sum(axis=0))
        scale = 0.5 * self._size / weight if weight > 0.0 else 0.0
        for cause, (origin, force) in arrows.items():
            self._log(
                f"world/forces/{cause}",
                rr.Arrows3D(
                    origins=[origin],
                    vectors=[scale * force],
                    colors=[COLOURS.get(cause, NEUTRAL)],
                    radii=[0.012 * self._size],
                ),
            )

    def _send_scalars(self) -> None:
        if not self._times:
            return
        times = rr.TimeColumn(TIMELINE, duration=self._times)
        for line, values in self._scalars.items():
            for stream in self._streams:
                stream.send_columns(plots.entity(line), [times], rr.Scalars.columns(scalars=values))
        self._times, self._scalars = [], {}

    def _body_entity(self, body: int) -> str:
        """Where a body stands in the recording."""
        if body == 0:
            return "world/environment"
        return f"world/bodies/{rr.escape_entity_path_part(body_name(self.simulation.model, body))}"

    def _entity(self, shape: VisibleGeom) -> str:
        """Where a geom stands in the recording."""
        name = geom_name(self.simulation.model, shape.geom)
        return f"{self._body_entity(shape.body)}/{rr.escape_entity_path_part(name)}"


def _spawn(stream: rr.RecordingStream) -> None:
    """Stream to a viewer; the one of this environment is found although the environment is not activated."""
    before = os.environ.get("PATH", "")
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), before])
    try:
        stream.spawn()
        # a viewer that cannot open its window is gone by now
        stream.flush(timeout_sec=10.0)
    except Exception as error:
        first, *_ = str(error).strip().splitlines()
        raise RecordingError(
            f"no Rerun viewer could be started: {first}; record to a file instead (--record)"
        ) from error
    finally:
        os.environ["PATH"] = before


def _summary_text(summary: Summary) -> str:
    """The summary as a Markdown table."""
    rows = "".join(f"| {name} | {value} |\n" for name, value in summary.rows())
    return f"| {summary.scene} | |\n|---|---|\n{rows}"

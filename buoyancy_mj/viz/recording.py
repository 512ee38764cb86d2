"""`Recording`: a run as Rerun data, in a file, in a live viewer, or in both."""

import time
import uuid
import warnings
from collections.abc import Iterator
from pathlib import Path

import rerun as rr
import rerun.blueprint as rrb

from buoyancy_mj.errors import BuoyancyWarning
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run, place_at_start
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.vehicle.instruments.instruments import Instruments
from buoyancy_mj.viz import instruments, plots, tabs
from buoyancy_mj.viz.blueprints import run_blueprint
from buoyancy_mj.viz.bodies import BodyDrawing
from buoyancy_mj.viz.contacts import ContactDrawing
from buoyancy_mj.viz.forces import ForceDrawing
from buoyancy_mj.viz.legend import Legend
from buoyancy_mj.viz.log import Log
from buoyancy_mj.viz.plot_views import Times, lay_out_spectra, lay_out_tabs
from buoyancy_mj.viz.rrd import RrdFile
from buoyancy_mj.viz.spectra import Spectra
from buoyancy_mj.viz.surroundings import Surroundings
from buoyancy_mj.viz.tendons import TendonDrawing
from buoyancy_mj.viz.texts import write_numbers, write_summary
from buoyancy_mj.viz.thrusters import ThrusterDrawing
from buoyancy_mj.viz.viewers import NOBODY, Viewers
from buoyancy_mj.viz.watch import Watch

FLUSH_EVERY, LIVE_EVERY = 1.0, 0.25
"""Time [s] between writes to the file, and what a live viewer lags; a run that is killed loses no
more of its work."""
NUMBERS, SUMMARY = "numbers", "summary"
"""Entities of the summary in short and as a whole."""
EXPECTED_ROWS = 10
"""Rows of a summary that there is not yet."""


class Recording:
    """A run, recorded frame by frame.

    The file grows under the name `NAME.partial.rrd`, or `NAME.partial-2.rrd` and so on where that
    exists, and takes its own at the end: a file which was there is replaced as a whole or not at
    all. A run that breaks off leaves what was recorded until then, readable, under the name that
    `close` returns.

    Args:
        run: the run: a `Simulation`, or a loop of somebody's own.
        path: the file; None for none.
        viewers: where the run is watched while it goes on.
        has_summary: whether `close` will be given a summary.

    Raises:
        RecordingError: the file cannot be written, or no viewer could be reached or started.
    """

    def __init__(
        self,
        run: Run,
        path: Path | None = None,
        *,
        viewers: Viewers = NOBODY,
        has_summary: bool = True,
    ) -> None:
        self.run = run
        """The run."""
        self._texts = (NUMBERS, "scene") if has_summary else ("scene",)
        # streams of one recording, to the file and to the viewer
        identity = str(uuid.uuid4())
        self._every = LIVE_EVERY if viewers else FLUSH_EVERY
        self._streams: list[rr.RecordingStream] = []
        self._file: RrdFile | None = None
        if path is not None:
            self._streams.append(rr.RecordingStream("buoyancy_mj", recording_id=identity))
            self._file = RrdFile(path, self._streams[-1])
        try:
            self._watch = Watch(viewers, identity)
            self._streams += self._watch.streams
            self._begin()
        except BaseException:
            # nothing of a recording that never began
            if not self.closed and self._file is not None:
                self._file.discard()
            raise

    def _begin(self) -> None:
        """Draw what stays the same, and be ready for frames."""
        run = self.run
        self._log = Log(self._streams)
        vehicles = run.vehicles.values()
        self._several = list(run.vehicles) if len(vehicles) > 1 else []
        self._start = place_at_start(run)
        length = max(vehicle.length for vehicle in vehicles)
        self._surroundings = Surroundings(run, self._start)
        self._legend = Legend(run, self._surroundings.cell)
        self._bodies = BodyDrawing(run, length)
        self._thrusters = ThrusterDrawing(run, length)
        self._tendons = TendonDrawing(run.model)
        self._contacts = ContactDrawing(run, length)
        self._instruments = Instruments(run.model)
        self._entities = tuple(map(instruments.entity, self._instruments.channels))
        self._spectra = Spectra(self._vehicles())
        self._forces = [
            ForceDrawing(vehicle, name, run.buoyancy.causes) for vehicle, name in self._vehicles()
        ]
        self._vehicle_lines = [plots.VehicleLines(*one) for one in self._vehicles()]
        self._lines: tuple[str, ...] | None = None
        self._times: Times | None = None
        self._draw_static()
        self._sent = time.monotonic()

    def __del__(self) -> None:
        # a stream that is dropped with data still in it may wait for ever
        for stream in getattr(self, "_streams", ()):
            try:  # noqa: SIM105 - contextlib may be gone at the end of the interpreter
                stream.flush(timeout_sec=5.0)
            except Exception:
                pass

    @property
    def page(self) -> str | None:
        """Address of the page that is served; None for none."""
        return self._watch.page

    @property
    def closed(self) -> bool:
        """Whether the file has its name already."""
        return self._file is not None and self._file.closed

    def add(self, frame: Frame) -> None:
        """Record one frame.

        Raises:
            RecordingError: the disk is full or the file was taken away; what was written stays.
        """
        begin = frame.time if self._times is None else self._times[0]
        self._times = (begin, frame.time)
        self._log.time = frame.time

        # the picture
        self._bodies.draw(self._log, frame)
        self._surroundings.draw(self._log, frame)
        for forces in self._forces:
            forces.draw(self._log, frame)
        for drawing in (self._thrusters, self._tendons, self._contacts):
            drawing.draw(self._log, frame)

        # the plots, whose lines are the same in all frames
        values = [lines.measure(frame) for lines in self._vehicle_lines]
        if self._lines is None:
            self._lines = tuple(
                plots.entity(line, lines.name)
                for lines, measured in zip(self._vehicle_lines, values, strict=True)
                for line in measured
            )
        self._log.plot(self._lines, [value for measured in values for value in measured.values()])
        self._log.plot(self._entities, self._instruments.read(frame.data))
        self._spectra.add(frame)
        if time.monotonic() - self._sent >= self._every:
            self._log.send()
            self._write()
            self._sent = time.monotonic()

    def close(self, summary: Summary | None = None, *, complete: bool = True) -> Path | None:
        """Send what is buffered, add the summary, and give the file its name.

        Args:
            summary: the run in a few numbers, for the viewer.
            complete: whether the run came to its end. An incomplete recording does not replace a
                file that is there.

        Returns:
            Where the file is; None without one.

        Raises:
            RecordingError: the last data could not be written.
        """
        rows = EXPECTED_ROWS
        if summary is not None:
            text, rows = write_numbers(summary)
            self._log_text(NUMBERS, text)
            self._log_text(SUMMARY, write_summary(summary))
        self._log.send()
        if self._spectra.known:
            self._spectra.draw(self._log)
        self._lay_out(rows, self._times)
        try:
            for stream in self._streams:
                stream.flush(timeout_sec=60.0)
        except RuntimeError as error:
            warnings.warn(
                f"the live viewer did not take everything: {error}", BuoyancyWarning, stacklevel=2
            )
        self._write()
        # before the page that this process serves is gone
        self._watch.close()
        return self._file.close(complete=complete) if self._file is not None else None

    def _draw_static(self) -> None:
        """Draw what stays the same in all frames."""
        run, channels = self.run, self._instruments.channels
        self._lay_out()
        self._log.keep("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP)
        self._log_text("scene", f"```toml\n{run.text}\n```")
        self._surroundings.draw_static(self._log)
        self._bodies.draw_static(self._log)
        for forces in self._forces:
            forces.draw_static(self._log)
        self._thrusters.draw_static(self._log)
        self._legend.draw_static(self._log)

        # the style of each line
        causes = run.buoyancy.causes
        for vehicle, name in self._vehicles():
            styles = plots.styles(causes, [hull.name for hull in vehicle.hulls])
            for line, style in styles.items():
                self._log.keep(plots.entity(line, name), style)
        for entity, style in instruments.styles(channels).items():
            self._log.keep(entity, style)
        self._write()

    def _lay_out(self, rows: int = EXPECTED_ROWS, times: Times | None = None) -> None:
        """Lay out the viewer, for what is known of the lines by now.

        Args:
            rows: number of rows of the summary.
            times: what the run spans; None where that is not known.
        """
        run, extents = self.run, self._log.extents
        vehicles_own = {
            name: tabs.list_vehicle_tabs(vehicle, name, run.buoyancy.causes, extents)
            for vehicle, name in self._vehicles()
        }
        shared = tabs.list_instrument_tabs(self._instruments.channels)
        laid = lay_out_tabs(vehicles_own, shared, extents, times)
        if self._spectra.known:
            laid.append(lay_out_spectra(self._spectra.entities))
        if NUMBERS in self._texts:
            laid.append(rrb.TextDocumentView(origin=SUMMARY, name=SUMMARY.capitalize()))
        layout = run_blueprint(
            run.title,
            self._surroundings,
            self._legend,
            texts=self._texts,
            rows=rows,
            tabs=laid,
        )
        self._write()
        for stream in self._streams:
            stream.send_blueprint(layout)
        if self._file is not None:
            self._file.write_layout()

    def _vehicles(self) -> Iterator[tuple[Vehicle, str]]:
        """Each vehicle, and what tells it from others: '' for the only one."""
        for name, vehicle in self.run.vehicles.items():
            yield vehicle, name if self._several else ""

    def _log_text(self, entity: str, text: str) -> None:
        """Log a text in Markdown."""
        self._log.keep(entity, rr.TextDocument(text, media_type="text/markdown"))

    def _write(self) -> None:
        """Write what has been logged to the file."""
        if self._file is not None:
            self._file.write()

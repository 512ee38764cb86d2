"""Recordings of a run: opened together, kept whatever ends it, and closed together."""

import contextlib
import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NamedTuple

import typer

from buoyancy_mj.cli.console import err, print_line
from buoyancy_mj.cli.films import FilmFlags
from buoyancy_mj.errors import RecordingError, SceneError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.viz.sinks import open_sinks
from buoyancy_mj.viz.viewers import NOBODY, Viewers

if TYPE_CHECKING:
    from buoyancy_mj.viz.ros.stream import RosStream


@dataclasses.dataclass(frozen=True, kw_only=True)
class StreamFlags:
    """Where a run goes as messages of ROS 2."""

    mcap: Path | None = None
    """Write the run for ROS 2 tools into this .mcap file as well."""
    foxglove: Annotated[bool, typer.Option("--foxglove")] = False
    """Serve the run to a Foxglove viewer on this machine while it lasts."""
    foxglove_port: int | None = None
    """Port of that server instead of 8765."""

    def __post_init__(self) -> None:
        if self.mcap is not None and self.mcap.suffix != ".mcap":
            raise SceneError(f"--mcap is '{self.mcap}'; the file's name ends in .mcap")
        if self.foxglove_port is not None and not self.foxglove:
            raise SceneError("--foxglove-port is given without --foxglove; give both")
        if not 0 <= (self.foxglove_port or 0) <= 65535:
            raise SceneError(
                f"--foxglove-port is {self.foxglove_port}; it must be a whole number from 0 to "
                "65535"
            )

    def open(self, simulation: Simulation, *, waits: bool) -> "RosStream | None":
        """Open what was asked for; None for nothing.

        Raises:
            RecordingError: what it needs is not installed, or it cannot be made.
        """
        if self.mcap is None and not self.foxglove:
            return None
        try:
            from buoyancy_mj.viz.ros.stream import PORT, RosStream
        except ModuleNotFoundError as error:
            raise RecordingError(
                f"--mcap and --foxglove need {error.name}, which is not installed: "
                "pip install 'buoyancy_mj[foxglove]'"
            ) from error
        port = (
            (PORT if self.foxglove_port is None else self.foxglove_port) if self.foxglove else None
        )
        return RosStream(simulation, self.mcap, port=port, waits=waits)


class Files(NamedTuple):
    """What a run has left; None for what was not asked for."""

    recording: Path | None = None
    """The recording for Rerun."""
    series: Path | None = None
    """The table."""
    mcap: Path | None = None
    """The messages of ROS 2."""
    video: Path | None = None
    """The film."""
    screenshot: Path | None = None
    """The picture."""


class Recordings:
    """All that the frames of one run go to: opened together, and closed together.

    Args:
        simulation: the run.
        record: the file for Rerun; None for none.
        series: the table; None for none.
        viewers: where the run is watched while it goes on.
        streams: where the run goes as messages of ROS 2.
        films: how it is filmed.
        waits: whether the run waits for a Foxglove viewer, and goes no faster than real time.

    Raises:
        RecordingError: one cannot be made; nothing of the others stays.
    """

    def __init__(
        self,
        simulation: Simulation,
        record: Path | None = None,
        series: Path | None = None,
        *,
        viewers: Viewers = NOBODY,
        streams: StreamFlags,
        films: FilmFlags | None = None,
        waits: bool = False,
    ) -> None:
        self._simulation = simulation
        with contextlib.ExitStack() as undo:
            self._film, self._still = (films or FilmFlags()).open(simulation)
            if self._film is not None:
                undo.callback(self._film.discard)
            self._stream = streams.open(simulation, waits=waits)
            if self._stream is not None:
                undo.callback(self._stream.discard)
            self._recording, self._series = open_sinks(simulation, record, series, viewers=viewers)
            undo.pop_all()
        if self._film is not None and self._film.kept:
            print_line(
                err, f"note: the first {self._film.kept:.2f} s of the film are there already"
            )
        if self._stream is not None and self._stream.port is not None:
            place = f"ws://{self._stream.host}:{self._stream.port}"
            wait = "; the run begins when a panel shows something of it" if waits else ""
            print_line(err, f"open {place} in Foxglove, as a Foxglove WebSocket{wait}")
        if self.page is not None:
            print_line(err, f"open {self.page} in a browser")
        sinks = (self._recording, self._series, self._stream, self._film, self._still)
        self._adders = [sink.add for sink in sinks if sink is not None]

    def __bool__(self) -> bool:
        return bool(self._adders)

    @property
    def page(self) -> str | None:
        """Address of the page at which the run is watched; None for none."""
        return self._recording.page if self._recording is not None else None

    def add(self, frame: Frame) -> None:
        """Record one frame.

        Raises:
            RecordingError: one cannot be written to its end; what was written stays.
        """
        for add in self._adders:
            add(frame)

    def close(self, summary: Summary) -> Files:
        """Close all after a whole run, and say where they are.

        Raises:
            RecordingError: the last data could not be written.
        """
        return Files(
            self._recording.close(summary) if self._recording is not None else None,
            self._series.close() if self._series is not None else None,
            self._stream.close(summary) if self._stream is not None else None,
            self._film.close() if self._film is not None else None,
            self._still.close() if self._still is not None else None,
        )

    def keep(self, summary: Callable[[], Summary]) -> None:
        """Close all after a run that broke off, and say where they are."""
        recording, series, stream = self._recording, self._series, self._stream
        film = self._film
        if recording is not None and not recording.closed:
            self._keep("recording", lambda: recording.close(summary(), complete=False))
        if series is not None and not series.closed:
            self._keep("series", lambda: series.close(complete=False))
        if stream is not None and not stream.closed:
            self._keep("MCAP file", lambda: stream.close(complete=False))
        if film is not None and not film.closed:
            self._keep("film", lambda: film.close(complete=False))

    def _keep(self, what: str, close: Callable[[], Path | None]) -> None:
        """Close something that broke off, and say where it is."""
        try:
            partial = close()
        except RecordingError as error:
            print_line(err, f"note: {error}", style="yellow")
        else:
            if partial is not None:
                time = self._simulation.data.time
                print_line(err, f"the {what} up to {time:.2f} s is in '{partial}'")

"""Recordings of a run: opened together, kept whatever ends it, and closed together."""

import dataclasses
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Protocol

import typer

from buoyancy_mj.cli.console import err, print_line
from buoyancy_mj.errors import RecordingError, SceneError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary

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

    def open(self, simulation: Simulation, *, paced: bool) -> "RosStream | None":
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
        return RosStream(simulation, self.mcap, port=port, paced=paced)


class Sink(Protocol):
    """What takes the frames of a run: a file, a viewer, or both."""

    @property
    def closed(self) -> bool:
        """Whether it takes no more."""

    def add(self, frame: Frame) -> None:
        """Take one frame."""

    def close(self, summary: Summary | None = None, *, complete: bool = True) -> Path | None:
        """Take no more; where its file is, None without one."""


class Recordings:
    """The recordings of one run.

    Args:
        simulation: the run.
        record: the file for Rerun; None for none.
        live: whether to stream to a Rerun viewer.
        streams: where the run goes as messages of ROS 2.
        paced: whether a Foxglove viewer sees no more than real time.

    Raises:
        RecordingError: one cannot be made; those before it are gone.
    """

    def __init__(
        self,
        simulation: Simulation,
        record: Path | None,
        *,
        live: bool = False,
        streams: StreamFlags,
        paced: bool = False,
    ) -> None:
        self._simulation = simulation
        self._stream = streams.open(simulation, paced=paced)
        self._sinks: list[Sink] = [] if self._stream is None else [self._stream]
        if record is not None or live:
            from buoyancy_mj.viz.recording import Recording  # needs Rerun, which takes time

            try:
                self._sinks.append(Recording(simulation, record, live=live))
            except BaseException:
                if self._stream is not None:
                    self._stream.discard()
                raise
        self._announce()

    def wait_for_viewer(self) -> None:
        """Wait for a Foxglove viewer, if there is a server for one."""
        if self._stream is not None and self._stream.port is not None:
            print_line(err, "waiting for a viewer")
            self._stream.wait_for_viewer()

    def __bool__(self) -> bool:
        return bool(self._sinks)

    def add(self, frame: Frame) -> None:
        """Record one frame.

        Raises:
            RecordingError: one cannot be written to its end; what was written stays.
        """
        for sink in self._sinks:
            sink.add(frame)

    def close(self, summary: Summary) -> list[Path]:
        """Close all after a whole run; their files.

        Raises:
            RecordingError: the last data could not be written.
        """
        paths = [sink.close(summary) for sink in self._open()]
        return [path for path in paths if path is not None]

    def keep(self, summary: Callable[[], Summary]) -> None:
        """Close all after a run that broke off, and say where they are."""
        for sink in self._open():
            try:
                partial = sink.close(summary(), complete=False)
            except RecordingError as error:
                print_line(err, f"note: {error}", style="yellow")
            else:
                if partial is not None:
                    time = self._simulation.data.time
                    print_line(err, f"the recording up to {time:.2f} s is in '{partial}'")

    def _announce(self) -> None:
        """Say where a Foxglove viewer finds the run."""
        if self._stream is not None and self._stream.port is not None:
            place = f"ws://{self._stream.host}:{self._stream.port}"
            print_line(err, f"open {place} in Foxglove, as a Foxglove WebSocket")

    def _open(self) -> Sequence[Sink]:
        """Those that are not closed."""
        return [sink for sink in self._sinks if not sink.closed]

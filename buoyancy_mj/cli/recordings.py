"""Recordings of a run: opened together, kept whatever ends it, and closed together."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Protocol

from buoyancy_mj.cli.console import err, print_line
from buoyancy_mj.errors import RecordingError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.summary import Summary


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

    Raises:
        RecordingError: one cannot be made; those before it are gone.
    """

    def __init__(self, simulation: Simulation, record: Path | None, *, live: bool = False) -> None:
        self._simulation = simulation
        self._sinks: list[Sink] = []
        if record is not None or live:
            from buoyancy_mj.viz.recording import Recording  # needs Rerun, which takes time

            self._sinks.append(Recording(simulation, record, live=live))

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

    def _open(self) -> Sequence[Sink]:
        """Those that are not closed."""
        return [sink for sink in self._sinks if not sink.closed]

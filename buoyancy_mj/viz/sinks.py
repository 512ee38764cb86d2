"""`open_sinks`: what the frames of a run go to, a recording, a table, or both."""

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from buoyancy_mj.scenes.run import Run
from buoyancy_mj.scenes.series import Series
from buoyancy_mj.viz.viewers import NOBODY, Viewers

if TYPE_CHECKING:
    from buoyancy_mj.viz.recording import Recording


class Sinks(NamedTuple):
    """What frames go to."""

    recording: "Recording | None"
    """The recording, in a file or in a live viewer; None for none."""
    series: Series | None
    """The table; None for none."""


def open_sinks(
    run: Run,
    path: Path | None,
    series: Path | None,
    *,
    viewers: Viewers = NOBODY,
    has_summary: bool = True,
) -> Sinks:
    """Open a recording and a table; where one cannot be opened, nothing of the other stays.

    Args:
        run: the run.
        path: file of the recording; None for none.
        series: file of the table; None for none.
        viewers: where the run is watched while it goes on.
        has_summary: whether the recording will be given a summary.

    Raises:
        RecordingError: a file cannot be written, or no viewer could be started.
    """
    table = Series(run, series) if series is not None else None
    if path is None and not viewers:
        return Sinks(None, table)
    try:
        from buoyancy_mj.viz.recording import Recording  # needs Rerun, which takes time to import

        return Sinks(Recording(run, path, viewers=viewers, has_summary=has_summary), table)
    except BaseException:
        if table is not None:
            table.discard()
        raise

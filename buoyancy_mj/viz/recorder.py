"""`Recorder`: somebody's own loop in a recording and a table."""

import contextlib
import math
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.forward import forward_without_control
from buoyancy_mj.errors import DivergenceError, RecordingError, describe
from buoyancy_mj.scenes.frame_source import FrameSource
from buoyancy_mj.scenes.run import find_run
from buoyancy_mj.values import read_number
from buoyancy_mj.viz.sinks import open_sinks
from buoyancy_mj.viz.viewers import Viewers

if TYPE_CHECKING:
    from buoyancy_mj.scenes.series import Series
    from buoyancy_mj.viz.recording import Recording


class Recorder:
    """Records a loop over a model and its data, for the Rerun viewer, as a table, or both.

    It looks at a copy of the state, so that the loop runs as it would without, bit for bit, and no
    controller is called (mjcb_control). What a frame holds is computed at exactly its time: loads,
    sensors, actuator forces and contacts.

    The files grow under the names `NAME.partial.EXT` and take their own at the end of the `with`
    block. Whatever ends the block, an error or Ctrl-C, what was recorded stays and opens. Only a
    whole run replaces a file that is there.

    Args:
        model: a model with water: its own, or a `Buoyancy` that is a callback of MuJoCo now.
        data: its data, which the loop steps.
        path: the recording, whose name ends in .rrd; None for none.
        series: the table, whose name ends in .csv or .parquet; None for none. See
            `scenes.series.Series` for its columns.
        rate: frames in a second of simulated time [Hz]; `record` costs next to nothing when none is
            due. None records each time.
        buoyancy: the water, where it is called by hand, or where several act.
        live: whether to stream to a Rerun viewer, which is started if none runs.
        connect: address of a viewer that listens already, as 'HOST:PORT' or a URL of Rerun.
        serve: port of this machine at which to serve a page for a browser, until the process
            ends; the next port is taken too.

    Raises:
        ModelError: no water acts on the model, several do and none is named, or the data are of
            another model.
        RecordingError: a file of another kind, one that cannot be written, nothing to record to, or
            no viewer could be reached or started.

    Example:
        >>> with Recorder(model, data, "run.rrd", rate=60.0) as recorder:
        ...     while data.time < 5.0:
        ...         mujoco.mj_step(model, data)
        ...         recorder.record()
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        path: str | Path | None = None,
        *,
        series: str | Path | None = None,
        rate: float | None = None,
        buoyancy: Buoyancy | None = None,
        live: bool = False,
        connect: str | None = None,
        serve: int | None = None,
    ) -> None:
        self.paths: tuple[Path, ...] = ()
        """Where the files are, once they are closed."""
        self.page: str | None = None
        """Address of the page that is served; None for none."""
        self._rate = None if rate is None else read_number(RecordingError, "rate", rate, above=0.0)
        self._begin: float | None = None
        self._last = -math.inf
        self._recorded = 0
        self._closed = False
        viewers = Viewers(live=live, connect=connect, serve=serve)
        _check_places(path, series, viewers)
        self._run = find_run(model, data, buoyancy)
        self._source = FrameSource(model, self._run.buoyancy, self._run.vehicles)
        self._sinks = open_sinks(
            self._run,
            None if path is None else Path(path),
            None if series is None else Path(series),
            viewers=viewers,
            has_summary=False,
        )
        if self._sinks.recording is not None:
            self.page = self._sinks.recording.page

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(
        self, _: type[BaseException] | None, error: BaseException | None, __: TracebackType | None
    ) -> None:
        if error is None:
            self.close()
            return
        # the error that ended the run stays the one that is told
        try:
            self.close(complete=False)
        except RecordingError as failure:
            error.add_note(str(failure))
        for path in self.paths:
            error.add_note(f"what was recorded is in '{path}'")

    def record(self) -> None:
        """Record the present as a frame, if one is due.

        Raises:
            DivergenceError: a position or velocity is not finite.
            RecordingError: the time went back, as after a reset; the recorder is closed; or the
                disk is full. What was written stays.
        """
        now = float(self._run.data.time)
        if self._closed:
            raise RecordingError("this recorder is closed; make another one for another run")
        if now < self._last:
            raise RecordingError(
                f"the time went back from {self._last:g} s to {now:g} s; make a Recorder for each "
                "run, as after mj_resetData"
            )
        if not self._is_due(now):
            return
        frame = self._source.take(self._run.data, self._forward)
        self._last = now
        for sink in self._sinks:
            if sink is not None:
                sink.add(frame)

    def close(self, *, complete: bool = True) -> tuple[Path, ...]:
        """Give the files their names; the end of a `with` block does so.

        Args:
            complete: whether the run came to its end. Where it did not, files that are there stay.

        Returns:
            Where the files are.

        Raises:
            RecordingError: the last data could not be written, or a file cannot take its name.
        """
        if not self._closed:
            self._closed = True
            # each is closed, whatever the others raise
            with contextlib.ExitStack() as stack:
                for sink in reversed(self._sinks):
                    stack.callback(self._close_sink, sink, complete=complete)
        return self.paths

    def _is_due(self, now: float) -> bool:
        """Whether a frame is due at a time [s]; then it counts as recorded."""
        if self._begin is None:
            self._begin = now
            return True
        if self._rate is None:
            return True
        # the small part forgives the rounding of time * rate
        due = math.floor((now - self._begin) * self._rate + 1e-9)
        if due <= self._recorded:
            return False
        self._recorded = due
        return True

    def _forward(self, data: mujoco.MjData) -> None:
        """A pass over the data of a frame, with the water at work."""
        for what, values in (("position", data.qpos), ("velocity", data.qvel)):
            if not np.isfinite(values).all():
                raise DivergenceError(
                    f"a {what} is {values[~np.isfinite(values)][0]} at {data.time:.4g} s, so there "
                    "is nothing to record; try a smaller timestep"
                )
        forward_without_control(data, self._run.buoyancy)

    def _close_sink(self, sink: "Recording | Series | None", *, complete: bool) -> None:
        """Close one of the files, and keep where it is."""
        if sink is not None and not sink.closed:
            path = sink.close(complete=complete)
            self.paths += (path,) if path is not None else ()


def _check_places(path: str | Path | None, series: str | Path | None, viewers: Viewers) -> None:
    """Refuse a recording of another kind of file, and one that goes nowhere."""
    if path is None and series is None and not viewers:
        raise RecordingError(
            "there is nothing to record to; give a file ('run.rrd'), series='run.csv' or live=True"
        )
    for what, place in (("the recording", path), ("the series", series)):
        if place is not None and not isinstance(place, str | Path):
            raise RecordingError(f"{what} is {describe(place)}; it must be the name of a file")
    if path is not None and Path(path).suffix != ".rrd":
        raise RecordingError(f"the recording is '{path}'; the name of a recording ends in .rrd")

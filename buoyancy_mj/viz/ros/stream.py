"""`RosStream`: a run as messages of ROS 2, in an MCAP file, on a Foxglove server, or on both."""

import threading
import time
from pathlib import Path
from typing import Any

import foxglove
import numpy as np
from foxglove.websocket import Capability, ServerListener, WebSocketServer

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run, place_at_start
from buoyancy_mj.scenes.summary import Summary
from buoyancy_mj.viz.framing import find_middle, measure_extent
from buoyancy_mj.viz.ros import messages as ros
from buoyancy_mj.viz.ros.markers import MARKER, MARKERS, draw_geoms, draw_sea
from buoyancy_mj.viz.ros.mcap_file import McapFile
from buoyancy_mj.viz.ros.motion import Motion
from buoyancy_mj.viz.ros.sensors import Sensors

HOST = "127.0.0.1"
"""Address of the server: this machine alone reaches it."""
PORT = 8765
"""Port to which Foxglove connects by itself."""
SEA_RATE = 10.0
"""Pictures of the sea in a second of simulated time [Hz]: each is as large as all else."""
FLUSH_EVERY = 0.25
"""Simulated time [s] between writes to the file; a run that is killed loses no more."""


class RosStream:
    """A run, told frame by frame as messages of ROS 2 (`cdr`, with `ros2msg` definitions).

    An MCAP file grows under the name `NAME.partial.mcap` and takes its own at the end; whatever
    ends the run, what was written stays. The server serves the present to viewers on this machine.

    Args:
        run: the run.
        path: the MCAP file; None for none.
        port: where to serve a Foxglove viewer, 0 for any port that is free; None for no server.
        waits: whether a run with a server waits after its first frame until a viewer asks for a
            topic, and then goes no faster than real time.

    Raises:
        RecordingError: the file cannot be written, or the port is in use.
    """

    def __init__(
        self, run: Run, path: Path | None = None, *, port: int | None = None, waits: bool = False
    ) -> None:
        self._context = foxglove.Context()
        self._channels: dict[str, foxglove.Channel] = {}
        self._motion, self._sensors = Motion(run), Sensors(run)
        self._water = run.buoyancy.water
        self._size = measure_extent(run.vehicles.values(), place_at_start(run))
        self._viewers = _Viewers()
        self._file = McapFile(path, self._context) if path is not None else None
        try:
            self._server = self._serve(run.title, port) if port is not None else None
        except BaseException:
            if self._file is not None:
                self._file.discard()
            raise

        # what never changes is encoded once, and told to each viewer that comes
        self._still = [
            ("/meshes", MARKERS, ros.encode(MARKERS, draw_geoms(run))),
            self._encode(*self._motion.fixed()),
        ]
        self._waits = waits and self._server is not None
        self._began: float | None = None
        self._closed = False
        self._next_sea = self._next_flush = -np.inf

    @property
    def host(self) -> str:
        """Address of the server."""
        return HOST

    @property
    def port(self) -> int | None:
        """Where the server listens; None without one."""
        return int(self._server.port) if self._server is not None else None

    @property
    def closed(self) -> bool:
        """Whether it takes no more."""
        return self._closed

    @property
    def has_viewer(self) -> bool:
        """Whether a viewer has asked for a topic."""
        return self._viewers.came.is_set()

    def add(self, frame: Frame) -> None:
        """Tell one frame.

        Raises:
            RecordingError: the disk is full or gone; what was written stays.
        """
        if self._waits:
            self._pace(frame.time)
        if self._viewers.take_news():
            for name, kind, message in self._still:
                self._log(name, kind, message, frame.time)
        for name, kind, message in (*self._motion.at(frame), *self._sensors.at(frame)):
            self._log(name, kind, ros.encode(kind, message), frame.time)
        if frame.time >= self._next_sea - 1e-9:
            self._next_sea = frame.time + 1.0 / SEA_RATE
            middle = find_middle(one.centre_of_mass for one in frame.vehicles.values())
            sea = draw_sea(self._water, middle, self._size, frame.time)
            self._log("/sea", MARKER, ros.encode(MARKER, sea), frame.time)
        if self._server is not None:
            self._server.broadcast_time(ros.to_nanoseconds(frame.time))
        if self._file is not None and frame.time >= self._next_flush:
            self._next_flush = frame.time + FLUSH_EVERY
            self._check(self._file, self._file.flush())

    def close(self, summary: Summary | None = None, *, complete: bool = True) -> Path | None:
        """End the server, and give the file its name.

        Args:
            summary: kept in the file, as the metadata 'summary'.
            complete: whether the run came to its end. An incomplete file replaces none.

        Returns:
            Where the file is; None without one.

        Raises:
            RecordingError: the last data could not be written.
        """
        self._closed = True
        if self._server is not None:
            self._server.stop()
        if self._file is None:
            return None
        if summary is not None:
            self._file.keep({name: str(value) for name, value in summary.values().items()})
        self._check(self._file, self._file.finish())
        return self._file.take_name(complete=complete)

    def discard(self) -> None:
        """End the server and remove the file, of a run that never began."""
        self._closed = True
        if self._server is not None:
            self._server.stop()
        if self._file is not None:
            self._file.discard()

    def _serve(self, title: str, port: int) -> WebSocketServer:
        """Start the server."""
        try:
            return foxglove.start_server(
                name=title,
                host=HOST,
                port=port,
                capabilities=[Capability.Time],
                server_listener=self._viewers,
                context=self._context,
            )
        except Exception as error:
            raise RecordingError(
                f"no Foxglove server can listen on port {port} ({error}); end what listens there, "
                "or take another (--foxglove-port)"
            ) from error

    def _check(self, file: "McapFile", error: OSError | None) -> None:
        """Close the file after an error, and raise it."""
        if error is None:
            return
        self._closed = True
        if self._server is not None:
            self._server.stop()
        raise RecordingError(
            f"the MCAP file broke off: {error.strerror}; what was written is in "
            f"'{file.take_name(complete=False)}'"
        ) from error

    def _pace(self, now: float) -> None:
        """Wait until a frame of a time [s] is due; the second waits for a viewer before."""
        if self._next_sea == -np.inf:
            return
        if self._began is None:
            self._viewers.came.wait()
            self._began = time.monotonic() - now
        time.sleep(max(0.0, self._began + now - time.monotonic()))

    def _encode(self, name: str, kind: str, message: Any) -> tuple[str, str, bytes]:
        """A message as bytes, with its topic and its type."""
        return name, kind, ros.encode(kind, message)

    def _log(self, name: str, kind: str, message: bytes, now: float) -> None:
        """Tell a message to a topic, which is made if there is none."""
        if name not in self._channels:
            self._channels[name] = foxglove.Channel(
                name,
                schema=foxglove.Schema(name=kind, encoding="ros2msg", data=ros.define(kind)),
                message_encoding="cdr",
                context=self._context,
            )
        self._channels[name].log(message, log_time=ros.to_nanoseconds(now))


class _Viewers(ServerListener):
    """Hears of viewers that come."""

    def __init__(self) -> None:
        self.came = threading.Event()
        """Set when the first viewer has come."""
        self._news = True

    def on_subscribe(self, *_: Any) -> None:
        """A viewer asks for a topic."""
        self._news = True
        self.came.set()

    def take_news(self) -> bool:
        """Whether a viewer has come since the last call; a file counts as the first."""
        news, self._news = self._news, False
        return news

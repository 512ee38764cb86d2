"""`Watch`: the streams of a recording to those who watch the run."""

import atexit
from urllib.parse import quote

import rerun as rr

from buoyancy_mj.errors import RecordingError
from buoyancy_mj.viz.viewer_process import HOST, ViewerProcess, listens
from buoyancy_mj.viz.viewers import ANOTHER_WAY, PORT, Viewers, read_address

_SERVED: set[int] = set()
"""Ports at which this process serves pages, each for all its runs."""


class Watch:
    """Streams of one recording to viewers, which are open.

    Args:
        viewers: where.
        identity: of the recording, which all its streams share.

    Raises:
        RecordingError: a viewer cannot be reached or started.
    """

    def __init__(self, viewers: Viewers, identity: str) -> None:
        self.streams: list[rr.RecordingStream] = []
        """The streams."""
        self.page: str | None = None
        """Address of the page that is served until this process ends; None for none."""
        viewers.check()
        addresses = []
        if viewers.live:
            addresses.append(_open_window())
        if viewers.connect is not None:
            addresses.append(read_address(viewers.connect).url)
        if viewers.serve is not None:
            addresses.append(self._serve(viewers.serve))
        for address in addresses:
            stream = rr.RecordingStream("buoyancy_mj", recording_id=identity)
            stream.connect_grpc(address)
            self.streams.append(stream)

    def close(self) -> None:
        """Send no more; what was sent stays where it was seen."""
        for stream in self.streams:
            stream.disconnect()

    def _serve(self, port: int) -> str:
        """Serve a page; the address to which to stream."""
        if port not in _SERVED:
            _start_server(port)
        address = f"rerun+http://localhost:{port + 1}/proxy"
        self.page = f"http://localhost:{port}/?url={quote(address, safe=':/')}"
        return address


def _start_server(port: int) -> None:
    """Serve a page to this machine alone.

    Raises:
        RecordingError: a port is taken, or the server does not start.
    """
    for taken in filter(listens, (port, port + 1)):
        raise RecordingError(
            f"port {taken} of this machine is taken already; choose another (--serve-port)"
        )
    arguments = [
        "--serve-web", "--bind", HOST, "--web-viewer-port", str(port), "--port", str(port + 1)
    ]  # fmt: skip
    atexit.register(ViewerProcess(arguments, (port, port + 1), ANOTHER_WAY).stop)
    _SERVED.add(port)


def _open_window() -> str:
    """The URL of a viewer on this machine; one is started if none runs.

    Raises:
        RecordingError: none could be started.
    """
    if not listens(PORT):
        ViewerProcess(["--port", str(PORT), "--expect-data-soon"], [PORT], ANOTHER_WAY)
    return f"rerun+http://{HOST}:{PORT}/proxy"

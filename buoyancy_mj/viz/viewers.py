"""`Viewers`: where a run is watched in Rerun while it goes on."""

import dataclasses
import os
import socket
import sys
from typing import NamedTuple
from urllib.parse import urlsplit

from buoyancy_mj.errors import RecordingError, describe
from buoyancy_mj.viz.viewer_process import listens

PORT = 9876
"""Where a viewer listens for recordings."""
X11_PORT = 6000
"""Where the first screen of a machine listens, if it listens at all."""
ANOTHER_WAY = "record to a file instead (--record)"
"""What to do where a run cannot be watched."""
PAGE_PORT = 9090
"""Where a page is served; the port after it has what the page shows."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Viewers:
    """Where a run is watched.

    Raises:
        RecordingError: an address or a port that cannot be.
    """

    live: bool = False
    """Whether to stream to a viewer on this machine, which is started if none runs."""
    connect: str | None = None
    """Address of a viewer that listens already, as 'HOST:PORT' or a URL of Rerun; None for none."""
    serve: int | None = None
    """Port of this machine at which to serve a page for a browser; None for none."""

    def __post_init__(self) -> None:
        if self.connect is not None:
            read_address(self.connect)
        if self.serve is not None and not 1 <= self.serve < 65535:
            raise RecordingError(
                f"the port is {describe(self.serve)}; it must be a whole number from 1 to 65534, "
                "for the next one is taken too"
            )

    def check(self) -> None:
        """Look whether the run can be watched, before it is made.

        Raises:
            RecordingError: there is no display to open a window on, or no viewer listens.
        """
        if self.live and not listens(PORT) and not _find_display():
            raise RecordingError(
                "no Rerun viewer could be started: there is no display; serve a page to a browser "
                f"(--serve), or {ANOTHER_WAY}"
            )
        if self.connect is not None:
            _, host, port = read_address(self.connect)
            if not listens(port, host):
                raise RecordingError(
                    f"no Rerun viewer listens at {host}:{port}; start one there "
                    f"(rerun --port {port}), or {ANOTHER_WAY}"
                )

    def __bool__(self) -> bool:
        return self.live or self.connect is not None or self.serve is not None


class Address(NamedTuple):
    """Where a viewer listens."""

    scheme: str
    """How it is spoken to: 'rerun', 'rerun+http' or 'rerun+https'."""
    host: str
    """Name or number of its machine."""
    port: int
    """Port."""

    @property
    def url(self) -> str:
        """The address as Rerun has it."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{self.scheme}://{host}:{self.port}/proxy"


def read_address(address: str) -> Address:
    """Read the address of a viewer, 'HOST:PORT' or a URL of Rerun.

    Raises:
        RecordingError: the text is no such address.
    """
    url = address if "://" in address else f"rerun+http://{address}"
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port
        known = parts.scheme in ("rerun", "rerun+http", "rerun+https")
        blank = any(map(str.isspace, url))
        if not host or not known or blank or parts.path not in ("", "/", "/proxy") or parts.query:
            raise ValueError
    except ValueError:
        raise RecordingError(
            f"the address of the viewer is {describe(address)}; it must be HOST:PORT, as "
            f"localhost:{PORT}, or a URL as rerun+http://localhost:{PORT}/proxy"
        ) from None
    return Address(parts.scheme, host, PORT if port is None else port)


def _find_display() -> bool:
    """Whether a viewer finds a screen to open a window on; true where that cannot be told."""
    if not sys.platform.startswith("linux"):
        return True
    if any(map(os.environ.get, ("WAYLAND_DISPLAY", "WAYLAND_SOCKET"))):
        return True
    # the names of screens: ':0' and 'unix:0.0' of this machine, 'HOST:0' of others
    host, _, number = os.environ.get("DISPLAY", "").rpartition(":")
    number = number.partition(".")[0]
    if not number.isdigit():
        return False
    if host not in ("", "unix"):
        return listens(X11_PORT + int(number), host)
    with socket.socket(socket.AF_UNIX) as screen:
        # a leading zero byte names what no file stands for
        places = [f"/tmp/.X11-unix/X{number}", f"\0/tmp/.X11-unix/X{number}"]
        return any(screen.connect_ex(place) == 0 for place in places)


NOBODY = Viewers()
"""Nobody watches."""

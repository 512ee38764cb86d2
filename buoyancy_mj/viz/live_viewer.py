"""A Rerun viewer that shows a run while it goes on."""

import os
import socket
import sys
from pathlib import Path

import rerun as rr

from buoyancy_mj.errors import RecordingError

PORT = 9876
"""Where a viewer listens for recordings."""


def open_viewer(stream: rr.RecordingStream) -> None:
    """Stream to a viewer; that of this environment is used even if it is not activated.

    Raises:
        RecordingError: none could be started.
    """
    if _lacks_display() and not _has_viewer():
        raise RecordingError(
            "no Rerun viewer could be started: there is no display; "
            "record to a file instead (--record)"
        )
    path = os.environ.get("PATH", "")
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), path])
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
        os.environ["PATH"] = path


def _lacks_display() -> bool:
    """Whether this machine says that it has no screen to open a window on."""
    names = ("DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET")
    return sys.platform.startswith("linux") and not any(map(os.environ.get, names))


def _has_viewer() -> bool:
    """Whether a viewer listens already where recordings are streamed to."""
    try:
        with socket.create_connection(("127.0.0.1", PORT), timeout=0.5):
            return True
    except OSError:
        return False

"""`view_in_studio`: a scene or a model in a window, or on a page, if this machine can show it."""

import contextlib
import socket
from pathlib import Path

from buoyancy_mj.errors import DrawingError
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.studio.library import load_studio
from buoyancy_mj.viz.viewer import has_display

LOOPBACK = "127.0.0.1"
"""The interface that this machine alone reaches."""
WEB = "give --web, and open the page in a browser"
"""What to do where there can be no window."""


def view_in_studio(
    shown: Scene | Path,
    *,
    web: bool = False,
    host: str = LOOPBACK,
    port: int = 0,
    trust: bool = False,
) -> None:
    """Show a scene in its water, or a model's file, until the window is closed or Ctrl-C.

    A model that brings no water is shown dry, with what the inspection says of it, and the panel
    can put it into water.

    Args:
        shown: the scene, or the file.
        web: whether to serve it to browsers instead of opening a window.
        host: address of the interface on which to serve.
        port: port on which to serve; 0 for the first free one from 8080 on.
        trust: whether to run the Python files that the scene names as controllers.

    Raises:
        DrawingError: no display, no graphics, no Studio, or a port that is taken.
        ModelError, MeshError, SceneError: what `Simulation` raises.
    """
    load_studio()
    if web:
        check_port(host, port)
    else:
        check_window()

    # these modules are built on Studio
    from buoyancy_mj.studio.opening import open_window, serve_page

    if web:
        serve_page(shown, host, port, trust=trust)
    else:
        open_window(shown, trust=trust)


def check_window() -> None:
    """Check that a window can be opened and drawn here.

    Raises:
        DrawingError: it cannot.
    """
    from buoyancy_mj.drawing.filament.graphics import count_devices

    if not has_display():
        raise DrawingError(f"Studio's window needs a display, and there is none here; {WEB}")
    if not count_devices():
        raise DrawingError(
            "Studio's window draws the sea through Vulkan, and there is none here; install a "
            "driver, which may be one for the processor alone (apt install libvulkan1 "
            f"mesa-vulkan-drivers), or {WEB}"
        )


def check_port(host: str, port: int) -> None:
    """Check that a page can be served here.

    Raises:
        DrawingError: the port is taken or forbidden, or the host is none of this machine.
    """
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        with contextlib.closing(socket.socket(family, socket.SOCK_STREAM)) as trial:
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            trial.bind((host, port))
            trial.listen()
    except (OSError, OverflowError) as error:
        raise DrawingError(
            f"no page can be served at {host}:{port}: {error}; give another --port, or 0 for the "
            f"first free one, and as --host an address of this machine, such as {LOOPBACK}"
        ) from error

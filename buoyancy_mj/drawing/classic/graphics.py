"""OpenGL for the classic renderer, without a display where that works."""

import ctypes.util
import os
import sys
from typing import Any

from buoyancy_mj.errors import DrawingError

SCREENS = ("DISPLAY", "WAYLAND_DISPLAY")
"""Variables of the environment that name a display."""
MEND = "install EGL or OSMesa (apt install libegl1 libgl1-mesa-dri, or libosmesa6)"
"""What to do where there is no OpenGL."""


def open_gl() -> Any:
    """A context of OpenGL, current in this thread, on a GPU where EGL finds one.

    The variable MUJOCO_GL chooses how, as for `mujoco.Renderer`: egl, osmesa or glfw.

    Raises:
        DrawingError: there is no OpenGL.
    """
    try:
        context = _find_class()(16, 16)
        context.make_current()
    # libraries that are missing or too old say so in many ways
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise DrawingError(
            f"the classic renderer draws through OpenGL, and there is none here: {reason}; {MEND}"
        ) from error
    return context


def _find_class() -> Any:
    """The class of contexts that may work here."""
    if os.environ.get("MUJOCO_GL") or not sys.platform.startswith("linux"):
        from mujoco.gl_context import GLContext
    elif ctypes.util.find_library("EGL"):
        from mujoco.egl import GLContext
    elif ctypes.util.find_library("OSMesa"):
        from mujoco.osmesa import GLContext
    elif any(map(os.environ.get, SCREENS)):
        from mujoco.glfw import GLContext
    else:
        raise OSError("neither EGL nor OSMesa nor a display")
    return GLContext

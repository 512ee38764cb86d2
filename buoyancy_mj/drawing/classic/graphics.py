"""OpenGL for the classic renderer, without a display where that works."""

import ctypes.util
import importlib
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
    module = importlib.import_module(f"mujoco.{_choose()}")
    return module.GLContext


def _choose() -> str:
    """The library that makes contexts, as MuJoCo calls it."""
    chosen = os.environ.get("MUJOCO_GL", "").lower()
    has_screen = any(map(os.environ.get, SCREENS))
    if chosen == "glfw" and sys.platform.startswith("linux") and not has_screen:
        # GLFW only warns, and MuJoCo fails later
        raise OSError("MUJOCO_GL=glfw needs a display; take MUJOCO_GL=egl, or leave it out")
    if chosen in ("egl", "osmesa", "glfw"):
        return chosen
    if not sys.platform.startswith("linux"):
        return "cgl" if sys.platform == "darwin" else "glfw"
    for name, library in (("egl", "EGL"), ("osmesa", "OSMesa")):
        if ctypes.util.find_library(library):
            return name
    if has_screen:
        return "glfw"
    raise OSError("neither EGL nor OSMesa nor a display")

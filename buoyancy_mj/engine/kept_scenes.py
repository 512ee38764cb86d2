"""`keep_scenes`: a window of Studio lives on where its model changes.

MuJoCo 4.0.0 ends the process when the model changes in a window of Studio that has drawn another:
it destroys what it draws the old one from, and draws again. A window begins with an empty model. So
`python -m mujoco.studio.viewer --model=FILE` ends where a file takes longer to read than the window
to open, be there water in it or not, and the first water of a process takes that long.
"""

import functools
import sys
from typing import Any

import mujoco

MENDED = "4.0.0"
"""The MuJoCo whose Studio is known to need it."""
_LAUNCHER = "mujoco.studio.launch_native"
_SCENE = "scn"
"""Studio's name for the scene of its model."""


def keep_scenes() -> None:
    """Let windows of Studio keep what they drew earlier models from, if there are windows."""
    if _LAUNCHER in sys.modules:
        mend_windows()


@functools.cache
def mend_windows() -> None:
    """Keep a scene when its model changes, and give the next model a scene of its own."""
    if mujoco.__version__ != MENDED:
        return
    try:
        from mujoco.studio.native_viewer import NativeViewer
    except ImportError:
        # then there is no window either
        return
    sync_renderer, close = NativeViewer._sync_renderer, NativeViewer.close

    def keep_and_sync(window: Any, model: mujoco.MjModel) -> None:
        if id(model) != window._renderer_model_id:
            last = window._model_scene, window._renderer._scenes.pop(_SCENE, None)
            vars(window).setdefault("_kept_scenes", []).append(last)
        sync_renderer(window, model)

    def drop_and_close(window: Any) -> None:
        # in the window's own thread, and before its engine goes
        vars(window).pop("_kept_scenes", None)
        close(window)

    NativeViewer._sync_renderer, NativeViewer.close = keep_and_sync, drop_and_close

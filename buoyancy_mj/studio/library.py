"""MuJoCo's Studio, loaded where it can be, and one sentence where it cannot."""

import abc
import collections.abc
import importlib
import sys

import numpy as np

from buoyancy_mj.errors import DrawingError

MEND = "pip install mujoco-studio, or give --renderer classic"
"""What to do without it."""


def load_studio() -> None:
    """Import what a window and a page need of Studio.

    Raises:
        DrawingError: Studio is not installed.
    """
    try:
        load_renderer()
        for name in ("app", "native_viewer", "web_viewer"):
            importlib.import_module(f"mujoco.studio.{name}")
    except ImportError as error:
        raise DrawingError(f"MuJoCo's Studio cannot be loaded: {error}; {MEND}") from error


def load_renderer() -> None:
    """Import the renderer of Studio's windows, to which Python 3.11 is lent what it wants of 3.12.

    That is `collections.abc.Buffer`, by which it tells arrays from what it has to convert.

    Raises:
        ImportError: Studio is not installed.
    """
    is_lent = sys.version_info < (3, 12) and not hasattr(collections.abc, "Buffer")
    if is_lent:
        vars(collections.abc)["Buffer"] = _Buffer
    try:
        importlib.import_module("mujoco.rendering.filament.renderer")
    finally:
        if is_lent:
            del vars(collections.abc)["Buffer"]


class _Buffer(abc.ABC):  # noqa: B024
    """What holds bytes."""


for _kind in (np.ndarray, bytes, bytearray, memoryview):
    _Buffer.register(_kind)

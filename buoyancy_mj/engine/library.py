"""MuJoCo's library, and its functions by name: for Python to call, and their addresses."""

import ctypes
import functools
from pathlib import Path
from typing import Any

import mujoco

from buoyancy_mj.errors import EngineError

MEND = (
    "the water then acts through Python alone: use buoyancy.installed(native=False), "
    "or another version of MuJoCo"
)
"""What helps where this MuJoCo is not as expected inside."""


@functools.cache
def function(name: str, result: Any, *arguments: Any) -> Any:
    """A function of MuJoCo's library, for Python to call.

    Raises:
        EngineError: it has no such function.
    """
    return ctypes.CFUNCTYPE(result, *arguments)(symbol(name))


def symbol(name: str) -> int:
    """Address of a function of MuJoCo's library.

    Raises:
        EngineError: it has no such function.
    """
    try:
        function = getattr(_library(), name)
    except AttributeError:
        raise EngineError(f"MuJoCo {mujoco.__version__} has no function {name}; {MEND}") from None
    return ctypes.cast(function, ctypes.c_void_p).value or 0


@functools.cache
def _library() -> ctypes.CDLL:
    """MuJoCo's library, the one that its Python package has loaded."""
    folder = Path(mujoco.__file__).parent
    found = [
        path
        for pattern in ("libmujoco*.so*", "libmujoco*.dylib", "mujoco.dll")
        for path in folder.glob(pattern)
    ]
    if not found:
        raise EngineError(f"there is no MuJoCo library in '{folder}'; {MEND}")
    return ctypes.CDLL(str(found[0]))

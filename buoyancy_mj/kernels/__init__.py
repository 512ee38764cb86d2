"""Arrays in, numbers out, compiled by Numba: no engine, no dataclass and no file is known here.

Numba keeps compiled kernels beside their source and compiles anew when that one file changes, but
not when a kernel of another file changes that it has built in. So what is older than any source
goes.
"""

import contextlib
import sys
from pathlib import Path
from typing import Any

from numba.core import event

_FOLDER = Path(__file__).parent


def _drop_stale(folder: Path) -> None:
    """Remove compiled kernels that are older than the newest source in `folder`."""
    newest = max(source.stat().st_mtime for source in folder.rglob("*.py"))
    for compiled in folder.rglob("*.nb[ci]"):
        # another process may be doing the same, or the folder be read-only
        with contextlib.suppress(OSError):
            if compiled.stat().st_mtime < newest:
                compiled.unlink()


class _Patience(event.Listener):  # type: ignore[misc]
    """Says once that compiling takes a while, when a kernel is compiled anew."""

    def __init__(self) -> None:
        self._told = False

    def on_start(self, event: Any) -> None:
        """A function begins to be compiled."""
        if not self._told and event.data["dispatcher"].py_func.__module__.startswith(__name__):
            self._told = True
            sys.stderr.write(
                "buoyancy_mj: compiling, once per installation; this takes about half a minute\n"
            )
            sys.stderr.flush()

    def on_end(self, event: Any) -> None:
        """It is done."""


_drop_stale(_FOLDER)
event.register("numba:compile", _Patience())

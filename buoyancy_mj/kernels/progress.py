"""Tells whoever waits that kernels are being compiled, which happens once per installation."""

import sys
from typing import TYPE_CHECKING, Any

from numba.core import event
from numba.core.dispatcher import Dispatcher

if TYPE_CHECKING:
    from rich.progress import Progress

_PACKAGE = __name__.rpartition(".")[0]
_TEXT = "buoyancy_mj: compiling what is used for the first time, once per installation"


class CompilationProgress(event.Listener):  # type: ignore[misc]
    """A line on the standard error when a kernel is compiled anew, and a bar on a terminal."""

    def __init__(self) -> None:
        self._depth = 0
        self._bar: Progress | None = None

    def on_start(self, event: Any) -> None:
        """A function begins to be compiled."""
        if not _is_ours(event.data["dispatcher"]):
            return
        if self._bar is None:
            self._bar = _make_bar()
            self._bar.console.print(_TEXT, soft_wrap=True)
        if self._depth == 0:
            self._bar.start()
        self._depth += 1

    def on_end(self, event: Any) -> None:
        """It is done."""
        if self._bar is None or not _is_ours(event.data["dispatcher"]):
            return
        self._depth -= 1
        self._bar.advance(self._bar.task_ids[0])
        self._bar.refresh()
        if self._depth == 0:
            self._bar.stop()


def _make_bar() -> "Progress":
    """A bar that goes when all is compiled, and that only a terminal shows."""
    # only whoever compiles waits for this import
    from rich.console import Console
    from rich.progress import Progress

    # without a thread of its own
    console = Console(stderr=True, highlight=False)
    bar = Progress(
        console=console, auto_refresh=False, transient=True, disable=not console.is_terminal
    )
    bar.add_task("compiling", total=_count_kernels())
    return bar


def _is_ours(dispatcher: Any) -> bool:
    """Whether a function that Numba compiles is a kernel of this package."""
    return bool(dispatcher.py_func.__module__.startswith(_PACKAGE))


def _count_kernels() -> int:
    """How many kernels there are, but for those that are built into others."""
    kernels = {
        value
        for name, module in list(sys.modules.items())
        if name.startswith(_PACKAGE)
        for value in vars(module).values()
        if isinstance(value, Dispatcher) and value.targetoptions.get("inline") != "always"
    }
    return len(kernels)

"""What ends a command from outside: Ctrl-C, SIGTERM, and a terminal that is closed."""

import _thread
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

STOPPING = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals that end a command."""

_received: list[int] = []
"""Numbers of the signals that came since the command began."""


class Stop(KeyboardInterrupt):
    """A signal that ends a command, as Ctrl-C does."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number
        """Number of the signal."""
        self.status = 128 + number
        """Exit status that shells have for it."""


@contextmanager
def raise_signals() -> Iterator[None]:
    """Signals that end a command raise `Stop` in the block, but for those that are ignored.

    Some code lets nothing through, as `__del__` and modules that catch everything. So the block
    calls `raise_received` now and then, and ends with it.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _received.clear()
    before = {number: signal.getsignal(number) for number in STOPPING}
    for number, handler in before.items():
        # what runs in the background, or under nohup, is to live on
        if handler is not signal.SIG_IGN:
            signal.signal(number, _stop)
    hook, sys.unraisablehook = sys.unraisablehook, _ignore_stop
    try:
        yield
        raise_received()
    except KeyboardInterrupt:
        # the engine may not know which signal it was
        raise_received()
        raise
    finally:
        sys.unraisablehook = hook
        for number, handler in before.items():
            signal.signal(number, handler)


def _ignore_stop(raised: Any) -> None:
    """Say nothing of a signal that did not get through, for it is raised later."""
    if not isinstance(raised.exc_value, Stop):
        sys.__unraisablehook__(raised)


def raise_received() -> None:
    """Raise the signal that came and did not get through, if there is one."""
    if _received:
        raise Stop(_received[0])


def wait_for_interrupt() -> None:
    """Wait for Ctrl-C, which ends no more than this; other signals are raised."""
    try:
        while True:
            raise_received()
            time.sleep(0.2)
    except Stop as stop:
        if stop.number != signal.SIGINT:
            raise
        _received.clear()


def _stop(number: int, _: Any) -> NoReturn:
    """Take a signal."""
    _received.append(number)
    raise Stop(number)


def raise_later(stop: Stop) -> None:
    """Raise a signal anew in a moment, for a function that must not raise it."""
    threading.Timer(0.01, _thread.interrupt_main, [stop.number]).start()

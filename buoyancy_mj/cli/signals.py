"""What ends a command from outside: Ctrl-C, SIGTERM, and a terminal that is closed."""

import _thread
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

STOPPING = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals that end a command."""


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

    One that came where Python cannot raise, as in `__del__`, is raised when the block has ended.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    received: list[int] = []

    def stop(number: int, _: Any) -> NoReturn:
        received.append(number)
        raise Stop(number)

    before = {number: signal.getsignal(number) for number in STOPPING}
    for number, handler in before.items():
        # what runs in the background, or under nohup, is to live on
        if handler is not signal.SIG_IGN:
            signal.signal(number, stop)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    if received:
        raise Stop(received[0])


def raise_later(stop: Stop) -> None:
    """Raise a signal anew in a moment, for a function that must not raise it."""
    threading.Timer(0.01, _thread.interrupt_main, [stop.number]).start()

"""`ViewerProcess`: Rerun's own program, started quietly, and seen to live before it is used."""

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence

from buoyancy_mj.errors import RecordingError

HOST = "127.0.0.1"
"""This machine alone."""
PATIENCE = 10.0
"""Longest time that a program takes to listen [s]."""
PROBATION = 0.7
"""Time for which it has to live after that [s]; a window that cannot be opened ends it."""


class ViewerProcess:
    """A program that listens on ports of this machine.

    Args:
        arguments: what follows the program's name.
        ports: where it listens.
        instead: what to do where it does not start.

    Raises:
        RecordingError: it does not start; the message has its reason.
    """

    def __init__(self, arguments: Sequence[str], ports: Sequence[int], instead: str) -> None:
        with tempfile.TemporaryFile() as said:
            # a group of its own: Ctrl-C ends the run, and the viewer lives on
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "rerun_cli", *arguments],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said,
                start_new_session=True,
            )  # fmt: skip
            if not self._starts(ports):
                self.stop()
                said.seek(0)
                reason = _find_reason(said.read().decode(errors="replace"))
                raise RecordingError(f"no Rerun viewer could be started: {reason}; {instead}")

    def stop(self) -> None:
        """End the program."""
        # with what the program has started itself
        if hasattr(os, "killpg"):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGTERM)
        else:
            self._process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout=5.0)

    def _starts(self, ports: Sequence[int]) -> bool:
        """Whether the program listens before long, and lives on."""
        end = time.monotonic() + PATIENCE
        while not all(map(listens, ports)):
            if self._process.poll() is not None or time.monotonic() > end:
                return False
            time.sleep(0.02)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(timeout=PROBATION)
        return self._process.poll() is None


def listens(port: int, host: str = HOST) -> bool:
    """Whether something listens on a port."""
    try:
        with socket.create_connection((host, port), timeout=1.0):
            return True
    except OSError:
        return False


def _find_reason(said: str) -> str:
    """The line of a program's last words that says what was wrong."""
    lines = [line.strip() for line in said.splitlines()]
    reasons = [line for line in lines if line.lower().startswith("error")]
    return reasons[-1].partition(":")[2].strip() if reasons else "it did not answer in time"

"""`Link`: the socket on which an autopilot is heard and answered."""

import errno
import ipaddress
import socket
import time
from typing import Any

from buoyancy_mj.autopilot.packets import LARGEST, Servos, parse_servos
from buoyancy_mj.errors import AutopilotError

LOOPBACK = "127.0.0.1"
"""Address that only this machine reaches."""
ANYWHERE = "0.0.0.0"
"""Address by which all networks of this machine reach it."""
PORT = 9002
"""Port to which ArduPilot sends."""


class Link:
    """Listens for the packets of an autopilot over UDP, and answers whoever sent the last.

    Whoever can reach the address can drive the vehicle, so it is one of this machine alone unless
    that is allowed.

    Args:
        host: address or name on which to listen.
        port: port; 0 for any that is free.
        expose: whether others than this machine may reach it.

    Raises:
        AutopilotError: the address cannot be had, or others could reach it.
    """

    def __init__(self, host: str = LOOPBACK, port: int = PORT, *, expose: bool = False) -> None:
        self.malformed = 0
        """Packets that were none of an autopilot."""
        self.skipped = 0
        """Packets behind which a newer one stood already."""
        self._peer: Any = None
        self._buffer = bytearray(LARGEST + 1)
        self._view = memoryview(self._buffer)
        address = _resolve(host)
        if not (expose or ipaddress.ip_address(address).is_loopback):
            raise AutopilotError(
                f"others than this machine could reach '{host}' and drive the vehicle; listen on "
                f"{LOOPBACK}, or allow it (--expose)"
            )
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((address, port))
        except (OSError, OverflowError) as error:
            self._socket.close()
            raise AutopilotError(_explain(host, port, error)) from error
        self.host, self.port = self._socket.getsockname()
        """Where it listens."""

    def __enter__(self) -> "Link":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Listen no more."""
        self._socket.close()

    def count_anew(self) -> None:
        """Begin the counts anew, for the next start of an autopilot."""
        self.malformed = self.skipped = 0

    def receive(self, patience: float | None = None) -> Servos | None:
        """Wait for the next packet of an autopilot; of several that wait, the newest.

        An autopilot that gets no answer sends its packet again, once a second. Were each answered,
        the answers would stay behind the packets for ever.

        Args:
            patience: how long to wait [s]; None for ever.

        Returns:
            What the packet says; None if none came.
        """
        deadline = None if patience is None else time.monotonic() + patience
        servos = None
        try:
            while servos is None:
                left = None if deadline is None else max(1e-6, deadline - time.monotonic())
                self._socket.settimeout(left)
                servos = self._take()

            # whatever else has come by now
            self._socket.settimeout(0.0)
            while True:
                newer = self._take()
                self.skipped += newer is not None
                servos = newer or servos
        except (TimeoutError, BlockingIOError):
            return servos

    def answer(self, line: bytes) -> None:
        """Send a line to whoever sent the last packet; one who has gone does not matter."""
        self._socket.settimeout(None)
        try:
            self._socket.sendto(line, self._peer)
        except ConnectionError:
            return

    def _take(self) -> Servos | None:
        """The next packet that comes in the socket's time; None if it is none of an autopilot.

        Raises:
            TimeoutError, BlockingIOError: none came.
        """
        try:
            size, peer = self._socket.recvfrom_into(self._buffer)
        except ConnectionError:
            # an answer found nobody
            return None
        servos = parse_servos(self._view[:size])
        if servos is None:
            self.malformed += 1
        else:
            self._peer = peer
        return servos


def _resolve(host: str) -> str:
    """The address of a host, as four numbers."""
    try:
        return socket.gethostbyname(host)
    except (OSError, UnicodeError) as error:
        raise AutopilotError(
            f"'{host}' is no address of this machine; listen on {LOOPBACK}"
        ) from error


def _explain(host: str, port: int, error: OSError | OverflowError) -> str:
    """Why an address cannot be had."""
    if isinstance(error, OverflowError):
        return f"port is {port}; it must be a whole number from 0 to 65535"
    if error.errno == errno.EADDRINUSE:
        return (
            f"port {port} of {host} is in use; end what listens there, or take another (--port, "
            "and for ArduPilot --sim-port-out)"
        )
    if error.errno == errno.EADDRNOTAVAIL:
        return f"'{host}' is no address of this machine; listen on {LOOPBACK}"
    return f"cannot listen on {host}, port {port}: {error.strerror}; take another (--port)"

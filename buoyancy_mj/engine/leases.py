"""C functions that MuJoCo keeps as callbacks, each lent to one water after another."""

import collections
import ctypes
from typing import Any

from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.kernels.entries import passive
from buoyancy_mj.kernels.entries.closures import Closure
from buoyancy_mj.kernels.entries.tables import Lease
from buoyancy_mj.kernels.entries.views import Table

MOST_FREE = 16
"""C functions that rest before one is used again: a thread may still be about to leave one."""
_ENGINE_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_free: collections.deque["LeasedFunction"] = collections.deque()


class LeasedFunction:
    """A C function void(const mjModel*, mjData*) that any thread may call, at any time.

    It is never freed. While nothing is lent to it, it calls the callback before it and no more.
    """

    def __init__(self) -> None:
        self._lease = Table(Lease(0, 0, 0))
        self._closure = Closure(passive.callback, self._lease.address)
        self.function = _ENGINE_FUNCTION(self._closure.address)
        """As MuJoCo takes it for a callback."""
        self._previous: Any = None
        # alive even when the interpreter has gone, since other threads may run on
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

    def lend(self, water: int, *, copies: bool) -> None:
        """Let it act.

        Args:
            water: address of the word that holds the address of a water's table.
            copies: whether it acts on copies of the water's model too.
        """
        self._lease.set_number("copies", int(copies))
        self._lease.set_number("water", water)

    def follow(self, previous: Any) -> None:
        """Let it call another C function first; None for none."""
        self._lease.set_number("previous", 0 if previous is None else address_of(previous))
        self._previous = previous

    def give_back(self) -> None:
        """Let it act no more."""
        self._lease.set_number("water", 0)
        _free.append(self)


def lease_function() -> LeasedFunction:
    """A C function that is lent to no water now."""
    return _free.popleft() if len(_free) > MOST_FREE else LeasedFunction()

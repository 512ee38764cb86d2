"""The crew of this process: threads that share the hulls and bodies of one pass."""

import ctypes
import functools
import os
from typing import Any

import numpy as np

from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.kernels.entries import crews
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.kernels.entries.crews import CREW, INDEX, JOB, MOST, POST, Crew
from buoyancy_mj.kernels.entries.views import Table


class _Hired:
    """A crew in memory: its table, and the words that the table has the addresses of."""

    def __init__(self) -> None:
        # apart from each other, so that threads do not wait for a neighbour's word
        self._words = np.zeros((3, 16), np.int64)
        self._asleep = np.zeros(MOST, np.int64)
        self._posts = np.zeros((MOST, POST), np.int64)
        turn, done, taken = (row.ctypes.data for row in self._words)
        self.table = Table(
            Crew(
                turn=turn,
                done=done,
                taken=taken,
                asleep=self._asleep.ctypes.data,
                posts=self._posts.ctypes.data,
                hired=np.zeros(1, np.int64),
                job=np.zeros(JOB, np.int64),
                locks=np.zeros(MOST + 1, np.int64),
                work=compile_kernel(crews.work).address,
                start=address_of(ctypes.pythonapi.PyThread_start_new_thread),
                acquire=address_of(ctypes.pythonapi.PyThread_acquire_lock),
                release=address_of(ctypes.pythonapi.PyThread_release_lock),
            )
        )
        """Of the crew."""
        self._posts[:, CREW], self._posts[:, INDEX] = self.table.address, np.arange(MOST)
        self.begin_anew()

    @property
    def count(self) -> int:
        """How many helpers there are."""
        return int(self.table.arrays.hired[0])

    def begin_anew(self) -> None:
        """Have no helpers and no job; a forked child has none of the threads of its parent."""
        for words in (self._words, self._asleep, self.table.arrays.hired):
            words[:] = 0
        allocate, acquire = _lock_functions()
        for i in range(MOST + 1):
            lock = allocate()
            acquire(lock, 1)
            self.table.arrays.locks[i] = lock


@functools.cache
def crew() -> _Hired:
    """The crew, whose threads start when the first pass needs them.

    It is never freed, since its threads sleep on it until the process ends.
    """
    hired = _Hired()
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=hired.begin_anew)
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(hired))
    return hired


@functools.cache
def _lock_functions() -> tuple[Any, Any]:
    """Python's PyThread_allocate_lock and PyThread_acquire_lock."""
    allocate = ctypes.PYFUNCTYPE(ctypes.c_size_t)(("PyThread_allocate_lock", ctypes.pythonapi))
    acquire = ctypes.PYFUNCTYPE(ctypes.c_int, ctypes.c_size_t, ctypes.c_int)(
        ("PyThread_acquire_lock", ctypes.pythonapi)
    )
    return allocate, acquire

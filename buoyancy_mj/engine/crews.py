"""The crew of this process: threads that share the hulls and bodies of one pass."""

import ctypes
import functools
import os
from typing import Any

import numpy as np

from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.kernels.entries import crews
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.kernels.entries.crews import CREW, INDEX, JOB, MOST, Crew
from buoyancy_mj.kernels.entries.views import Table


def address() -> int:
    """Of the table of the crew; its threads start when the first pass needs them."""
    return _crew().address


@functools.cache
def _crew() -> Table[Crew]:
    """The crew, which is never freed: its threads sleep on it until the process ends."""
    table = Table(
        Crew(
            turn=np.zeros(1, np.int64),
            done=np.zeros(1, np.int64),
            taken=np.zeros(1, np.int64),
            hired=np.zeros(1, np.int64),
            job=np.zeros(JOB, np.int64),
            asleep=np.zeros(MOST, np.int64),
            locks=np.zeros(MOST + 1, np.int64),
            posts=np.zeros((MOST, 2), np.int64),
            work=compile_kernel(crews.work).address,
            start=address_of(ctypes.pythonapi.PyThread_start_new_thread),
            acquire=address_of(ctypes.pythonapi.PyThread_acquire_lock),
            release=address_of(ctypes.pythonapi.PyThread_release_lock),
        )
    )
    table.arrays.posts[:, CREW] = table.address
    table.arrays.posts[:, INDEX] = np.arange(MOST)
    _begin_anew(table.arrays)
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=functools.partial(_begin_anew, table.arrays))
    ctypes.pythonapi.Py_IncRef(ctypes.py_object(table))
    return table


def _begin_anew(crew: Crew) -> None:
    """Have no helpers and no job; a forked child has none of the threads of its parent."""
    for words in (crew.turn, crew.done, crew.taken, crew.hired, crew.asleep):
        words[:] = 0
    allocate, acquire = _lock_functions()
    for i in range(len(crew.locks)):
        lock = allocate()
        acquire(lock, 1)
        crew.locks[i] = lock


@functools.cache
def _lock_functions() -> tuple[Any, Any]:
    """Python's PyThread_allocate_lock and PyThread_acquire_lock."""
    allocate = ctypes.PYFUNCTYPE(ctypes.c_size_t)(("PyThread_allocate_lock", ctypes.pythonapi))
    acquire = ctypes.PYFUNCTYPE(ctypes.c_int, ctypes.c_size_t, ctypes.c_int)(
        ("PyThread_acquire_lock", ctypes.pythonapi)
    )
    return allocate, acquire

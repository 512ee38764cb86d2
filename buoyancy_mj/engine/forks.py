"""Locks that a fork of the process leaves free, whatever other threads were doing."""

import os
import threading
import weakref

_locks: weakref.WeakKeyDictionary[threading.RLock, None] = weakref.WeakKeyDictionary()
"""All that there are, in the order in which they were made; it is a set that keeps that order."""
_held: list[threading.RLock] = []
"""Those that are held while the process forks."""


def make_lock() -> threading.RLock:
    """A lock that a forked child finds free.

    A child has only the thread that forked. A lock that another thread held would stay held there
    for ever, so a fork waits until nobody holds any. Who holds one lock may wait only for locks
    that were made later.
    """
    lock = threading.RLock()
    _locks[lock] = None
    return lock


def _hold_all() -> None:
    for lock in list(_locks):
        lock.acquire()
        _held.append(lock)


def _release_all() -> None:
    while _held:
        _held.pop().release()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_hold_all, after_in_parent=_release_all, after_in_child=_release_all)

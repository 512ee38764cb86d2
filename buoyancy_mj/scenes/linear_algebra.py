"""Linear algebra on one thread: sums that do not depend on how many cores a machine has."""

import functools
from collections.abc import Iterator
from contextlib import AbstractContextManager
from typing import Any, TypeVar

# SciPy brings a BLAS of its own, and NumPy another
import scipy.linalg  # noqa: F401
from threadpoolctl import ThreadpoolController

T = TypeVar("T")


def on_one_thread(items: Iterator[T]) -> Iterator[T]:
    """Yield items, each of which is computed with one thread of the BLAS libraries.

    A product of matrices that is shared by threads is summed in other parts, and so differs in its
    last bits between machines of few and of many cores.
    """
    while True:
        with _limit():
            try:
                item = next(items)
            except StopIteration:
                return
        yield item


def _limit() -> AbstractContextManager[Any]:
    """One thread for BLAS, in a block."""
    limit: AbstractContextManager[Any] = _find_libraries().limit(limits=1, user_api="blas")
    return limit


@functools.cache
def _find_libraries() -> ThreadpoolController:
    """The libraries of this process that have threads."""
    return ThreadpoolController()

"""Jobs side by side on threads: the engine steps without Python's lock."""

import concurrent.futures
import os
import threading
from collections.abc import Callable, Generator, Iterable
from typing import TypeVar

T = TypeVar("T")
MOST_WAITING = 4
"""How many jobs per thread are made ahead: each holds a model and its data."""

Job = Callable[[threading.Event], T]
"""A job; it ends soon after the event is set."""


def run_side_by_side(jobs: Iterable[Job[T]], threads: int = 0) -> Generator[T]:
    """Run jobs, and yield what each returns, in their order.

    Jobs are made in the calling thread, a few ahead. Closing the generator before its end, as
    `contextlib.closing` does whatever happens, ends the jobs that run.

    Args:
        jobs: what to run.
        threads: how many at once; 0 for one per core.
    """
    workers = threads or os.cpu_count() or 1
    stop = threading.Event()
    waiting: list[concurrent.futures.Future[T]] = []
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        try:
            for job in jobs:
                waiting.append(pool.submit(job, stop))
                while len(waiting) > MOST_WAITING * workers or (waiting and waiting[0].done()):
                    yield waiting.pop(0).result()
            while waiting:
                yield waiting.pop(0).result()
        finally:
            stop.set()
            for future in waiting:
                future.cancel()

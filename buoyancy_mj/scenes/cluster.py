"""`Cluster`: runs on the cores of a Ray cluster, in chunks that Ray gives to its machines."""

import contextlib
import importlib
import logging
import math
import os
import signal
import time
import warnings
from collections import deque
from collections.abc import Generator, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning, SweepError
from buoyancy_mj.scenes.bundle import pack
from buoyancy_mj.scenes.variations import UntriedError, Values, Variations
from buoyancy_mj.scenes.worker import Outcome, run_chunk

RETRIES = 3
"""How often Ray runs a chunk again whose process or machine was lost."""
MOST_RUNS = 1000
"""Most runs in a chunk."""
CHUNK_TIME = 10.0
"""How long a chunk may take [s]: what a lost machine costs, and how old rows are that come."""
GIVING_TIME = 5e-4
"""Time that this process needs for a chunk [s], `scripts/bench.py --only cluster` measures it; in
shorter chunks than this for each core the cores would wait for it."""
SHARE = 4
"""Chunks that each core has still to come, so that all end together."""
QUEUED = 2
"""Chunks that are with Ray for each core: one that runs, and one that is ready."""
POLL = 0.1
"""How long to wait for rows before Ctrl-C is asked for [s]."""
RECOUNT = 1.0
"""Time after which the cores of the cluster are counted again [s]: clusters grow."""


def import_ray() -> Any:
    """The library `ray`.

    Raises:
        SweepError: it is not installed.
    """
    try:
        return importlib.import_module("ray")
    except ImportError as error:
        raise SweepError(
            "runs on Ray need ray, which is not installed: pip install 'buoyancy_mj[ray]'"
        ) from error


def chunk_size(remaining: int, cores: int, run_time: float) -> int:
    """Number of runs in the next chunk, by guided self-scheduling.

    Chunks become smaller towards the end, so that no core works long after the others:
    Polychronopoulos and Kuck, "Guided self-scheduling", IEEE Transactions on Computers C-36 (1987).

    Args:
        remaining: number of runs that nobody has yet.
        cores: number of cores.
        run_time: mean time of a run [s]; inf while it is not known.
    """
    if not math.isfinite(run_time):
        return 1
    most = min(float(MOST_RUNS), CHUNK_TIME / max(run_time, 1e-9))
    least = min(most, cores * GIVING_TIME / max(run_time, 1e-9))
    return max(1, math.ceil(least), int(min(most, remaining / (SHARE * cores))))


class Cluster:
    """A cluster of Ray, for the time of a block; see `places.Work`.

    A cluster that this process belongs to is used as it is. Without an address, Ray joins the one
    that RAY_ADDRESS names or that was started on this machine, or else starts one on all cores,
    which ends with the block.

    Args:
        ray: the library.
        address: 'ray://HOST:PORT', or None.

    Raises:
        SweepError: the cluster cannot be reached.
    """

    def __init__(self, ray: Any, address: str | None = None) -> None:
        self.ray = ray
        """The library."""
        self._address = address
        self._stack = contextlib.ExitStack()
        self._bundles: dict[Variations, Any] = {}
        self._cores, self._counted = 1, -math.inf

    def __enter__(self) -> "Cluster":
        if not self.ray.is_initialized():
            self._connect()
            self._stack.callback(self.ray.shutdown)
        options = {"num_cpus": 1, "max_retries": RETRIES}
        self._run_chunk = self.ray.remote(run_chunk).options(**options)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._stack.close()

    def __call__(
        self, variations: Variations, values: Mapping[int, Values]
    ) -> Generator[list[dict[str, Any]]]:
        """Run runs, chunk by chunk.

        A run whose process is lost again and again does not keep the others from being run.

        Args:
            variations: their scene; its files are put into the store of objects once.
            values: the values of each run, by its number.

        Yields:
            Rows, as they come.

        Raises:
            UntriedError: a file that a run needs cannot be read, a machine cannot run the scene, or
                the process of a run was lost each time.
            MemoryError: the memory of a machine runs out.
        """
        course = _Course(self, variations, values)
        try:
            while course.queue or course.pending:
                course.submit()
                rows = course.collect()
                if rows:
                    yield rows
        finally:
            for reference in course.pending:
                with contextlib.suppress(Exception):
                    self.ray.cancel(reference, force=True)
        course.check_lost()

    def _connect(self) -> None:
        """Join a cluster, or start one."""
        errors = self.ray.exceptions
        handlers = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGINT)}
        options: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
        try:
            # workers look for modules where a command line does not, in the working folder
            is_safe = bool(os.environ.get("PYTHONSAFEPATH")) and self._address is None
            folder = Path.cwd().anchor if is_safe else Path.cwd()
            with contextlib.chdir(folder):
                self.ray.init(self._address, **options)
        except (OSError, RuntimeError, ValueError, ImportError, errors.RayError) as error:
            alone = self._address is None
            where = "Ray cannot be started" if alone else f"there is no Ray at {self._address}"
            raise SweepError(f"{where}: {_one_line(error)}") from error
        finally:
            # Ray takes SIGTERM for itself
            for number, handler in handlers.items():
                with contextlib.suppress(ValueError):
                    signal.signal(number, handler)

    def count_cores(self) -> int:
        """Number of cores of the cluster, at least 1."""
        now = time.monotonic()
        if now - self._counted > RECOUNT:
            self._counted = now
            self._cores = max(1, int(self.ray.cluster_resources().get("CPU", 0)))
        return self._cores

    def submit(self, variations: Variations, chunk: Mapping[int, Values]) -> Any:
        """Give a chunk to Ray; a reference to what will come of it."""
        if variations not in self._bundles:
            self._bundles[variations] = self.ray.put(pack(variations))
        return self._run_chunk.remote([self._bundles[variations]], chunk)

    def take(self, reference: Any) -> Outcome | str:
        """What came of a chunk, or why its process was lost."""
        errors = self.ray.exceptions
        try:
            outcome: Outcome = self.ray.get(reference)
        except errors.RayTaskError as error:
            cause = error.cause
            if isinstance(cause, (UntriedError, BuoyancyError)):
                raise UntriedError(str(cause)) from error
            if isinstance(cause, MemoryError):
                raise MemoryError(str(cause)) from error
            raise
        except (errors.WorkerCrashedError, errors.NodeDiedError, errors.OutOfMemoryError) as error:
            return _one_line(error)
        except errors.RayError as error:
            raise UntriedError(f"Ray gave up: {_one_line(error)}") from error
        return outcome


class _Course:
    """The runs of one call on their way: those that wait, and the chunks that are with Ray."""

    def __init__(
        self, cluster: Cluster, variations: Variations, values: Mapping[int, Values]
    ) -> None:
        self._cluster, self._variations = cluster, variations
        self.queue = deque(values.items())
        """Runs that nobody has yet."""
        self.pending: dict[Any, dict[int, Values]] = {}
        """Chunks that are with Ray, by the reference to what will come of them."""
        self._lost: dict[int, str] = {}
        self._runs, self._seconds = 0, 0.0

    def submit(self) -> None:
        """Give Ray enough chunks for each core."""
        cores = self._cluster.count_cores()
        run_time = self._seconds / self._runs if self._runs else math.inf
        # one run for each core shows how long they take
        most = QUEUED * cores if self._runs else cores
        while self.queue and len(self.pending) < most:
            size = chunk_size(len(self.queue), cores, run_time)
            numbers = range(min(size, len(self.queue)))
            self._submit(dict(self.queue.popleft() for _ in numbers))

    def collect(self) -> list[dict[str, Any]]:
        """Take the rows that come within `POLL`."""
        rows: list[dict[str, Any]] = []
        ready, _ = self._cluster.ray.wait(
            list(self.pending), num_returns=len(self.pending), timeout=POLL, fetch_local=False
        )
        for reference in ready:
            chunk = self.pending.pop(reference)
            outcome = self._cluster.take(reference)
            if isinstance(outcome, Outcome):
                rows += outcome.rows
                self._runs += len(chunk)
                self._seconds += outcome.seconds
                for note in outcome.notes:
                    warnings.warn(note, BuoyancyWarning, stacklevel=2)
            elif len(chunk) == 1:
                self._lost |= dict.fromkeys(chunk, outcome)
            else:
                # which of them it was is seen when each is alone
                for run, own in chunk.items():
                    self._submit({run: own})
        return rows

    def check_lost(self) -> None:
        """Tell of runs whose process was lost each time."""
        if self._lost:
            run, reason = min(self._lost.items())
            others = f" (and of {len(self._lost) - 1} more)" if len(self._lost) > 1 else ""
            raise UntriedError(
                f"the process of run {run}{others} was lost {RETRIES + 1} times: {reason}"
            )

    def _submit(self, chunk: dict[int, Values]) -> None:
        self.pending[self._cluster.submit(self._variations, chunk)] = chunk


def _one_line(error: Exception) -> str:
    """The first sentence of an error, which may have pages."""
    lines = [line.strip() for line in str(error).splitlines() if line.strip()]
    return lines[0].rstrip(".") if lines else type(error).__name__

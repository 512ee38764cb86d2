"""What a process of a cluster does: it opens a bundle once, and runs chunks of its runs."""

import contextlib
import functools
import importlib
import os
import tempfile
import time
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning
from buoyancy_mj.scenes.bundle import Bundle, describe_software, unpack
from buoyancy_mj.scenes.simulation import Simulation
from buoyancy_mj.scenes.variations import Values, Variations


class Outcome(NamedTuple):
    """What came of a chunk of runs."""

    rows: Sequence[dict[str, Any]]
    """A row for each run."""
    notes: Sequence[str]
    """Warnings for the user."""
    seconds: float
    """Time that it took [s], without what a process does once."""


def run_chunk(holder: Sequence[Any], values: Mapping[int, Values]) -> Outcome:
    """Run some runs on one thread.

    Args:
        holder: the reference to the bundle in the store of objects, in a list, so that Ray does not
            read the bundle anew for each chunk.
        values: the values of each run, by its number.

    Raises:
        SweepError: this machine has other software than the one from which the sweep was started.
        UntriedError: a file that a run needs cannot be read.
        MemoryError: the memory runs out.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        variations = _open(holder[0])
        _compile_in_turn(variations, next(iter(values.values())))
        caught.clear()
        started = time.perf_counter()
        # one after the other: nothing is gained by a batch on one thread
        rows = [row for run, own in values.items() for row in variations.run({run: own}, 1)]
        seconds = time.perf_counter() - started
    notes = [str(one.message) for one in caught if issubclass(one.category, BuoyancyWarning)]
    return Outcome(rows, notes, seconds)


@functools.lru_cache(maxsize=4)
def _open(reference: Any) -> Variations:
    """The scene of a bundle in the store of objects, opened once."""
    bundle: Bundle = importlib.import_module("ray").get(reference)
    return unpack(bundle)


_compiled: set[str] = set()
"""Digests of the scenes whose kernels this process knows to be compiled."""


def _compile_in_turn(variations: Variations, values: Values) -> None:
    """Let one process of this machine compile what a scene needs, while the others wait.

    A fresh installation compiles for a minute or two, and on a machine of 64 cores 64 processes
    would do so at once. A file among the temporary ones remembers the scenes that were built here,
    and with which software.
    """
    if variations.digest in _compiled:
        return
    _compiled.add(variations.digest)
    try:
        import fcntl

        user = os.getuid()
        path = Path(tempfile.gettempdir(), f"buoyancy_mj-{user}-compiled")
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW, 0o600)
    except (ImportError, OSError):
        # each compiles for itself
        return
    with os.fdopen(descriptor, "r+", encoding="utf-8") as file:
        with contextlib.suppress(OSError):
            fcntl.flock(file, fcntl.LOCK_EX)
        line = f"{variations.digest}, {describe_software()}"
        if line in file.read().splitlines():
            return
        with contextlib.suppress(BuoyancyError):
            Simulation(variations.read_scene(values), trust=variations.trust)
        file.write(f"{line}\n")

"""Where runs are run: on the cores of this machine, or on a cluster."""

import re
from collections.abc import Callable, Generator, Mapping
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from buoyancy_mj.errors import SweepError, describe
from buoyancy_mj.scenes.variations import Values, Variations

LOCAL = "local"
"""The cores of this machine."""
RAY = "ray"
"""The cluster of Ray at hand; 'ray://HOST:PORT' is another."""
BATCH_SIZE = 64
"""Most runs in a batch: a sweep that is killed loses no more."""
_ADDRESS = re.compile(r"ray://[^\s/:]+:\d+")

Row = dict[str, Any]
"""A row of results, by column."""
Work = Callable[[Variations, Mapping[int, Values]], Generator[list[Row]]]
"""Runs the runs of some numbers and values; yields rows as they end, some at a time."""
Place = Callable[[], AbstractContextManager[Work]]
"""Opens the place of the work; it is closed at the end of the block."""


def find_place(on: str, threads: int = 0) -> Place:
    """Where runs are to be run.

    Args:
        on: 'local', 'ray' or 'ray://HOST:PORT'.
        threads: number of threads that step at once on this machine; 0 for one per core.

    Raises:
        SweepError: there is no such place, it does not use threads, or Ray is not installed.
    """
    if on == LOCAL:
        return lambda: nullcontext(_make_local(threads))
    if not isinstance(on, str) or not (on == RAY or _ADDRESS.fullmatch(on)):
        raise SweepError(
            f"--on is {describe(on)}; it must be {LOCAL}, {RAY}, or {RAY}://HOST:PORT, as "
            f"{RAY}://10.0.0.1:10001"
        )
    if threads:
        raise SweepError(
            f"--threads is {threads} beside --on {on}, where each run has one core to itself; "
            "leave --threads out"
        )

    # Ray takes a second to import
    from buoyancy_mj.scenes.cluster import Cluster, import_ray

    ray = import_ray()
    return lambda: Cluster(ray, None if on == RAY else on)


def _make_local(threads: int) -> Work:
    """What runs on this machine, batch by batch."""

    def work(variations: Variations, values: Mapping[int, Values]) -> Generator[list[Row]]:
        runs = list(values)
        for start in range(0, len(runs), BATCH_SIZE):
            batch = {run: values[run] for run in runs[start : start + BATCH_SIZE]}
            yield from ([row] for row in variations.run(batch, threads))

    return work

"""A sweep on a cluster: what is moved, what a start and a chunk cost, and what comes of it."""

import contextlib
import heapq
import importlib.util
import math
import os
import pickle
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.table import Table

from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.bundle import pack, unpack
from buoyancy_mj.scenes.cluster import Cluster, chunk_size, import_ray
from buoyancy_mj.scenes.journal import Journal
from buoyancy_mj.scenes.variations import Values, Variations, vary

SCENE, SETTINGS, KEY = "auv_waves", ("duration=2",), "mass"
"""What is swept."""
BANDWIDTH = 1.25e8
"""What the machine that starts a sweep sends to all others together [byte/s], 1 Gbit/s."""
CORES_OF_A_MACHINE = 64
"""Of a machine of the computed cluster."""
RUNS_OF_A_CORE = 50
"""Runs of a sweep for each core of the computed cluster."""
SPREAD = 0.3
"""Standard deviation of the logarithm of the time of a run, in the computed cluster."""


def measure(quick: bool) -> dict[str, float]:
    """Measure a sweep here and on Ray on one core and two [s, byte]; nothing without Ray."""
    if importlib.util.find_spec("ray") is None:
        return {}
    count = 8 if quick else 48
    values = {run: (20.0 + 6.0 * run / count,) for run in range(count)}
    path = catalog.scene_path(SCENE)
    variations = vary(path, SETTINGS, (KEY,), list(values.values()), trust=False)

    # processor time of a run, without a cluster
    list(variations.run({0: values[0]}, threads=1))
    started = time.process_time()
    rows = list(variations.run(values, threads=1))
    results = {"runs": float(count), "run": (time.process_time() - started) / count}

    # what is moved
    bundle = pack(variations)
    results["bundle bytes"] = float(len(pickle.dumps(bundle)))
    results["bytes of a run"] = len(pickle.dumps(values)) / count
    results["bytes of a row"] = len(pickle.dumps(rows)) / count
    started = time.process_time()
    unpack(bundle)
    results["unpack"] = time.process_time() - started
    results["journal of a row"] = _measure_journal(variations, rows)
    results |= _measure_ray(variations, values)
    return results


def _measure_journal(variations: Variations, rows: list[dict]) -> float:
    """Processor time that a row takes in the journal [s], where many come at once."""
    with tempfile.TemporaryDirectory() as folder:
        journal = Journal(Path(folder, "rows.csv"), variations.header, variations.digest)
        many = [row | {"run": run} for run in range(1000) for row in rows[:1]]
        started = time.process_time()
        journal.add(*many)
        spent = time.process_time() - started
        journal.close()
    return spent / len(many)


def _measure_ray(variations: Variations, values: dict[int, Values]) -> dict[str, float]:
    """Times of a sweep on Ray on one core and on two [s], and of what Ray does for each chunk.

    Where others are at work on the machine, the processor time tells more than the clock.
    """
    ray = import_ray()
    results: dict[str, float] = {}
    for cores in (1, 2):
        started = time.perf_counter()
        ray.init(num_cpus=cores, include_dashboard=False, log_to_driver=False, logging_level=40)
        try:
            with Cluster(ray) as cluster:
                results[f"start of Ray, {cores}"] = time.perf_counter() - started
                # each process imports the package and opens the bundle once
                used = _used_by_family()
                list(cluster(variations, dict(list(values.items())[: 4 * cores])))
                results[f"first rows, {cores}"] = (_used_by_family() - used) / cores
                started, used = time.perf_counter(), _used_by_family()
                list(cluster(variations, values))
                results[f"sweep, {cores}"] = time.perf_counter() - started
                results[f"processors, {cores}"] = _used_by_family() - used
            results[f"chunk, {cores}"] = _measure_chunk(ray)
        finally:
            ray.shutdown()
    return results


def _measure_chunk(ray: object) -> float:
    """Processor time of this process for each chunk that does nothing [s]."""
    nothing = ray.remote(_do_nothing)  # type: ignore[attr-defined]
    ray.get([nothing.remote([], {}) for _ in range(10)])  # type: ignore[attr-defined]
    started, count = time.process_time(), 500
    pending = [nothing.remote([], {run: (1.0,)}) for run in range(count)]
    while pending:
        ready, pending = ray.wait(pending, num_returns=len(pending), timeout=0.1)  # type: ignore[attr-defined]
        ray.get(ready)  # type: ignore[attr-defined]
    return (time.process_time() - started) / count


def _do_nothing(_holder: list, values: dict) -> int:
    """A chunk that does nothing."""
    return len(values)


def _used_by_family() -> float:
    """Processor time that this process and all that come from it have used [s]."""
    parents, used = dict[int, int](), dict[int, float]()
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            # the name of a process, in brackets, may hold anything
            words = entry.read_text().rpartition(")")[2].split()
            number = int(entry.parent.name)
            parents[number] = int(words[1])
            used[number] = (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")
    family = {os.getpid()}
    while new := {one for one, parent in parents.items() if parent in family} - family:
        family |= new
    return sum(used[one] for one in family if one in used)


def simulate(runs: int, cores: int, run_time: float, chunk: float, row: float) -> float:
    """Time of a sweep [s] on a cluster whose processes have started, by its schedule.

    Args:
        runs: number of runs.
        cores: number of cores.
        run_time: mean time of a run [s]; times are lognormal, see `SPREAD`.
        chunk: time of the process that gives out chunks, for each [s].
        row: its time for each row [s].
    """
    times = np.random.default_rng(1).lognormal(
        math.log(run_time) - SPREAD**2 / 2, SPREAD, size=runs
    )
    ends = np.concatenate([[0.0], np.cumsum(times)])
    free = [0.0] * cores
    done, giver, last = 0, 0.0, 0.0
    while done < runs:
        start = heapq.heappop(free)
        known = run_time if done >= cores else math.inf
        size = min(chunk_size(runs - done, cores, known), runs - done)
        # one process gives out all chunks and takes all rows
        giver = max(giver, start) + chunk + row * size
        # a second chunk is ready before a core is free
        begun = start if done > cores and giver - start < run_time else giver
        end = begun + float(ends[done + size] - ends[done])
        heapq.heappush(free, end)
        done, last = done + size, max(last, end)
    return max(last, giver)


def describe(results: dict[str, float]) -> Iterator[Table | str]:
    """Describe what was measured, and what it comes to on 10,000 cores."""
    if not results:
        yield "cluster: Ray is not installed: pip install '.[ray]'"
        return
    yield (
        f"a run of {SCENE}, {SETTINGS[0]}: {1e3 * results['run']:.0f} ms of one core; to a process "
        f"go {results['bundle bytes'] / 1e3:.1f} kB once and {results['bytes of a run']:.0f} bytes "
        f"a run, back come {results['bytes of a row']:.0f} bytes a row"
    )
    for cores in (1, 2):
        sweep, used = results[f"sweep, {cores}"], results[f"processors, {cores}"]
        yield (
            f"Ray on {cores} core(s): started in {results[f'start of Ray, {cores}']:.1f} s; each "
            f"process then begins in {results[f'first rows, {cores}']:.1f} s of processor time; "
            f"{results['runs']:.0f} runs in {sweep:.1f} s, with {used / sweep:.2f} processors at "
            f"work, {1e3 * used / results['runs']:.0f} ms of processor time a run"
        )
    chunk, row = min(results["chunk, 1"], results["chunk, 2"]), results["journal of a row"]
    yield (
        f"two cores over one: {results['sweep, 1'] / results['sweep, 2']:.2f} x; the process that "
        f"starts the sweep spends {1e6 * chunk:.0f} us on a chunk and {1e6 * row:.0f} us on a row"
    )
    yield _compute(results, chunk, row)


def _compute(results: dict[str, float], chunk: float, row: float) -> Table:
    """A table of what a million runs take on more and more cores."""
    start = results["first rows, 1"]
    table = Table("cores", "run", "runs", "start", "bundle", "sweep", "of the ideal", "rows/s")
    for run_time in (results["run"], 1.0, 10.0):
        for cores in (100, 1000, 10_000):
            runs = RUNS_OF_A_CORE * cores
            sweep = simulate(runs, cores, run_time, chunk, row)
            machines = math.ceil(cores / CORES_OF_A_MACHINE)
            table.add_row(
                f"{cores}",
                f"{run_time:.2f} s",
                f"{runs}",
                f"{start:.1f} s",
                f"{machines * results['bundle bytes'] / BANDWIDTH:.2f} s",
                f"{sweep:.0f} s",
                f"{runs * run_time / cores / sweep:.0%}",
                f"{runs / sweep:.0f}",
            )
    return table

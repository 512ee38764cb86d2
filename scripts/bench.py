"""Measure how fast it is, as ratios side by side in one run.

    .venv/bin/python scripts/bench.py [--quick] [--only NAME ...] [--plot F.png] [--save F.json]
        [--compare F.json] [--publish NAME] [--pages] [--narrow]

All values are means over poses or states, of each the least of several measurements, in processor
time but for batches, runs and first steps:

- submersion: the public call against trimesh's capped slice, scipy's convex hull of the wet
  vertices, manifold3d's trim and, where it is installed (pip install '.[bench]'), Capytaine's
  immersed_part, on the same meshes and poses;
- tree: the tree of moments against visiting all triangles;
- caches: a submersion with its mesh in the processor's caches, and in none;
- step: a step of a scene with water against the same step without;
- sea: the water's part of a step on still water, in one wave, in 64 and in 260, of the AUV and of a
  catamaran of 4 m;
- profile: where a step goes: the engine, the sea, the walk over meshes, pressure, drag, added mass;
- vehicle: a step of a vehicle with its equipment against the same without;
- batch: batches on one thread and on two;
- fleet: 500 vessels in one model and one sea, on one thread and on two;
- real_time: runs of two scenes against real time, headless, recorded, and by the engine alone;
- build: the water of a model whose meshes are new, or were seen before;
- starting: an import, the help, a first step, and compiling for it;
- statics: hydrostatics against Capytaine's, equilibria, righting arms and whole inspections;
- memory: what each data of a model takes with water and without, and what steps take;
- cluster: a sweep on Ray on one core and two, what is moved, and what comes of it on 10,000 cores.

--compare sets a run beside a saved one. What seems more than 5 % slower is measured again, up to
twice, and the best of all counts; what stays slower is flagged, and the exit status is 1. Compare
runs of one machine.

--publish saves a run as docs/bench/NAME.json, draws docs/speed.png, and writes the tables in
README.md and docs/guide/performance.md from all runs in that folder; --pages writes the tables
without measuring. With --only, all else in the file stays as it was.

--narrow compiles kernels as for a processor without AVX-512, into a cache of their own.
"""

import argparse
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import llvmlite.binding as llvm
from benchmarks import (
    building,
    caches,
    cluster,
    comparison,
    fleet,
    memory,
    profile,
    real_time,
    sea,
    starting,
    statics,
    steps,
    submersion,
    tree,
    vehicle,
)
from benchmarks.machine import describe_machine
from benchmarks.pages import ROOT, write_pages
from benchmarks.rows import Row
from benchmarks.runs import FOLDER, Run, read_run, read_runs, save_run
from benchmarks.speed import draw_speed
from rich.console import Console
from rich.table import Table

PICTURE = ROOT / "docs" / "speed.png"
"""The picture that --publish draws."""


def no_rows(_results: Any) -> Iterator[Row]:
    """Rows of a benchmark that the pages do not show."""
    yield from ()


class Benchmark(NamedTuple):
    """Something that is measured."""

    measure: Callable[[bool], Any]
    """Measures it, with fewer sizes and repeats if its argument is True; nested results by name."""
    describe: Callable[[Any], Iterator[Table | str]]
    """Yields tables and lines that describe the results."""
    rows: Callable[[Any], Iterator[Row]] = no_rows
    """Yields what the pages show of them."""


BENCHMARKS = {
    "submersion": Benchmark(submersion.measure, submersion.describe, submersion.rows),
    "tree": Benchmark(tree.measure, tree.describe),
    "caches": Benchmark(caches.measure, caches.describe, caches.rows),
    "step": Benchmark(steps.measure_step, steps.describe_step, steps.step_rows),
    "sea": Benchmark(sea.measure, sea.describe, sea.rows),
    "profile": Benchmark(profile.measure, profile.describe),
    "vehicle": Benchmark(vehicle.measure, vehicle.describe, vehicle.rows),
    "batch": Benchmark(steps.measure_batch, steps.describe_batch, steps.batch_rows),
    "fleet": Benchmark(fleet.measure, fleet.describe, fleet.rows),
    "real_time": Benchmark(real_time.measure, real_time.describe, real_time.rows),
    "build": Benchmark(building.measure, building.describe, building.rows),
    "starting": Benchmark(starting.measure, starting.describe, starting.rows),
    "statics": Benchmark(statics.measure, statics.describe, statics.rows),
    "memory": Benchmark(memory.measure, memory.describe, memory.rows),
    "cluster": Benchmark(cluster.measure, cluster.describe),
}
"""The benchmarks by name, in the order in which they run and the pages show them."""
ROWS = {name: benchmark.rows for name, benchmark in BENCHMARKS.items()}
"""What gives the rows of each."""


def main() -> None:
    """Measure, print, compare, save and publish."""
    options = parse_arguments()
    if options.pages:
        write_pages(read_runs(), ROWS)
        return
    if options.narrow:
        sys.exit(run_narrow())
    console = Console(width=140)
    results: dict[str, Any] = {}
    for name in options.only:
        results[name] = BENCHMARKS[name].measure(options.quick)
        for part in BENCHMARKS[name].describe(results[name]):
            console.print(part)

    # beside an earlier run
    changes: list[comparison.Change] = []
    if options.compare:
        changes = comparison.compare(
            results,
            read_run(options.compare).results,
            lambda name: BENCHMARKS[name].measure(options.quick),
        )
        for line in comparison.describe_changes(changes):
            console.print(line)
    keep(options, Run(describe_machine(), results))
    if comparison.find_slower(changes):
        sys.exit(1)


def run_narrow() -> int:
    """Run this script anew without AVX-512; its exit status."""
    features = llvm.get_host_cpu_features()
    features.update({name: False for name in features if name.startswith("avx512")})
    own = {
        "NUMBA_CPU_FEATURES": features.flatten(),
        "NUMBA_CACHE_DIR": str(ROOT / "build" / "kernels-narrow"),
    }
    rest = [argument for argument in sys.argv if argument != "--narrow"]
    command = [sys.executable, *rest]
    return subprocess.run(command, env=os.environ | own, check=False).returncode


def keep(options: argparse.Namespace, run: Run) -> None:
    """Draw, save and publish a run, as the options say."""
    if options.plot:
        draw_speed(options.plot, run.results)
    if options.save:
        save_run(options.save, run)
    if options.publish:
        path = FOLDER / f"{options.publish}.json"
        save_run(path, run, keep=True)
        draw_speed(PICTURE, read_run(path).results)
        write_pages(read_runs(), ROWS)


def parse_arguments() -> argparse.Namespace:
    """Parse the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes and repeats")
    names = list(BENCHMARKS)
    parser.add_argument(
        "--only", nargs="+", choices=names, default=names, help="measure these alone"
    )
    parser.add_argument("--plot", type=Path, help="draw what was measured into this picture")
    parser.add_argument("--save", type=Path, help="write the run to this JSON file")
    parser.add_argument(
        "--compare", type=Path, help="flag what is slower than in the run of this JSON file"
    )
    parser.add_argument(
        "--publish", metavar="NAME", help="save as docs/bench/NAME.json, and write the pages"
    )
    parser.add_argument("--pages", action="store_true", help="write the pages, measure nothing")
    parser.add_argument("--narrow", action="store_true", help="compile kernels as without AVX-512")
    options = parser.parse_args()
    options.only = [name for name in names if name in options.only]
    return options


if __name__ == "__main__":
    main()

"""Measure how fast it is, as ratios side by side in one run.

    .venv/bin/python scripts/bench.py [--quick] [--only NAME ...] [--plot F.png] [--save F.json]
        [--compare F.json]

All values are medians or means over repeats:

- submersion: the public call against trimesh's capped slice, scipy's convex hull of the wet
  vertices, manifold3d's trim and, where it is installed (pip install '.[bench]'), Capytaine's
  immersed_part, on the same meshes and poses;
- tree: the tree of moments against visiting all triangles;
- step: a step of a scene with water against the same step without;
- vehicle: a step of a vehicle with its equipment against the same without;
- sea: a sea of 64 waves against one wave;
- batch: batches on one thread and on two;
- fleet: 500 vessels in one model and one sea, on one thread and on two;
- real_time: the real-time factor of `auv_waves`, headless and recorded;
- first_step: the time from a fresh interpreter through the first step;
- statics: hydrostatics against Capytaine's, equilibria, righting arms and whole inspections.
"""

import argparse
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks import fleet, statics, steps, submersion, tree, vehicle
from rich.console import Console
from rich.table import Table


class Benchmark(NamedTuple):
    """Something that is measured."""

    measure: Callable[[bool], Any]
    """Measures it, with fewer sizes and repeats if its argument is True; nested results by name."""
    describe: Callable[[Any], Iterator[Table | str]]
    """Yields tables and lines that describe the results."""


BENCHMARKS = {
    "submersion": Benchmark(submersion.measure, submersion.describe),
    "tree": Benchmark(tree.measure, tree.describe),
    "step": Benchmark(steps.measure_step, steps.describe_step),
    "vehicle": Benchmark(vehicle.measure, vehicle.describe),
    "sea": Benchmark(steps.measure_sea, steps.describe_sea),
    "batch": Benchmark(steps.measure_batch, steps.describe_batch),
    "fleet": Benchmark(fleet.measure, fleet.describe),
    "real_time": Benchmark(steps.measure_real_time, steps.describe_real_time),
    "first_step": Benchmark(steps.measure_first_step, steps.describe_first_step),
    "statics": Benchmark(statics.measure, statics.describe),
}
"""The benchmarks by name, in the order in which they run."""


def main() -> None:
    """Measure, print, plot, compare and save."""
    options = parse_arguments()
    console = Console(width=140)
    results: dict[str, Any] = {}
    for name, benchmark in BENCHMARKS.items():
        if name in options.only:
            results[name] = benchmark.measure(options.quick)
            for part in benchmark.describe(results[name]):
                console.print(part)
    if options.plot and "submersion" in results:
        submersion.plot(options.plot, results["submersion"])
    if options.compare:
        for line in compare(results, json.loads(options.compare.read_text())):
            console.print(line)
    if options.save:
        options.save.write_text(json.dumps(results, indent=2) + "\n")


def parse_arguments() -> argparse.Namespace:
    """Parse the options of the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer sizes and repeats")
    names = list(BENCHMARKS)
    parser.add_argument(
        "--only", nargs="+", choices=names, default=names, help="measure these alone"
    )
    parser.add_argument("--plot", type=Path, help="draw time against triangles into this picture")
    parser.add_argument("--save", type=Path, help="write the measurements to this JSON file")
    parser.add_argument("--compare", type=Path, help="set them beside those of this JSON file")
    return parser.parse_args()


def compare(results: dict[str, Any], earlier: dict[str, Any]) -> Iterator[str]:
    """Yield a line for each value that earlier results have too."""
    before = flatten(earlier)
    for key, value in flatten(results).items():
        if key in before and not key.endswith("triangles"):
            ratio = value / before[key]
            yield f"{key}: {value:.4g}, was {before[key]:.4g}, {ratio:.2f} x"


def flatten(results: dict[str, Any], prefix: str = "") -> dict[str, float]:
    """Flatten nested results, their names joined by slashes."""
    flat: dict[str, float] = {}
    for key, value in results.items():
        if isinstance(value, dict):
            flat |= flatten(value, f"{prefix}{key}/")
        else:
            flat[prefix + key] = value
    return flat


if __name__ == "__main__":
    main()

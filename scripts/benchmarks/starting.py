"""Starting: an import, the help, a first step, and what an installation compiles for it."""

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator

from benchmarks.rows import Row, describe_time

FIRST_STEP = (
    "from buoyancy_mj import Simulation, read_scene; from buoyancy_mj.scenes import catalog; "
    "Simulation(read_scene(catalog.scenes()['auv_waves'])).step()"
)
"""What a first step is: of an AUV with thrusters and sensors, in a wave."""
WITHOUT_PLUGINS = "import importlib.metadata as packages; packages.entry_points = lambda **_: (); "
"""Keeps MuJoCo from plugins that are installed, ours among them."""
STARTS = {
    "mujoco alone": ("-c", f"{WITHOUT_PLUGINS}import mujoco"),
    "mujoco": ("-c", "import mujoco"),
    "import": ("-c", "import buoyancy_mj"),
    "help": ("-m", "buoyancy_mj", "--help"),
    "first step": ("-c", FIRST_STEP),
}
"""Arguments of fresh interpreters."""


def measure(quick: bool) -> dict[str, float]:
    """Measure the processor time [s] of fresh interpreters; and of compiling, as if new here."""
    results = {
        name: min(_processor_time(*arguments) for _ in range(1 if quick else 3))
        for name, arguments in STARTS.items()
    }
    if not quick:
        with tempfile.TemporaryDirectory() as empty:
            whole = _processor_time("-c", FIRST_STEP, NUMBA_CACHE_DIR=empty)
        results["compiling"] = whole - results["first step"]
    return results


def describe(results: dict[str, float]) -> Iterator[str]:
    """Describe all in a line."""
    times = ", ".join(f"{name} {seconds:.2f} s" for name, seconds in results.items())
    yield f"a fresh interpreter, in processor time: {times}"


def rows(results: dict[str, float]) -> Iterator[Row]:
    """Each of them."""
    names = {
        "mujoco alone": "`import mujoco`, nothing else installed",
        "mujoco": "`import mujoco`, which this package tells of its plugins",
        "import": "`import buoyancy_mj`",
        "help": "`buoyancy-mj --help`",
        "first step": "a fresh interpreter through the first step of `auv_waves`",
        "compiling": "compiling for that, once after an installation",
    }
    for name, seconds in results.items():
        yield Row(names[name], describe_time(seconds))


def _processor_time(*arguments: str, **environment: str) -> float:
    """Processor time [s] of a fresh interpreter."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-P", *arguments],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env=os.environ | environment,
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

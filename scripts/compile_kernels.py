"""Compile the kernels beforehand, side by side on all cores.

    .venv/bin/python scripts/compile_kernels.py

Processes that start together on a fresh installation would each compile all that they need, the
same in every one of them. What is compiled already stays.
"""

import os
import signal
import sys
import tempfile
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import mujoco

from buoyancy_mj import Buoyancy, RegularWave, Simulation, Water, read_scene
from buoyancy_mj.inspection.inspection import inspect_model
from buoyancy_mj.kernels import passes
from buoyancy_mj.kernels.entries import crews, loads, passive
from buoyancy_mj.kernels.entries.closures import compile_kernel
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.specs import read_spec

FIRST = ("submerge", "add_drag", "add_ballast", "press_hulls", "add_panel_drag", "add_reaction")
"""Kernels that take longest. The pressure has parts in it that the submersion has too, so it
waits for them."""
SCENES = ("auv_waves", "bluerov2_heavy_station")
"""Scenes with waves, and with thrusters, sensors and a controller."""
MODELS = ("hourglass", "glider")
"""A mesh, and primitives with foils and ballast."""


def list_entries() -> dict[str, Callable[..., Any]]:
    """Kernels that the engine calls, by name, in the order in which they are compiled."""
    kernels = (loads.submerge, loads.augment, loads.add_inertia, crews.work)
    named = {kernel.__name__: kernel for kernel in (*kernels, passive.act, passive.callback)}
    named |= {load.__name__: loads.make_entry(load) for load in passes.LOADS}
    return {name: named[name] for name in dict.fromkeys((*FIRST, *named))}


def compile_entry(name: str) -> None:
    """Compile one of them."""
    compile_kernel(list_entries()[name])


def run_scene(name: str) -> None:
    """Compile what a run calls from Python."""
    Simulation(read_scene(catalog.scenes()[name], ["duration=0.05"])).run()


def look_at(name: str) -> None:
    """Compile what an inspection calls from Python, and a pass in waves."""
    model = read_spec(catalog.model_path(name)).compile()
    inspect_model(model, added_mass="estimate")
    water = Water(waves=RegularWave(0.1, period=3.0))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    Buoyancy(model, water, added_mass="estimate").evaluate(data)


def main() -> None:
    """Compile on as many processes as there are cores."""
    # leave the block below, which ends those processes
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    with tempfile.TemporaryDirectory() as folder:
        # what is kept of meshes would leave kernels out that find it
        os.environ["BUOYANCY_MJ_CACHE"] = folder
        with ProcessPoolExecutor(os.cpu_count(), get_context("spawn")) as processes:
            list(processes.map(compile_entry, list_entries()))
            looks = processes.map(look_at, MODELS)
            runs = processes.map(run_scene, SCENES)
            list(looks), list(runs)


if __name__ == "__main__":
    main()

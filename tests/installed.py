"""Processes in which this package is installed, whatever the environment of the tests says."""

import os
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def install(folder):
    """Make a folder say that this package is installed; the environment of such processes."""
    entries = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    ((name, target),) = entries["mujoco.plugins"].items()
    information = folder / "buoyancy_mj-0.1.0.dist-info"
    information.mkdir()
    (information / "METADATA").write_text(
        "Metadata-Version: 2.1\nName: buoyancy_mj\nVersion: 0.1.0\n"
    )
    (information / "entry_points.txt").write_text(f"[mujoco.plugins]\n{name} = {target}\n")
    return os.environ | {"PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}

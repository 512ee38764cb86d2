"""Runs of the benchmarks, saved as JSON with the machine that they were measured on."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.machine import Machine

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "bench"
"""Where the runs lie that the pages show, one for each machine."""


class Run(NamedTuple):
    """What was measured, and where."""

    machine: Machine
    """The machine."""
    results: dict[str, Any]
    """The results by benchmark."""

    @property
    def label(self) -> str:
        """The machine in few words."""
        return f"{self.machine['processor']}, {self.machine['vectors']}"


def read_run(path: Path) -> Run:
    """Read a saved run."""
    saved = json.loads(path.read_text())
    return Run(saved["machine"], saved["results"])


def read_runs() -> list[Run]:
    """The runs that the pages show."""
    return [read_run(path) for path in sorted(FOLDER.glob("*.json"))]


def save_run(path: Path, run: Run, *, keep: bool = False) -> None:
    """Save a run.

    Args:
        path: the file.
        run: the run.
        keep: whether benchmarks that were not measured keep the results that are in the file.
    """
    results: Mapping[str, Any] = run.results
    if keep and path.is_file():
        results = read_run(path).results | run.results
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"machine": run.machine, "results": results}, indent=2) + "\n")

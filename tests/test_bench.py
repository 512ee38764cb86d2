"""The benchmarks run, and find what they say that they measure; how fast is not asked here."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
NAMES = ("submersion", "tree", "vehicle", "sea", "statics")


@pytest.mark.long
@pytest.mark.slow
def test_benchmarks_measure_and_print(tmp_path):
    # one process for all, since the packages beside which they measure are slow to import
    command = [sys.executable, "scripts/bench.py", "--quick", "--only", *NAMES]
    command += ["--save", str(tmp_path / "saved.json")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    for printed in (
        "one submersion",
        "by the tree",
        "eight thrusters",
        "water's part of a step",
        "hull, 1,",
    ):
        assert printed in done.stdout
    saved = json.loads((tmp_path / "saved.json").read_text())
    assert list(saved) == list(NAMES)
    assert all(saved.values())

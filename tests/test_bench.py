"""The benchmarks run, and find what they say that they measure; how fast is not asked here."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.mark.slow
@pytest.mark.parametrize("name", ["submersion", "tree", "sea", "statics", "vehicle"])
def test_a_benchmark_measures_and_prints(name, tmp_path):
    command = [sys.executable, "scripts/bench.py", "--quick", "--only", name]
    command += ["--save", str(tmp_path / "saved.json")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
    assert (tmp_path / "saved.json").stat().st_size > 10

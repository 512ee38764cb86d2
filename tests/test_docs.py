"""The code in the README runs, and what it names exists."""

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from buoyancy_mj import catalog
from buoyancy_mj.cli import app

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text()


def test_the_ten_lines_run(tmp_path, monkeypatch, capsys):
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    vehicle = catalog.models()["sauvc_auv"]
    exec(compile(code.replace("my_auv.xml", vehicle.as_posix()), "README.md", "exec"), {})
    assert "m^3 under water" in capsys.readouterr().out


@pytest.mark.parametrize("line", re.findall(r"\.venv/bin/buoyancy-mj (run .*)", README))
def test_the_command_lines_are_understood(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    vehicle = catalog.models()["hourglass"]
    words = shlex.split(line, comments=True)
    words = [word.replace("path/to/my_vehicle.xml", str(vehicle)) for word in words if word != "--live"]
    result = CliRunner().invoke(app, [*words, "--duration", "0.05"])
    assert result.exit_code == 0, result.output


def test_every_file_and_picture_named_is_there():
    for name in re.findall(r"\]\((?!http)([^)]+)\)", README):
        assert (ROOT / name).exists(), name
    for name in ("scripts/demo", "scripts/test", "scripts/bench.py"):
        assert name in README
        assert (ROOT / name).exists()


def test_every_module_stands_in_the_import_contract():
    contract = (ROOT / "pyproject.toml").read_text()
    for path in (ROOT / "buoyancy_mj").glob("*.py"):
        if not path.stem.startswith("__"):
            assert f"buoyancy_mj.{path.stem}" in contract, path.stem

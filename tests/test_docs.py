"""The code in the README runs, and what it names exists."""

import re
import shlex
from pathlib import Path

import mujoco
import pytest
from typer.testing import CliRunner

from buoyancy_mj import water_in
from buoyancy_mj.cli import app
from buoyancy_mj.scenes import catalog

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text()


@pytest.mark.parametrize(
    ("code", "told"),
    [
        *zip(
            re.findall(r"```python\n(.*?)```", README, re.DOTALL),
            ["m^3 under water", "] N", "kg make it neutral", "Pa, under"],
            strict=True,
        )
    ],
)
def test_the_lines_of_python_run(code, told, capsys):
    vehicle = catalog.models()["sauvc_auv"]
    exec(compile(code.replace("my_auv.xml", vehicle.as_posix()), "README.md", "exec"), {})
    assert told in capsys.readouterr().out


def test_the_extension_in_the_readme_is_one():
    (extension,) = re.findall(r"    <extension>.*?</extension>", README, re.DOTALL)
    model = mujoco.MjModel.from_xml_string(
        f"<mujoco>{extension}<worldbody><body><freejoint/><geom size='.1'/></body></worldbody>"
        "</mujoco>"
    )
    water = water_in(model).water
    assert (water.density, len(water.waves), water.current) == (1025.0, 2, (0.2, 0.0, 0.0))


@pytest.mark.parametrize("line", re.findall(r"\.venv/bin/buoyancy-mj (sweep .*)", README))
def test_the_sweeps_are_understood(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = [re.sub(r":[67]$", ":1", word) for word in shlex.split(line)]
    words[-1:] = [words[-1], "--duration", "0.02"]
    if "--draws" in words:
        words[words.index("--draws") + 1] = "2"
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    assert "0 failed" in result.output


@pytest.mark.parametrize("line", re.findall(r"\.venv/bin/buoyancy-mj (run .*)", README))
def test_the_command_lines_are_understood(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    vehicle = catalog.models()["hourglass"]
    words = shlex.split(line, comments=True)
    words = [
        word.replace("path/to/my_vehicle.xml", str(vehicle)) for word in words if word != "--live"
    ]
    result = CliRunner().invoke(app, [*words, "--duration", "0.05"])
    assert result.exit_code == 0, result.output


@pytest.mark.parametrize(
    "line", re.findall(r"\.venv/bin/buoyancy-mj ((?:inspect|ballast) .*)", README)
)
def test_the_inspections_are_understood(line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    words = shlex.split(line, comments=True)
    words = [
        word.replace("path/to/my_vehicle.xml", str(catalog.models()["sauvc_auv"])) for word in words
    ]
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output


def test_every_file_and_picture_named_is_there():
    for name in re.findall(r"\]\((?!http)([^)]+)\)", README):
        assert (ROOT / name).exists(), name
    for name in ("scripts/demo", "scripts/test", "scripts/bench.py"):
        assert name in README
        assert (ROOT / name).exists()


def test_every_room_stands_in_the_import_contract_and_on_the_list_of_the_readme():
    contract = (ROOT / "pyproject.toml").read_text()
    rooms = [
        path.stem for path in (ROOT / "buoyancy_mj").iterdir() if not path.name.startswith("__")
    ]
    assert len(rooms) > 10
    for room in rooms:
        assert f'"buoyancy_mj.{room}' in contract or f"| buoyancy_mj.{room}" in contract, room
        assert re.search(rf"^    (\w+, )?{room}\b", README, re.MULTILINE), room

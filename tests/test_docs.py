"""What the pages show works: code runs, commands are understood, snippets parse, names exist."""

import ast
import importlib
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import tomllib

import mujoco
import numpy as np
import pytest
import typer
import xarray
from typer.testing import CliRunner

import buoyancy_mj
from buoyancy_mj import Buoyancy, Water, water_in
from buoyancy_mj.cli import app
from buoyancy_mj.engine.instances import instance_name, plugin_instances
from buoyancy_mj.loads.datasets import DOFS
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import scene_from_table
from tests.scripts import ROOT, script

PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text()
    for path in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
}
README = PAGES["README.md"]
FIRST_HOUR = ROOT / "docs" / "first_hour.md"
"""The page that has its reader write files."""
COMMANDS = "docs/guide/command_line.md"
"""The page that shows a whole scene."""
RECORDING = {"--record", "--no-record"}
"""Flags that say whether a run is recorded."""
GENERATED = ROOT / "docs" / "reference"
"""Pages that only the site has."""
ROOMS = [
    path.stem
    for path in sorted((ROOT / "buoyancy_mj").iterdir())
    if not path.name.startswith("_") and (path.suffix == ".py" or (path / "__init__.py").exists())
]
VEHICLE = """<worldbody><body name="rov" pos="0 0 -1"><freejoint/>
<geom name="hull" size=".2"/>
<geom name="shroud" size=".1" pos=".5 0 0" group="2"/>
<geom name="frame" size=".1" pos="-.5 0 0" group="2"/>
</body></worldbody>"""
"""Something for the snippets of MJCF to speak of."""


def blocks(language):
    """The fenced blocks of a language on all pages, by page and line."""
    return [
        pytest.param(found[1], id=f"{page}:{text.count(chr(10), 0, found.start()) + 1}")
        for page, text in PAGES.items()
        for found in re.finditer(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    ]


def command_lines():
    """Each command in a block for a shell, and each that a sentence names, by where it is first."""
    lines = [
        (block.id, line.split(" #")[0].strip())
        for block in blocks("sh")
        for line in block.values[0].splitlines()
    ]
    for page, text in PAGES.items():
        named = re.findall(r"`((?:\.venv/bin/)?buoyancy-mj [a-z][^`]*)`", text)
        lines += [(page, line) for line in named]
    first = {}
    for place, line in lines:
        first.setdefault(line.removeprefix(".venv/bin/"), f"{place} {line}")
    return [pytest.param(line, id=name) for line, name in first.items() if line]


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder with the files that the pages name, to work in."""
    vehicle = catalog.models()["sauvc_auv"]
    for name in ("my_auv.xml", "path/to/my_vehicle.xml"):
        shutil.copytree(vehicle.parent, (tmp_path / name).parent, dirs_exist_ok=True)
        shutil.copy(vehicle, tmp_path / name)
    (scene,) = re.findall(r"^```toml\n(title.*?)^```", PAGES[COMMANDS], re.MULTILINE | re.DOTALL)
    (tmp_path / "my_scene.toml").write_text(scene)
    (tmp_path / "tide.csv").write_text("time, u, v, w\n0, 0.1, 0, 0\n3600, 0.3, 0, 0\n")
    (tmp_path / "my_boat.xml").write_text(f"<mujoco>{VEHICLE.replace('rov', 'hull')}</mujoco>")
    over = ("omega", "influenced_dof", "radiating_dof")
    matrices = (over, np.eye(6)[None])
    names = [f"hull__{dof}" for dof in DOFS]
    xarray.Dataset(
        {"added_mass": matrices, "radiation_damping": matrices},
        coords={"omega": [0.7], "influenced_dof": names, "radiating_dof": names},
    ).to_netcdf(tmp_path / "boat.nc")
    script("page_files").write_page_files(FIRST_HOUR, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("desk")
@pytest.mark.parametrize("code", blocks("python"))
def test_the_python_runs_and_prints_what_it_says(code, capsys):
    exec(compile(code, "page", "exec"), {})
    printed = capsys.readouterr().out
    assert printed.strip()
    for call in ast.walk(ast.parse(code)):
        if (
            isinstance(call, ast.Call)
            and isinstance(call.func, ast.Name)
            and call.func.id == "print"
        ):
            for said in call.args:
                assert not isinstance(said, ast.Constant) or said.value in printed


@pytest.mark.usefixtures("desk")
@pytest.mark.parametrize("snippet", blocks("xml"))
def test_the_mjcf_compiles_and_floats(snippet):
    whole = snippet if "<mujoco" in snippet else f"<mujoco>{snippet}{VEHICLE}</mujoco>"
    model = mujoco.MjModel.from_xml_string(whole)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    instances = [instance_name(model, i) for i in plugin_instances(model)]
    waters = [water_in(model, name) for name in instances] or [Buoyancy(model, Water())]
    for water in waters:
        assert water.evaluate(data).total.volume > 0.0


def test_the_extension_in_the_guide_is_the_water_that_it_looks_like():
    (extension,) = re.findall(
        r"<extension>.*?</extension>", PAGES["docs/guide/model.md"], re.DOTALL
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{extension}{VEHICLE}</mujoco>")
    water = water_in(model).water
    assert (water.density, len(water.waves), water.current) == (1025.0, 2, (0.2, 0.0, 0.0))


@pytest.mark.parametrize("snippet", blocks("toml"))
def test_the_toml_is_part_of_a_scene(snippet, desk):
    given = tomllib.loads(snippet)
    vehicle = {} if "vehicles" in given else {"vehicle": "sauvc_auv"}
    table = {"title": "a snippet"} | vehicle | given
    scene_from_table(table, folder=desk)


@pytest.mark.usefixtures("desk")
@pytest.mark.parametrize("line", command_lines())
def test_the_command_lines_are_understood(line):
    program, *words = shlex.split(line)
    if program.startswith("scripts/"):
        assert os.access(ROOT / program, os.X_OK), program
    elif program == "python":
        assert (ROOT / words[0]).exists(), words[0]
    elif program == "pip":
        extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"][
            "optional-dependencies"
        ]
        assert re.fullmatch(r"(?:buoyancy_mj|\.)\[(\w+)\]", words[-1])[1] in extras
    else:
        assert program == "buoyancy-mj", line
        understand(*words)


def understand(command, *words):
    """Run a command, shortened, or only parse it where it opens a window or takes minutes."""
    group = typer.main.get_command(app)
    if all(word.startswith("--") for word in words) and command not in (
        "list",
        "paper",
        "validate",
    ):
        # a command and its flags, named in a sentence
        known = {
            flag for parameter in group.get_command(None, command).params for flag in parameter.opts
        }
        assert set(words) <= known | {"--help"}
        return
    parsed = group.get_command(None, command).make_context(command, list(words))
    if command in ("paper", "validate"):
        # a wrong name lists the right ones
        listed = CliRunner().invoke(app, [command, "--only", "none"]).output
        assert set(parsed.params["only"] or ()) <= set(re.findall(r"\w+", listed))
        return
    if command in ("view", "sitl") or set(words) & {"--video", "--screenshot"}:
        return
    if command == "run":
        shown = ("--live", "--foxglove", "--serve")
        words = [word for word in words if word not in shown] + ["--duration", "0.05"]
        if not set(words) & RECORDING:
            # a recording that nobody asks for takes longer than such a run
            words.append("--no-record")
    elif command in ("respond", "decay"):
        shorter = {"--periods": "4", "--heading": "180"}
        words = [shorter.get(flag, word) for flag, word in zip(["", *words], words, strict=False)]
        words += ["--set", "added_mass=none"]
    elif command == "sweep":
        words = [re.sub(r":\d$", ":1", word) for word in words] + ["--duration", "0.02"]
        if "--on" in words:
            # the cluster is not here
            words[words.index("--on") + 1] = "local"
        if "--draws" in words:
            words[words.index("--draws") + 1] = "2"
    result = CliRunner().invoke(app, [command, *words])
    assert result.exit_code == 0, result.output
    assert command != "sweep" or "0 failed" in result.output


@pytest.mark.parametrize("page", PAGES)
def test_every_link_and_picture_is_there(page):
    for target, _, anchor in re.findall(r"\]\((?!http)([^)#]*)(#([^)]*))?\)", PAGES[page]):
        file = ((ROOT / page).parent / target).resolve() if target else ROOT / page
        if file.parent == GENERATED:
            continue  # the site's own test follows these
        assert file.exists(), target
        if anchor:
            assert anchor in anchors(file.read_text()), f"{target}#{anchor}"


def anchors(text):
    """The anchors of a page's headings."""
    titles = re.findall(r"^#+ (.*)", text, re.MULTILINE)
    return {re.sub(r"\s+", "-", re.sub(r"[^\w\s-]", "", title.lower()).strip()) for title in titles}


def test_every_page_of_the_guide_stands_in_its_table_and_in_the_navigation():
    index, navigation = PAGES["docs/guide/index.md"], (ROOT / "mkdocs.yml").read_text()
    pages = [path.name for path in (ROOT / "docs" / "guide").glob("*.md") if path.stem != "index"]
    order = re.findall(r"^\| .* \| \[.*\]\((\w+\.md)\) \|$", index, re.MULTILINE)
    assert sorted(order) == sorted(pages)
    assert re.findall(r"- guide/(\w+\.md)", navigation) == ["index.md", *order]


@pytest.mark.parametrize("page", PAGES)
def test_every_file_and_every_name_in_the_text_exists(page):
    for name in re.findall(
        r"`((?:scripts|tests|models|scenes|docs|buoyancy_mj)/[\w./-]*)", PAGES[page]
    ):
        assert (ROOT / name).exists(), name
    for name in re.findall(rf"`((?:{'|'.join(ROOMS)})\.\w[\w.]*)", PAGES[page]):
        resolve(name)


def resolve(name):
    """Find a module of the package, or what stands in one."""
    module, parts = buoyancy_mj, name.split(".")
    while parts:
        dotted = f"{module.__name__}.{parts[0]}"
        if importlib.util.find_spec(dotted) is None:
            break
        module = importlib.import_module(dotted)
        parts = parts[1:]
        if not hasattr(module, "__path__"):
            break
    item = module
    for part in parts:
        item = getattr(item, part)
        # made there, not only imported
        home = getattr(item, "__module__", None) or ""
        assert not home.startswith("buoyancy_mj") or home == module.__name__, name


def test_the_first_page_is_short_and_names_the_scripts():
    assert README.count("\n") <= 150
    for name in ("scripts/demo", "scripts/test", "scripts/bench.py", "scripts/docs"):
        assert name in README


def test_every_room_stands_in_the_import_contract():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]
    (layers,) = (each["layers"] for each in settings["contracts"] if each["type"] == "layers")
    placed = {word.split(".")[-1] for layer in layers for word in layer.split(" | ")}
    assert len(ROOMS) > 10
    assert placed - {"__main__", "_launch", "_names"} == set(ROOMS)


def test_no_public_name_hides_a_module():
    paths = [path.relative_to(ROOT) for path in (ROOT / "buoyancy_mj").rglob("[a-z]*.py")]
    for path in paths:
        module = importlib.import_module(".".join(path.with_suffix("").parts))
        owner = importlib.import_module(".".join(path.parent.parts))
        assert getattr(owner, path.stem) is module, path


def test_the_house_on_the_page_is_the_house_and_each_room_imports_what_it_says_and_no_more():
    house = script("draw_house")
    rooms = house.read_rooms()
    assert {room.name for room in rooms} == set(ROOMS)
    assert house.table(rooms) in PAGES["docs/architecture.md"]
    for room in rooms:
        assert room.imports <= room.may_import, room.name


def test_an_undocumented_public_name_is_found():
    griffe = pytest.importorskip("griffe", reason="the extra 'docs' is not installed")
    pytest.importorskip("mkdocs", reason="the extra 'docs' is not installed")
    code = 'class Ship:\n    """It floats."""\n    draft: float\n    beam: float\n    """[m]."""\n'
    module = griffe.visit("yard", ROOT / "yard.py", code)
    assert [*script("site_pages").undocumented(module["Ship"])] == ["yard.Ship.draft"]


@pytest.mark.slow
def test_the_site_builds_without_a_broken_link_and_asks_nothing_of_the_network(tmp_path):
    for module in ("latex2mathml", "material", "mkdocstrings"):
        pytest.importorskip(module, reason="the extra 'docs' is not installed")
    command = [sys.executable, "-m", "mkdocs", "build", "--site-dir", str(tmp_path)]
    environment = os.environ | {"NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(ROOT)}
    built = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stdout + built.stderr
    # a page that is not found does not know where it stands
    files = [path for path in tmp_path.rglob("*.html") if path.name != "404.html"]
    pages = {path: path.read_text() for path in files}
    remote = re.compile(r"<(?:script|link|img|iframe)[^>]+(?:src|href)=.?https?:[^>]*")
    for page, text in pages.items():
        assert not remote.findall(text), page
        assert 'class="arithmatex"' not in text, page
        for link, anchor in re.findall(r'(?:href|src)="([^":#]*)(?:#([^"]*))?"', text):
            target = (page.parent / link).resolve() if link else page
            assert target.exists(), f"{page}: {link}"
            assert not anchor or f'id="{anchor}"' in pages[target], f"{page}: {link}#{anchor}"
    whole = "".join(pages.values())
    for names in script("site_pages").public_names().values():
        for name in names:
            assert f'id="buoyancy_mj.{name}"' in whole, name

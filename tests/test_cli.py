import importlib.metadata
import json
import os
import pkgutil
import re
import shlex
import signal
import subprocess
import sys
import time

import pytest
import typer
from typer.testing import CliRunner

import buoyancy_mj
from buoyancy_mj import Simulation, cli
from buoyancy_mj.cli import app
from buoyancy_mj.cli.group import MODULES
from buoyancy_mj.scenes import catalog

BOX = """<mujoco><worldbody>
<body name="box"><geom name="box" type="box" size=".2 .15 .05" mass="4"/></body>
</worldbody></mujoco>"""


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, list(arguments))


def one_sentence(result, message):
    assert result.exit_code == 1, result.output
    assert re.search(message, result.stderr), result.stderr
    assert result.stderr.count("\n") == 1
    assert "Traceback" not in result.output


def test_run_prints_a_table_and_leaves_a_recording(run, tmp_path):
    result = run("run", "hourglass_drop_still", "--duration", "0.2")
    assert result.exit_code == 0, result.output
    for word in (
        "mass",
        "displacement",
        "net weight",
        "peak draft",
        "final draft",
        "heave, whole run",
        "real-time factor",
        "contact",
    ):
        assert word in result.stdout
    assert "recordings/hourglass_drop_still.rrd" in result.stdout
    assert (tmp_path / "recordings" / "hourglass_drop_still.rrd").stat().st_size > 0


def test_json_is_all_that_is_printed(run):
    result = run("run", "auv_pool", "--duration", "0.1", "--no-record", "--json")
    summary = json.loads(result.stdout)
    assert summary["mass"] == pytest.approx(23.9)
    assert summary["simulated_time"] == pytest.approx(0.1)
    assert summary["recording"] is None
    assert summary["first_contact"] is None


@pytest.mark.parametrize("method", ["exact", "convex_hull", "sections"])
def test_a_method_is_chosen_and_its_options_set(run, method):
    result = run(
        *shlex.split(
            f"run hourglass_drop_still --method {method} --duration 0.1 --no-record --json"
        )
    )
    assert json.loads(result.stdout)["method"] == method
    option = {
        "convex_hull": "method.cut=true",
        "sections": "method.step=0.01",
        "exact": "duration=0.05",
    }[method]
    flags = f"--method {method} --set {option} --duration 0.05 --no-record --json"
    with_option = run("run", "auv_waves", *shlex.split(flags))
    assert with_option.exit_code == 0, with_option.output


def test_an_unknown_method_is_reported(run):
    one_sentence(
        run("run", "auv_waves", "--method", "hull", "--no-record"), "unknown kind 'hull'; .*exact"
    )
    one_sentence(
        run("run", "auv_waves", "--method", "exact", "--set", "method.cut=true", "--no-record"),
        "unknown key 'cut'; possible: tolerance",
    )


def test_flags_reach_the_scene(run):
    flags = "--duration 0.3 --timestep 0.05 --set water.density=500 --no-record --json"
    summary = json.loads(run("run", "hourglass_drop_still", *shlex.split(flags)).stdout)
    assert summary["simulated_time"] == pytest.approx(0.3)
    assert summary["displacement"] == pytest.approx(6.2996, abs=1e-3)


def test_a_vehicle_is_swapped_in_from_where_the_user_stands(run, tmp_path):
    (tmp_path / "my.xml").write_text(BOX)
    result = run(
        *shlex.split("run auv_waves --vehicle my.xml --duration 0.1 --record out/my.rrd --json")
    )
    assert json.loads(result.stdout)["mass"] == pytest.approx(4.0), result.output
    assert (tmp_path / "out" / "my.rrd").exists()


def test_a_shipped_vehicle_is_swapped_in_by_name(run):
    result = run(
        "run", "auv_waves", "--vehicle", "hourglass", "--duration", "0.1", "--no-record", "--json"
    )
    assert json.loads(result.stdout)["mass"] == pytest.approx(9.2)


def test_geoms_choose_what_displaces(run):
    arguments = shlex.split("--geoms foam* --geoms battery_pod --duration 0.1 --no-record --json")
    summary = json.loads(run("run", "auv_waves", *arguments).stdout)
    assert summary["displacement"] == pytest.approx(2 * 1.071 + 3.463, abs=2e-3)
    assert summary["net_weight"] > 0.0


def test_list_tells_a_line_for_each_scene_and_model(run):
    output = run("list").stdout
    for name in (*catalog.scenes(), *catalog.models()):
        assert name in output
    assert "+-0.3 m at 0.5 Hz" in output


def test_notices_go_to_the_standard_error(run, tmp_path):
    (tmp_path / "my.xml").write_text(
        BOX.replace("<worldbody>", '<worldbody><geom name="ground" type="plane" size="1 1 1"/>')
    )
    result = run(
        "run", "auv_waves", "--vehicle", "my.xml", "--duration", "0.1", "--no-record", "--json"
    )
    assert "note: the vehicle's ground plane 'ground'" in result.stderr
    json.loads(result.stdout)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("auv_wave",), r"error: there is no scene 'auv_wave'.*did you mean 'auv_waves'\?"),
        (("tub.xml",), r"error: 'tub.xml' is a model, .*'run auv_waves --vehicle tub.xml', or"),
        (("auv_waves", "--vehicle", "none.xml"), r"error: there is no vehicle 'none.xml'"),
        (("auv_waves", "--vehicle", "bad.xml"), r"error: MuJoCo cannot read '.*bad.xml'.*XML"),
        (
            ("auv_waves", "--vehicle", "tub.xml"),
            r"error: mesh 'tub' of geom 'tub': it is open: 1 hole",
        ),
        (
            ("auv_waves", "--vehicle", "fixed.xml"),
            r"error: '.*fixed.xml' has no body that could float",
        ),
        (
            ("auv_waves", "--vehicle", "up.xml"),
            r"error: gravity is 0 0 9.81; water needs it along -z",
        ),
        (
            ("auv_waves", "--set", "watr.level=1"),
            r"error: scene 'auv_waves': unknown key 'watr'; did you mean 'water'\?",
        ),
        (("auv_waves", "--duration", "-1"), r"duration is -1.0; it must be at least 1e-06"),
        (("auv_waves", "--duration", "nan"), r"duration is nan"),
        (
            ("auv_waves", "--geoms", "hul*"),
            r"error: no moving geom matches 'hul\*'.*possible: ballast_port",
        ),
        (
            ("auv_waves", "--vehicle", "~nobody-here/a.xml"),
            r"error: there is no vehicle '~nobody-here/a.xml'",
        ),
        (("x" * 300,), r"error: there is no scene 'xxx"),
        (
            ("auv_waves", "--record", "folder.rrd"),
            r"error: cannot write 'folder.rrd': it is a folder",
        ),
        (
            ("auv_waves", "--record", "x.mp4"),
            r"error: --record is 'x.mp4'; a recording's name ends in .rrd",
        ),
        (
            ("auv_waves", "--record", "x.rrd", "--no-record"),
            r"error: --record and --no-record contradict each other",
        ),
    ],
)
def test_bad_input_gets_one_sentence_and_leaves_nothing(run, tmp_path, arguments, message):
    (tmp_path / "bad.xml").write_text("<mujoco><worldbody>")
    (tmp_path / "fixed.xml").write_text("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    (tmp_path / "up.xml").write_text(
        BOX.replace("<worldbody>", "<option gravity='0 0 9.81'/><worldbody>")
    )
    vertices = "-1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1  -1 -1 1  1 -1 1  1 1 1  -1 1 1"
    faces = "0 2 1 0 3 2 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7"
    (tmp_path / "tub.xml").write_text(
        f"""<mujoco><asset>
        <mesh name="tub" inertia="shell" vertex="{vertices}" face="{faces}"/></asset>
        <worldbody><body><geom name="tub" type="mesh" mesh="tub"/></body></worldbody></mujoco>"""
    )
    (tmp_path / "folder.rrd").mkdir()
    before = set(tmp_path.rglob("*"))
    extra = () if "--no-record" in arguments or "--record" in arguments else ("--no-record",)
    result = run("run", *arguments, *extra)
    one_sentence(result, message)
    assert set(tmp_path.rglob("*")) == before


def test_a_diverging_run_keeps_its_recording(run, tmp_path):
    text = BOX.replace(
        '"box"><geom', '"box"><joint type="slide" axis="0 0 1" stiffness="3000"/><geom'
    )
    (tmp_path / "stiff.xml").write_text(text)
    flags = "--vehicle stiff.xml --set timestep=0.1 --set integrator=Euler --set damping=false"
    result = run("run", "auv_waves", *shlex.split(flags), "--record", "out.rrd")
    assert result.exit_code == 1
    assert re.search(
        r"the recording up to .* s is in 'out.rrd'\nerror: the simulation diverged at .*\n$",
        result.stderr,
    )
    assert "Nan, Inf" not in result.stderr
    assert not (tmp_path / "MUJOCO_LOG.TXT").exists()
    assert (tmp_path / "out.rrd").stat().st_size > 0


def test_brackets_and_pictures_in_names_are_only_text(run, tmp_path):
    (tmp_path / "boat \U0001f6a4.xml").write_text(BOX)
    arguments = (
        "--vehicle",
        "boat \U0001f6a4.xml",
        "--set",
        'title="a [/b] c"',
        "--record",
        "a[red]b.rrd",
    )
    result = run("run", "auv_waves", "--duration", "0.05", *arguments)
    assert result.exit_code == 0, result.output
    assert "a [/b] c" in result.stdout
    assert "a[red]b.rrd" in result.stdout


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_while_a_run_is_recorded_keeps_the_recording(run, tmp_path, monkeypatch, sent):
    advance = Simulation.advance

    def interrupted(self, count):
        advance(self, count)
        if self.data.time > 0.1:
            signal.raise_signal(sent)

    monkeypatch.setattr(Simulation, "advance", interrupted)
    result = run("run", "hourglass_drop_still", "--record", "out.rrd")
    assert result.exit_code == 128 + sent
    assert re.fullmatch(r"the recording up to 0\.1\d* s is in 'out\.rrd'\n", result.stderr)
    assert [path.name for path in tmp_path.iterdir()] == ["out.rrd"]
    # its footer, which comes last
    assert b"FOOT" in (tmp_path / "out.rrd").read_bytes()[-32:]


@pytest.mark.slow
def test_ctrl_c_keeps_the_recording_and_says_where(tmp_path):
    command = [
        sys.executable,
        "-m",
        "buoyancy_mj",
        *shlex.split("run auv_waves --duration 10000 --record out.rrd"),
    ]
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        # what is started in the background ignores it
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    partial = tmp_path / "out.partial.rrd"
    deadline = time.monotonic() + 120.0
    # meshes, which come first, take 1.6 MB: frames are being written
    while not (partial.exists() and partial.stat().st_size > 2_000_000):
        assert time.monotonic() < deadline
        time.sleep(0.1)
    os.kill(process.pid, signal.SIGINT)
    _, told = process.communicate(timeout=120)
    assert process.returncode == 128 + signal.SIGINT
    assert re.search(r"the recording up to .* s is in 'out.rrd'", told), told
    assert "Traceback" not in told
    verify = [sys.executable, "-m", "rerun_cli", "rrd", "verify", str(tmp_path / "out.rrd")]
    assert subprocess.run(verify, capture_output=True, check=False).returncode == 0


def test_help_names_every_command_and_what_it_does(run):
    output = run("--help").stdout
    group = typer.main.get_command(app)
    for name in group.list_commands(None):
        begun = group.get_command(None, name).help[:30]
        assert re.search(rf"^  {name}  +{re.escape(begun)}", output, re.MULTILINE), name


def test_every_command_of_every_module_is_found():
    for module in pkgutil.iter_modules(cli.__path__):
        importlib.import_module(f"buoyancy_mj.cli.{module.name}")
    registered = {
        typer.main.get_command_name(info.name or info.callback.__name__)
        for info in app.registered_commands
    }
    assert registered == set(MODULES)


def test_version_is_that_of_the_installed_package(run):
    assert buoyancy_mj.__version__ == importlib.metadata.version("buoyancy_mj")
    result = run("--version")
    assert result.exit_code == 0
    assert result.stdout == f"buoyancy-mj {buoyancy_mj.__version__}\n"


def completion(instruction, **environment):
    environment["_BUOYANCY_MJ_COMPLETE"] = instruction
    return CliRunner().invoke(app, prog_name="buoyancy-mj", env=environment).stdout


def test_a_shell_completes_commands():
    words = completion("complete_bash", COMP_WORDS="buoyancy-mj ins", COMP_CWORD="1")
    assert words.split() == ["inspect"]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_is_installed_by_a_script(shell):
    assert f"_BUOYANCY_MJ_COMPLETE=complete_{shell}" in completion(f"source_{shell}")


@pytest.mark.parametrize("name", list(MODULES))
def test_the_help_of_every_command_ends_with_two_examples(name):
    told = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "80"}).stdout
    *_, title, one, two = told.rstrip().splitlines()
    assert title.strip() == "Examples:"
    for example in (one, two):
        assert example.split()[:2] == ["buoyancy-mj", name]
        assert len(example) <= 80

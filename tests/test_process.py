"""Safe to run and to stop: signals end a command, and no file of the working folder is run."""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import mujoco
import pytest
from typer.testing import CliRunner

import buoyancy_mj
from buoyancy_mj import Buoyancy, ModelError, Simulation, Water, read_scene
from buoyancy_mj.cli import app
from buoyancy_mj.cli.console import quote_path
from buoyancy_mj.cli.signals import Stop, raise_later, raise_signals
from buoyancy_mj.engine import registration
from buoyancy_mj.engine.c_functions import find_cause
from buoyancy_mj.files import open_partial, replace_file
from buoyancy_mj.scenes import batches, catalog, places, variations
from buoyancy_mj.scenes.sweep import Sweep

STILL = catalog.scenes()["hourglass_drop_still"]
SIGNALS = [signal.SIGINT, signal.SIGTERM]


def run_python(*arguments, **options):
    return subprocess.run(
        [sys.executable, *arguments],
        capture_output=True, text=True, check=False, timeout=300, **options,
    )  # fmt: skip


@pytest.fixture
def here(tmp_path, monkeypatch):
    """Runs a command in an empty folder."""
    monkeypatch.chdir(tmp_path)
    return lambda *arguments: CliRunner().invoke(app, [str(part) for part in arguments])


@pytest.fixture
def send_when_asked(monkeypatch):
    """Sends a signal when MuJoCo asks Python for a water for the n-th time."""
    find_water = registration.find_water

    def send(number, at):
        asked = []

        def find(*arguments):
            asked.append(arguments)
            if len(asked) == at:
                signal.raise_signal(number)
            return find_water(*arguments)

        monkeypatch.setattr(registration, "find_water", find)

    return send


# signals ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", SIGNALS)
@pytest.mark.parametrize("at", range(1, 5))
def test_a_signal_while_a_model_is_built_ends_a_run(send_when_asked, number, at):
    send_when_asked(number, at)
    result = CliRunner().invoke(app, ["run", str(STILL), "--duration", "0.05", "--no-record"])
    assert result.exit_code == 128 + number
    assert result.output == ""


@pytest.mark.parametrize("at", range(1, 7))
def test_a_signal_while_a_model_is_built_ends_a_sweep_and_leaves_no_row_of_it(
    send_when_asked, monkeypatch, tmp_path, at
):
    out = tmp_path / "rows.csv"
    arguments = ["sweep", str(STILL), "--over", "mass=9:10:2", "--duration", "0.05", "--out", out]
    monkeypatch.setattr(places, "BATCH_SIZE", 1)
    send_when_asked(signal.SIGINT, at)
    result = CliRunner().invoke(app, list(map(str, arguments)))
    assert result.exit_code == 130
    assert result.stderr.endswith("of 2 runs are done; the same command does the rest\n")
    assert "failed" not in (out.read_text() if out.exists() else "")

    result = CliRunner().invoke(app, list(map(str, arguments)))
    assert result.exit_code == 0
    assert result.stdout.replace("\n", "") == f"2 runs, 0 failed: {out}"


@pytest.fixture
def interrupt():
    """Gives a method of submersion that raises to a water, until the end of the test."""
    changed = []

    class Raising:
        def __init__(self, error, volumes):
            self.error, self.volumes = error, volumes

        def submerge(self, *_):
            raise self.error

    def change(buoyancy, error=KeyboardInterrupt):
        load_model = buoyancy.compiled._load_model
        changed.append((load_model, load_model.packed))
        object.__setattr__(load_model, "packed", Raising(error, load_model.packed.volumes))

    yield change
    for load_model, packed in changed:
        object.__setattr__(load_model, "packed", packed)


@pytest.mark.parametrize("error", [KeyboardInterrupt, SystemExit, MemoryError, ModelError("no")])
def test_what_python_raises_inside_a_step_is_raised_as_itself(interrupt, error):
    simulation = Simulation(read_scene(STILL, ["method=sections"]))
    simulation.step()
    interrupt(simulation.buoyancy, error)
    with pytest.raises(error if isinstance(error, type) else type(error)):
        simulation.step()


def test_ctrl_c_inside_a_batch_is_no_failure_of_a_run(interrupt):
    simulations = {n: Simulation(read_scene(STILL, ["method=sections"])) for n in range(2)}
    interrupt(simulations[0].buoyancy)
    with pytest.raises(KeyboardInterrupt):
        list(batches.run_simulations(simulations, threads=1))


INTERRUPTED = """
import sys
import mujoco
from buoyancy_mj import Water, add_water
from buoyancy_mj.engine.c_functions import find_cause, raise_causes

def interrupt(frame, event, argument):
    # before its first line, as signals do
    if frame.f_code.co_name == "called":
        raise KeyboardInterrupt

spec = mujoco.MjSpec.from_string(
    "<mujoco><worldbody><body><freejoint/><geom size='1'/></body></worldbody></mujoco>"
)
add_water(spec, Water())
model = spec.compile()
data = mujoco.MjData(model)
sys.unraisablehook = lambda raised: None
sys.setprofile(interrupt)
try:
    with raise_causes():
        mujoco.MjData(model)
except BaseException as error:
    sys.setprofile(None)
    print(type(error).__name__)
mujoco.mj_step(model, data)
print(mujoco.MjData(model).time, data.time)
"""


def test_a_signal_before_the_first_line_of_what_the_engine_calls_ends_no_process():
    done = run_python("-c", INTERRUPTED)
    assert (done.returncode, done.stdout) == (0, "KeyboardInterrupt\n0.0 0.002\n"), done.stderr


def test_an_error_of_the_engine_is_not_mistaken_for_an_older_one_of_python(interrupt):
    model = mujoco.MjModel.from_xml_path(str(catalog.models()["hourglass"]))
    data = mujoco.MjData(model)
    buoyancy = Buoyancy(model, Water(), method=buoyancy_mj.Sections())
    interrupt(buoyancy)
    told = pytest.raises(mujoco.FatalError, match="buoyancy_mj: KeyboardInterrupt")
    with told as raised, buoyancy.installed():
        mujoco.mj_forward(model, data)
    assert isinstance(find_cause(raised.value), KeyboardInterrupt)
    assert find_cause("stack overflow") is None


def test_batches_are_stepped_in_blocks_that_change_nothing(tmp_path, monkeypatch):
    rollouts = []
    rollout = mujoco.batch.Batch.rollout

    def counted(self, steps, **rest):
        rollouts[-1].append(steps)
        return rollout(self, steps, **rest)

    monkeypatch.setattr(mujoco.batch.Batch, "rollout", counted)
    rows = []
    for block_time in (0.0, 1e9):
        rollouts.append([])
        monkeypatch.setattr(batches, "BLOCK_TIME", block_time)
        monkeypatch.setattr(batches, "PATIENCE", 0.0)
        # one of them diverges
        plan = Sweep(
            STILL, ("duration=0.4",), ("start.velocity.0",), ((0.0,), (1e150,), (1.0,)),
            tmp_path / f"{block_time}.csv",
        )  # fmt: skip
        rows.append(sorted(plan.run(), key=lambda row: row["run"]))
    assert rollouts == [[1] * 40, [1, 2, 4, 8, 16, 9]]
    assert rows[0] == rows[1]
    assert [row["status"] for row in rows[0]] == ["done", "failed", "done"]
    assert "diverged at 0.01 s" in rows[0][1]["reason"]


def test_a_run_that_diverges_in_its_last_step_has_failed(tmp_path):
    plan = Sweep(STILL, ("duration=0.01",), ("start.velocity.0",), ((1e11,),), tmp_path / "x.csv")
    (row,) = plan.run()
    assert row["status"] == "failed"


def test_signals_that_are_ignored_stay_ignored():
    before = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        with raise_signals():
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)


def test_handlers_are_put_back():
    before = [signal.getsignal(number) for number in SIGNALS]
    CliRunner().invoke(app, ["list"])
    assert [signal.getsignal(number) for number in SIGNALS] == before


def test_commands_run_in_other_threads_too():
    results = []
    thread = threading.Thread(target=lambda: results.append(CliRunner().invoke(app, ["list"])))
    thread.start()
    thread.join()
    assert results[0].exit_code == 0


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_signal_that_comes_where_python_cannot_raise_still_ends_the_command():
    class Finalized:
        def __del__(self):
            signal.raise_signal(signal.SIGTERM)

    finished = []

    @raise_signals()
    def work():
        Finalized()
        finished.append(True)

    with pytest.raises(Stop, match="SIGTERM"):
        work()
    assert finished


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", str(STILL), "--no-record"],
        ["sweep", str(STILL), "--over", "mass=9:10:100", "--duration", "0.05", "--out", "x.csv"],
    ],
    ids=lambda arguments: arguments[0],
)
def test_a_signal_that_other_code_catches_still_ends_the_command(here, monkeypatch, arguments):
    def deaf(scene, **options):
        with contextlib.suppress(BaseException):
            signal.raise_signal(signal.SIGTERM)
        made.append(scene)
        return Simulation(scene, **options)

    made = []
    monkeypatch.setattr("buoyancy_mj.cli.runs.Simulation", deaf)
    monkeypatch.setattr(variations, "Simulation", deaf)
    monkeypatch.setattr(places, "BATCH_SIZE", 1)
    assert here(*arguments).exit_code == 143
    assert len(made) == 1


def test_a_signal_that_must_not_be_raised_here_is_raised_in_a_moment():
    @raise_signals()
    def work():
        raise_later(Stop(signal.SIGTERM))
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            time.sleep(0.01)

    with pytest.raises(Stop, match="SIGTERM"):
        work()


START = """
import signal, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {name!r}:
            signal.raise_signal(signal.SIGINT)
sys.meta_path.insert(0, Finder())
from buoyancy_mj.cli import app
from buoyancy_mj.cli.console import quote_path
app()
"""


@pytest.mark.parametrize("name", ["numba", "mujoco"])
def test_ctrl_c_during_an_import_is_quiet(tmp_path, name):
    command = tmp_path / "buoyancy-mj"
    command.write_text(START.format(name=name))
    done = run_python(command, "list")
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


SWEEP = """
import sys
from mujoco import batch
from buoyancy_mj.cli import app
from buoyancy_mj.cli.console import quote_path
rollout, calls = batch.Batch.rollout, []
def told(self, *arguments, **options):
    calls.append(1)
    if len(calls) == 5:
        print("stepping", flush=True)
    return rollout(self, *arguments, **options)
batch.Batch.rollout = told
app(sys.argv[1:])
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    "number",
    # that SIGTERM ends a sweep is tested without a process too, above
    [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)],
)
def test_a_sweep_stops_while_it_steps(tmp_path, number):
    # stepping alone would take minutes
    arguments = ["sweep", STILL, "--over", "mass=9:10:64", "--duration", "100000"]
    process = subprocess.Popen(
        [sys.executable, "-c", SWEEP, *arguments, "--set", "timestep=0.5", "--out", "rows.csv"],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        # what is started in the background ignores it
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    try:
        assert process.stdout.readline() == "stepping\n"
        process.send_signal(number)
        _, told = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == 128 + number
    assert told == "0 of 64 runs are done; the same command does the rest\n"
    assert list(tmp_path.iterdir()) == []


# the working folder -------------------------------------------------------------------------------

MODULES = (
    "csv", "ctypes", "email", "enum", "glfw", "importlib_metadata", "json", "llvmlite",
    "manifold3d", "matplotlib", "mujoco", "networkx", "numba", "numpy", "pyarrow", "random",
    "rerun", "rerun_bindings", "rerun_cli", "rich", "scipy", "shellingham", "signal", "subprocess",
    "tempfile", "trimesh", "typer", "uuid",
)  # fmt: skip


@pytest.fixture
def hostile(tmp_path):
    """A folder with files named as modules that are imported; each leaves a file when it is run."""
    for name in MODULES:
        text = f"open({str(tmp_path / name)!r}, 'w').close()\nraise ImportError('hostile')\n"
        (tmp_path / f"{name}.py").write_text(text)
    # where Numba would look for compiled kernels, and what lies there is run
    (tmp_path / ".numba_config.yaml").write_text("cache_dir: kernels\n")
    return tmp_path


def executed(folder):
    return [name for name in (*MODULES, "kernels") if (folder / name).exists()]


@pytest.mark.parametrize(
    "arguments",
    [
        pytest.param(["--version"], marks=pytest.mark.long),
        pytest.param(["list"], marks=pytest.mark.slow),
        pytest.param(
            ["run", "hourglass_drop_still", "--duration", "0.05", "--record", "x.rrd"],
            # the next test runs it too
            marks=pytest.mark.long,
        ),
        pytest.param(
            ["inspect", "hourglass", "--record", "x.rrd", "--plot", "."], marks=pytest.mark.slow
        ),
        pytest.param(
            ["sweep", "hourglass_drop_still", "--over", "mass=9:10:2", "--duration", "0.05"]
            + ["--out", "x.parquet"],
            marks=pytest.mark.long,
        ),
        pytest.param(["ballast", "hourglass", "--draft", "0.3"], marks=pytest.mark.long),
        pytest.param(
            ["validate", "--only", "small_sphere", "--out", "here"], marks=pytest.mark.long
        ),
    ],
    ids=lambda arguments: arguments[0],
)
def test_no_module_comes_from_the_working_folder(hostile, arguments):
    # both spellings of the option
    module = ["-mbuoyancy_mj"] if arguments == ["list"] else ["-m", "buoyancy_mj"]
    done = run_python(*module, *arguments, cwd=hostile)
    assert executed(hostile) == []
    assert "Traceback" not in done.stderr
    if "--record" in arguments:
        # with its footer, which a process of its own adds
        assert b"FOOT" in (hostile / "x.rrd").read_bytes()[-32:]


@pytest.mark.slow
def test_an_empty_part_of_the_path_is_not_the_working_folder(hostile):
    parts = os.pathsep.join(["", os.environ.get("PYTHONPATH", "/nowhere")])
    done = run_python(
        "-m", "buoyancy_mj", *["run", "hourglass_drop_still", "--duration", "0.05"],
        *["--record", "x.rrd"], cwd=hostile, env=os.environ | {"PYTHONPATH": parts},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert executed(hostile) == []
    assert b"FOOT" in (hostile / "x.rrd").read_bytes()[-32:]


@pytest.mark.slow
def test_a_program_of_the_user_keeps_its_working_folder(tmp_path):
    package = tmp_path / "mine"
    package.mkdir()
    (package / "__init__.py").write_text("import buoyancy_mj\n")
    (package / "__main__.py").write_text("import mine.helper\nprint(mine.helper.HERE)\n")
    (package / "helper.py").write_text("import beside\nHERE = beside.HERE\n")
    (tmp_path / "beside.py").write_text("HERE = 'here'\n")
    done = run_python("-m", "mine", cwd=tmp_path)
    assert done.stdout == "here\n", done.stderr


# homes and caches ---------------------------------------------------------------------------------


@pytest.mark.long
@pytest.mark.slow
def test_without_a_folder_for_compiled_kernels_they_lie_among_temporary_files(tmp_path):
    # files in place of folders, for a superuser may write to whatever is read-only
    package = Path(buoyancy_mj.__file__).parent
    copy = tmp_path / "installed" / "buoyancy_mj"
    shutil.copytree(package, copy, ignore=shutil.ignore_patterns("__pycache__", "shipped"))
    for blocked in ("kernels/__pycache__", "kernels/entries/__pycache__"):
        (copy / blocked).write_text("")
    (tmp_path / "home").write_text("")
    (tmp_path / "temporary").mkdir()
    environment = {
        key: value
        for key, value in os.environ.items()
        if key not in ("XDG_CACHE_HOME", "NUMBA_CACHE_DIR")
    }
    environment |= {
        "HOME": str(tmp_path / "home"), "TMPDIR": str(tmp_path / "temporary"),
        "PYTHONPATH": str(copy.parent), "PYTHONDONTWRITEBYTECODE": "1",
    }  # fmt: skip
    code = "import buoyancy_mj as b; b.Water().elevation(0.0, 0.0, 0.0); print(b.__file__)"
    done = run_python("-P", "-c", code, env=environment)
    assert done.stdout == f"{copy / '__init__.py'}\n", done.stderr
    kept = tmp_path / "temporary" / f"buoyancy_mj-{os.getuid()}"
    assert (
        f"BuoyancyWarning: compiled kernels are kept in '{kept}', since neither the folder of this "
        f"package nor '{tmp_path / 'home' / '.cache' / 'numba'}' can be written to; "
        "NUMBA_CACHE_DIR names another place"
    ) in done.stderr
    assert list(kept.glob("*/*.nbi"))
    assert kept.stat().st_mode & 0o077 == 0


def test_a_folder_of_somebody_else_is_not_trusted(tmp_path, monkeypatch):
    from buoyancy_mj.kernels import caches

    folder = tmp_path / "shared"
    folder.mkdir(mode=0o700)
    monkeypatch.setattr(caches, "_temporary_folder", lambda: folder)
    monkeypatch.setattr(caches, "NOTICES", [])
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    caches._own_folder.cache_clear()
    assert caches._own_folder() == folder
    folder.chmod(0o777)
    caches._own_folder.cache_clear()
    assert caches._own_folder().parent == tmp_path
    assert caches._own_folder() != folder
    caches._own_folder.cache_clear()


def test_two_installations_keep_their_kernels_apart():
    from buoyancy_mj.kernels.caches import list_caches

    one, other = (list_caches(Path(f"/opt/{place}/buoyancy_mj/kernels/tree.py")) for place in "ab")
    assert not set(one) & set(other)


# what is full -------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs a file that is always full")
def test_a_full_standard_output_is_one_sentence():
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "buoyancy_mj", "list"],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False, timeout=300,
        )  # fmt: skip
    assert done.returncode == 1
    assert done.stderr == "error: the output cannot be read or written: No space left on device\n"


def test_memory_that_runs_out_is_one_sentence(monkeypatch):
    def too_much(*_, **__):
        raise MemoryError

    monkeypatch.setattr("buoyancy_mj.cli.runs.Simulation", too_much)
    result = CliRunner().invoke(app, ["run", str(STILL), "--no-record"])
    assert result.exit_code == 1
    assert result.stderr == (
        "error: the memory ran out; ask for less at once, or for a shorter run\n"
    )


# what is there stays ------------------------------------------------------------------------------


def test_a_file_is_replaced_as_a_whole_or_not_at_all(tmp_path):
    path = tmp_path / "file.txt"
    path.write_text("old")
    path.chmod(0o640)

    def write_half():
        with replace_file(path) as part:
            part.write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        write_half()
    assert path.read_text() == "old"
    with replace_file(path) as part:
        part.write_text("new")
        assert path.read_text() == "old"
    assert path.read_text() == "new"
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_that_was_asked_for_stays_a_link(tmp_path):
    (tmp_path / "file").write_text("old")
    (tmp_path / "link").symlink_to("file")
    with replace_file(tmp_path / "link") as part:
        part.write_text("new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text() == "new"


def test_what_is_no_file_is_written_where_it_is():
    with replace_file(Path(os.devnull)) as part:
        assert part == Path(os.devnull)


def test_partial_files_take_names_that_nobody_has(tmp_path):
    (tmp_path / "target").write_text("precious")
    (tmp_path / "run.partial.rrd").symlink_to("target")
    (tmp_path / "run.partial-2.rrd").write_text("precious")
    descriptor, partial = open_partial(tmp_path / "run.rrd")
    assert partial.name == "run.partial-3.rrd"
    os.write(descriptor, b"mine")
    with pytest.raises(BlockingIOError) as refused:
        open_partial(tmp_path / "run.rrd")
    assert refused.value.filename == str(partial)
    os.close(descriptor)
    assert (tmp_path / "target").read_text() == "precious"
    assert (tmp_path / "run.partial-2.rrd").read_text() == "precious"


@pytest.mark.long
@pytest.mark.slow
def test_plots_replace_their_own_files_only(here, tmp_path):
    for name in ("report.md", "hourglass_curves.png"):
        (tmp_path / name).write_text("precious")
        result = here("inspect", "hourglass", "--plot", ".")
        assert result.exit_code == 1
        assert result.stderr == (
            f"error: cannot write '{name}': there is a file which was not made here; "
            "choose another folder (--plot)\n"
        )
        assert (tmp_path / name).read_text() == "precious"
        (tmp_path / name).unlink()
    for _ in range(2):
        assert here("inspect", "hourglass", "--plot", "plots").exit_code == 0


def test_a_page_of_somebody_else_is_not_replaced(here, tmp_path):
    for page in ("validation.md", "README.md"):
        (tmp_path / page).write_text("precious")
    for command, page in (("validate", "validation.md"), ("paper", "README.md")):
        result = here(command, "--out", ".")
        assert result.exit_code == 1
        assert "there is a file which was not made here" in result.stderr
        assert (tmp_path / page).read_text() == "precious"


@pytest.mark.parametrize(
    ("path", "quoted"),
    [
        ("a.rrd", "a.rrd"),
        ("my boat.rrd", "'my boat.rrd'"),
        ("it's.rrd", "'it'\"'\"'s.rrd'"),
        ("-x.rrd", "./-x.rrd"),
        ("$(rm x).rrd", "'$(rm x).rrd'"),
        (":boat:.rrd", ":boat:.rrd"),
    ],
)
def test_paths_in_printed_commands_are_what_a_shell_reads_back(path, quoted):
    assert quote_path(Path(path)) == quoted


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "auv_waves", "--record", "a\nb.rrd"],
        ["sweep", "auv_waves", "--over", "mass=20:21:2", "--out", "a\rb.csv"],
        ["inspect", "hourglass", "--plot", "a\x1bb"],
        ["inspect", "hourglass", "--repair", "a\tb.xml"],
        ["ballast", "hourglass", "--draft", "0.3", "--out", "a\nb.xml"],
        ["validate", "--out", "a\nb"],
        ["paper", "--out", "a\nb"],
    ],
    ids=lambda arguments: arguments[0] + arguments[-2],
)
def test_a_name_that_cannot_be_printed_is_refused(here, tmp_path, arguments):
    result = here(*arguments)
    assert result.exit_code == 1
    assert result.stderr == (
        f"error: {arguments[-2]} is {arguments[-1]!r}; it must be one line, "
        f"without the control character {arguments[-1][1]!r}\n"
    )
    assert list(tmp_path.iterdir()) == []


def test_a_recording_whose_name_begins_with_a_dash_gets_its_footer(here, tmp_path):
    result = here("run", STILL, "--duration", "0.05", "--record=-x.rrd")
    assert result.exit_code == 0
    assert result.stdout.replace("\n", "").endswith(" ./-x.rrd")
    assert [path.name for path in tmp_path.iterdir()] == ["-x.rrd"]
    assert b"FOOT" in (tmp_path / "-x.rrd").read_bytes()[-32:]

"""Whatever TOML, a shell or a plugin's config can carry gets one sentence that names its key."""

import dataclasses
import errno
import importlib
import inspect
import itertools
import os
import re
import subprocess
import sys
import typing
from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from buoyancy_mj import (
    CurrentProfile,
    CurrentSeries,
    JonswapSea,
    LevelOscillation,
    PiersonMoskowitzSea,
    RegularWave,
    SceneError,
    Start,
    SweepError,
    Water,
    WaterError,
    read_scene,
)
from buoyancy_mj.cli import app
from buoyancy_mj.cli.flags import flag_of
from buoyancy_mj.cli.group import MODULES
from buoyancy_mj.errors import BuoyancyError, describe
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.loads.damping import VISCOUS
from buoyancy_mj.scenes import ranges
from buoyancy_mj.scenes.controls import CONTROLS
from buoyancy_mj.scenes.scene import KEYS, Scene
from buoyancy_mj.scenes.scene_vehicle import SceneVehicle
from buoyancy_mj.settings.config import KEYS as PLUGIN_KEYS
from buoyancy_mj.settings.config import parse_plugin_config
from buoyancy_mj.settings.toml import CURRENTS, WAVES
from buoyancy_mj.submersion.methods import METHODS
from buoyancy_mj.values import read_array

DEEP = "[" * 1000 + "]" * 1000
DIGITS = "9" * 5000
"""More than Python reads."""
BEYOND = "9" * 400
"""Beyond what a float holds."""
WORDLESS = {
    "huge": BEYOND,
    "hex": "0x" + "f" * 5000,
    "digits": DIGITS,
    "deep": DEEP,
    "list": "[]",
    "lists": "[[[1.0]]]",
    "table": "{}",
    "date": "1979-05-27",
    "time": "1979-05-27T07:32:00Z",
}
"""Values of TOML that are neither numbers that count, nor truths, nor texts."""
TEXTS = {
    "empty": '""',
    "NUL": r'"a\u0000b"',
    "line break": r'"a\nb"',
    "escape": r'"\u001b[31m"',
    "words": '"a b"',
}
NUMBERS = {"nan": "nan", "bool": "true", "number": "1.5", "negative": "-7.25"}
BAD = {
    float: WORDLESS | TEXTS | {name: NUMBERS[name] for name in ("nan", "bool")},
    int: WORDLESS | TEXTS | NUMBERS,
    bool: WORDLESS | TEXTS | {name: NUMBERS[name] for name in ("nan", "number")},
    str: WORDLESS | NUMBERS | {name: TEXTS[name] for name in ("NUL", "line break", "escape")},
    tuple: WORDLESS | TEXTS | NUMBERS | {"mixed": '[1.0, "x"]', "nan in it": "[0.0, nan, 0.0]"},
}
"""Bad values by the type of the key."""
NEEDED = {
    "amplitude": "0.1",
    "frequency": "0.5",
    "significant_height": "0.1",
    "peak_period": "3.0",
    "depths": "[0.0]",
    "times": "[0.0]",
    "velocities": "[[0.0, 0.0, 0.0]]",
    "file": '"x.py:f"',
    "period": "3.0",
}
"""Good values of keys that have no default."""


def types_of(cls):
    """The plain type of each field of a dataclass that is a key of TOML."""
    for name, hint in typing.get_type_hints(cls).items():
        options = [hint, *typing.get_args(hint)]
        kinds = [typing.get_origin(option) or option for option in options]
        kind = next((kind for kind in kinds if kind in BAD), None)
        if kind is not None and name in {field.name for field in dataclasses.fields(cls)}:
            yield name, kind


def table_of(path, kind, cls):
    """Each key of a table of a kind, its type, and the table with a hole for its value."""
    needed = {
        field.name: NEEDED[field.name]
        for field in dataclasses.fields(cls)
        if field.default is field.default_factory is dataclasses.MISSING
    }
    # a list that may be empty is refused elsewhere
    lists = {field.name for field in dataclasses.fields(cls) if field.default == ()}
    for name, plain in types_of(cls):
        if name in lists:
            continue
        rest = "".join(f", {key}={value}" for key, value in needed.items() if key != name)
        yield f"{path}.{name}", plain, f'{path}={{kind="{kind}"{rest}, {name}=%s}}'


def keys_of_scene():
    """Each key of a scene, its type, and a setting with a hole for its value."""
    # plain keys, of the scene and of tables that have no kinds
    for cls, path in ((Scene, ""), (Start, "start."), (Water, "water.")):
        for name, kind in types_of(cls):
            if path or name in {*KEYS} - {"vehicles", "control"}:
                yield path + name, kind, f"{path}{name}=%s"
    for name in ("geoms", "hull", "fill"):
        yield name, tuple, f"{name}=%s"
    for name, kind in types_of(SceneVehicle):
        model = "" if name == "model" else 'model="hourglass", '
        yield f"vehicles.{name}", kind, f"vehicles=[{{{model}{name}=%s}}]"
    for name, kind in types_of(CoefficientsFile):
        rest = "".join(f", {key}={NEEDED[key]}" for key in ("file", "period") if key != name)
        yield f"coefficients.{name}", kind, f"coefficients={{{name}=%s{rest}}}"

    # keys of tables of a kind
    tables = (
        ("method", METHODS),
        ("damping", VISCOUS),
        ("water.current", CURRENTS),
        ("control", CONTROLS),
    )
    for path, classes in (*tables, ("wave", WAVES)):
        for kind, cls in classes.items():
            for key, plain, text in table_of(path, kind, cls) if cls else ():
                is_wave = path == "wave"
                yield key, plain, f"water.waves=[{text.removeprefix('wave=')}]" if is_wave else text


SCENE_KEYS = tuple(keys_of_scene())


def check_sentence(message, *words):
    """One line, not too long, and in it one of the words."""
    assert "\n" not in message
    assert len(message) < 1000, message
    assert any(word in message for word in words), message


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text('title = "A box"\nvehicle = "hourglass"\n')
    return path


def test_more_than_a_thousand_are_tried():
    assert sum(len(BAD[kind]) for _, kind, _ in SCENE_KEYS) > 1000


@pytest.mark.parametrize(
    ("key", "kind", "setting"),
    SCENE_KEYS,
    ids=[f"{key}-{i}" for i, (key, *_) in enumerate(SCENE_KEYS)],
)
def test_bad_values_of_a_key_are_refused_by_name(scene, key, kind, setting):
    for value in BAD[kind].values():
        with pytest.raises(SceneError) as refusal:
            read_scene(scene, [setting % value])
        # what Python cannot read is named by the setting, all else by the key
        check_sentence(
            str(refusal.value), key.rpartition(".")[2], setting.partition("=")[0] + " is"
        )


@pytest.mark.parametrize(
    "setting",
    [
        "water=%s", "water.waves=%s", "water.waves=[%s]", "water.current=%s", "start=%s",
        "method=%s", "method={kind=%s}", "damping=%s", "damping={kind=%s}", "coefficients=%s",
        "vehicles=%s", "vehicles=[%s]",
        "water.waves=[{kind=%s}]", "water.current={kind=%s}",
    ],
)  # fmt: skip
def test_bad_tables_are_refused_by_name(scene, setting):
    # an empty table is one, and so is a list of no waves; true is damping
    sound = {"{}", "[]", "true"} if setting != "vehicles=[%s]" else set()
    for value in (WORDLESS | TEXTS | NUMBERS).values():
        if value in sound or (setting == "method={kind=%s}" and value == '"exact"'):
            continue
        with pytest.raises(SceneError) as refusal:
            read_scene(scene, [setting % value])
        check_sentence(str(refusal.value), *re.findall(r"\w+", setting.replace("kind=%s", "kind")))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"duration = {DIGITS}", "a number in it has too many digits, near line 3, which begins "),
        (f"duration = {DEEP}", "its lists or tables lie too deep in one another, near line 3"),
        (f"duration = {BEYOND}", "duration is a whole number of about 400 digits; needed is"),
        ('title = "x"', "is no valid TOML: Cannot overwrite a value (at line 3"),
        ("drag = false", "unknown key 'drag'; it is 'damping' now; possible: added_mass"),
        (r'"dra\u0000g" = 1', r"unknown key 'dra\x00g'; possible: added_mass"),
        ("duration = 1979-13-41", "is no valid TOML: Expected newline"),
        ("duration = 1979-02-30", "is no valid TOML: Invalid date"),
        ("\x00", "is no valid TOML: "),
        ("x" * 10_000 + " = 1", "unknown key 'xxxxxxxxxx"),
        ("geoms = []", "geoms is [], which chooses nothing; give patterns such as 'hull*'"),
        ('hull = ["", " "]', "hull is ['', ' '], which chooses nothing; give patterns such as"),
    ],
)
def test_a_file_that_cannot_be_read_is_refused_with_the_line(scene, text, message):
    scene.write_text(f"{scene.read_text()}{text}\n")
    with pytest.raises(SceneError, match=re.escape(message)) as refusal:
        read_scene(scene)
    check_sentence(str(refusal.value), "scene 'scene'", str(scene))


def test_a_file_that_is_not_in_unicode_is_refused(scene):
    scene.write_bytes(b'title = "\xff"\n')
    with pytest.raises(SceneError, match=r"cannot read scene '.*scene.toml': 'utf-8' codec"):
        read_scene(scene)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("duration=1\ntitle=x", r"duration is '1\ntitle=x'; it must be one line, without the cont"),
        ("dura\ntion=1", r"the key of a setting is 'dura\ntion'; it must be one line"),
        ("title=a\udcff", r"title is 'a\udcff'; it must be a text in UTF-8"),
        ("title=\x1b[31m", r"title is '\x1b[31m'; it must be one line, without the control charac"),
        ("title=a\0b", r"title is 'a\x00b'; it must be one line"),
        (f"duration={DIGITS}", "duration is '99999999999"),
        (f"water.waves.{DIGITS}.phase=1", "cannot set 'water.waves.9999"),
        (f"start.position.{DIGITS}=1", "cannot set 'start.position.9999"),
        ("start.position.-1=1", "the list has 3 entries, counted from 0"),
        ("start.position.00=1", "the list has 3 entries, counted from 0"),
        (".".join("a" * 5000) + "=1", "unknown key 'a'; possible: added_mass"),
        ("=1", "'=1' is no setting; write KEY=VALUE, for example duration=3"),
        ("", "'' is no setting; write KEY=VALUE, for example duration=3"),
    ],
)
def test_settings_that_a_shell_can_carry_are_refused_by_name(scene, setting, message):
    with pytest.raises(SceneError, match=re.escape(message)):
        read_scene(scene, ["water.waves=[]", setting])


@pytest.mark.parametrize("key", PLUGIN_KEYS)
def test_bad_texts_of_the_plugin_are_refused_by_name(key):
    texts = [
        "nan", "inf", "-1", "1979-05-27", BEYOND, DIGITS, "0x" + "f" * 5000, DEEP, "{}", "[[1]]",
        "regular amplitude=1 amplitude=1", "a b c", "=1", "x=1", f"exact tolerance={BEYOND}",
        f"silhouette coefficient={DIGITS}", f"regular amplitude={DEEP} period=3",
        "profile depths=[", "a\0b", "1\n2", "\x1b",
    ]  # fmt: skip
    chosen = key in ("geoms", "hull", "fill")
    for text in ["\x1b", ", ,"] if chosen else texts:
        sound = {"level": ["-1"], "damping": ["{}"]}
        if text in sound.get(key, []):
            continue
        with pytest.raises(BuoyancyError) as refusal:
            parse_plugin_config({key: text}, "plugin")
        check_sentence(str(refusal.value), key.replace("_", " "), key)


# the command line


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return lambda arguments: CliRunner().invoke(app, arguments)


COMMANDS = {
    "run": ["run", "hourglass_drop_still", "--no-record"],
    "view": ["view", "hourglass_drop_still"],
    "inspect": ["inspect", "hourglass"],
    "ballast": ["ballast", "hourglass", "--reserve", "0"],
    "sweep": ["sweep", "hourglass_drop_still", "--over", "mass=1:2:2", "--out", "out.csv"],
    "sitl": ["sitl", "bluerov2_heavy_dive", "--port", "0", "--timeout", "0.1"],
    "respond": ["respond", "hourglass", "--periods", "4"],
    "decay": ["decay", "hourglass"],
    "paper": ["paper"],
    "validate": ["validate"],
    "list": ["list"],
}
"""A command of each kind that would run."""
LINES = ("a\0b", "a\nb", "a\udcffb", "\x1b[31m", "\x7f")
"""Texts that are not one line of Unicode."""


class Flag(typing.NamedTuple):
    """A flag of a command, or its argument."""

    command: str
    name: str
    """'--set', or 'SCENE' for an argument."""
    kind: type
    """Of one value."""
    count: int
    """How many values it takes at once."""

    def given(self, value):
        """Arguments of the command with a value for this flag."""
        if not self.name.startswith("--"):
            return [self.command, value, *COMMANDS[self.command][2:]]
        return [*COMMANDS[self.command], self.name, *[value] * self.count]


def find_flags():
    """All flags of all commands that take values."""
    for module in sorted(set(MODULES.values())):
        importlib.import_module(f"buoyancy_mj.cli.{module}")
    for info in app.registered_commands:
        command = info.name or info.callback.__name__
        for parameter in inspect.signature(info.callback).parameters.values():
            kinds = [*parts_of(typing.get_args(parameter.annotation)[0])]
            plain = [kind for kind in kinds if kind in (str, Path, int, float)]
            if plain:
                yield Flag(command, flag_of(parameter), plain[0], len(plain))


def parts_of(hint):
    """A type, and all types in it."""
    yield hint
    for part in typing.get_args(hint):
        yield from parts_of(part)


FLAGS = [*find_flags()]


def name_of(value):
    return f"{value.command}-{value.name}" if isinstance(value, Flag) else None


def check_refused(result, *words):
    assert result.exit_code in (1, 2), result.output
    assert isinstance(result.exception, SystemExit), result.exception
    if result.exit_code == 1:
        assert result.stderr.startswith("error: ")
        check_sentence(result.stderr.rstrip("\n"), *words)
    else:
        assert any(word in result.stderr for word in words), result.stderr


def test_every_command_is_tried():
    assert set(COMMANDS) == {flag.command for flag in FLAGS} | {"list"}
    assert len(FLAGS) > 50
    assert {flag.kind for flag in FLAGS} == {str, Path, int, float}


@pytest.mark.parametrize("flag", [flag for flag in FLAGS if flag.kind in (str, Path)], ids=name_of)
def test_texts_that_are_no_line_of_unicode_are_refused_by_the_flag(run, tmp_path, flag):
    for text in LINES:
        # Typer itself sees that no file has a NUL in its name
        is_usage = flag.kind is Path and "\0" in text
        check_refused(run(flag.given(text)), f"'{flag.name}'" if is_usage else f"{flag.name} is ")
    if flag.kind is Path:
        check_refused(run(flag.given("x" * 300)), f"{flag.name} is 'xxxxxxxxx")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("flag", [flag for flag in FLAGS if flag.kind in (int, float)], ids=name_of)
def test_numbers_that_are_none_are_refused_by_the_flag(run, tmp_path, flag):
    for text in ("", "x", "nan", "inf", "-inf", "1e400", BEYOND, DIGITS, "0x10", "1\n2", "\udcff"):
        # a seed may have as many digits as Python reads
        if (flag.name, text) != ("--seed", BEYOND):
            check_refused(run(flag.given(text)), flag.name, flag.name.removeprefix("--"))
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("sweep a --over mass=1:2:2 --seed -1 --out a.csv", "--seed"),
        ("sweep a --over mass=1:2:2 --threads 1000000 --out a.csv", "--threads"),
        ("sweep a --over mass=1:2 --draws 0 --out a.csv", "--draws"),
        ("sweep a --over mass=-1e308:1e308:5 --out a.csv", "--over is 'mass=-1e308:1e308:5'"),
        ("sweep a --over mass=nan:1:5 --out a.csv", "--over is 'mass=nan:1:5'; it must be KEY"),
        ("sweep a --over mass=0:1:1e3 --out a.csv", "--over is 'mass=0:1:1e3'; it must be KEY"),
        (f"sweep a --over mass=0:1:{DIGITS} --out a.csv", "--over is 'mass=0:1:999"),
        (
            "sweep a --over mass=0:1:1000000000 --out a.csv",
            "the sweep would have 1000000000 runs; it may have 1000000 at most",
        ),
        (
            "sweep a --over mass=0:1:100000 --over start.roll=0:1:100000 --out a.csv",
            "the sweep would have 10000000000 runs; it may have 1000000 at most",
        ),
        (
            "sweep a --over mass=0:1 --draws 1000000000 --out a.csv",
            "the sweep would have 1000000000 runs; it may have 1000000 at most",
        ),
        (
            "sweep a --over mass=0:1:4 --draws 3 --out a.csv",
            "--over mass=0:1:4 has a number of values, which --draws does not use; leave out ':4'",
        ),
        ("sweep a --over hull=0:0.3:3 --out a.csv", "hull is 0.0; needed is a list of words"),
        ("sweep a --over damping=0:1:2 --out a.csv", "damping is 0.0; needed is true, false"),
        ("sweep a --over title=0:1:2 --out a.csv", "title is 0.0; needed is a text in quotes"),
        ("sweep a --over start=0:1:2 --out a.csv", "start is 0.0; needed is a table"),
        ("sweep a --over start.position.3=0:1:2 --out a.csv", "the list has 3 entries, counted"),
        ("sweep a --over nix=0:1:2 --out a.csv", "unknown key 'nix'; possible: added_mass"),
        (
            "sweep a --over mass=1:2:2 --geoms nix --out a.csv",
            "all 2 runs failed; the first: no mo",
        ),
        ("inspect hourglass --water waves=[]", "--water: unknown key 'waves'; possible: density"),
        ("inspect hourglass --water=", "--water '' says nothing; write KEY=VALUE, as in density"),
        ("inspect hourglass --water density", "write KEY=VALUE, as in density=1025"),
        (f"inspect hourglass --water level={DIGITS}", "a number in it has too many digits"),
        (
            "ballast hourglass --reserve 0 --box 1e308 1e308 1e308 1e308 1e308 1e308",
            "it must be its lowest and highest corner (2, 3) [m], within 1e+06 m",
        ),
        ("run nix:b:.toml", "there is no scene 'nix:b:.toml', neither a file nor one that ships"),
        (f"run {'x' * 300}.toml", "there is no scene 'xxxxxxxxxx"),
    ],
)
def test_bad_arguments_get_one_sentence_and_leave_nothing(run, tmp_path, arguments, message):
    words = arguments.replace("sweep a ", "sweep hourglass_drop_still ").split(" ")
    result = run([*words, *(["--duration", "0.02"] if words[0] == "sweep" else [])])
    check_refused(result, message)
    assert not [path for path in tmp_path.iterdir() if path.stat().st_size == 0]


# full disks


def test_a_full_disk_under_a_sweep_keeps_the_rows_and_the_sweep_goes_on(run, tmp_path):
    over = ["sweep", "hourglass_drop_still", "--over", "mass=1:2:3", "--duration", "0.02"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", fail_after(2, os.fsync))
        result = run([*over, "--out", "rows.csv"])
    check_refused(
        result,
        "cannot write to 'rows.csv': No space left on device; 'rows.csv' holds 1 row, and the same",
    )
    assert (tmp_path / "rows.csv").read_text().count("done") >= 1
    assert run([*over, "--out", "rows.csv"]).exit_code == 0
    assert (tmp_path / "rows.csv").read_text().count("done") == 3


def test_a_full_disk_under_a_table_of_parquet_keeps_the_rows(run, tmp_path):
    over = ["sweep", "hourglass_drop_still", "--over", "mass=1:2:3", "--duration", "0.02"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pyarrow.parquet, "write_table", fail_after(0, pyarrow.parquet.write_table))
        result = run([*over, "--out", "rows.parquet"])
    check_refused(result, "cannot write 'rows.parquet': [Errno 28] No space left on device")
    assert run([*over, "--out", "rows.parquet"]).exit_code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["rows.parquet"]


def fail_after(count, function):
    """A function that a disk lets succeed so many times."""
    calls = itertools.count()

    def limited(*arguments, **options):
        if next(calls) >= count:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return function(*arguments, **options)

    return limited


def test_results_do_not_go_to_a_device(run, tmp_path):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    result = run(["sweep", "hourglass_drop_still", "--over", "mass=1:2:2", "--out", "full.csv"])
    check_refused(
        result, "cannot keep results in 'full.csv': it is no regular file; give another --out"
    )


def test_results_that_are_none_are_refused(run, tmp_path):
    over = ["sweep", "hourglass_drop_still", "--over", "mass=1:2:2", "--duration", "0.02"]
    assert run([*over, "--out", "rows.csv"]).exit_code == 0
    whole = (tmp_path / "rows.csv").read_text()
    header, first, *_ = whole.splitlines(keepends=True)
    digest = first.split(",")[1]
    for rows in (f"one,{digest}\n", f"\n,{digest},\0\n", "0\n", b"\xff\n".decode("latin1")):
        (tmp_path / "rows.csv").write_text(header + rows, encoding="latin1")
        check_refused(run([*over, "--out", "rows.csv"]), "rows.csv")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["auv_waves", "--set", "a=1\nb=2"], r"--set is 'a=1\nb=2'; it must be one line"),
        (["auv_waves", "--record", "x" * 300], "--record is 'xxxxxxxxx"),
        (["nix:b:.toml"], "there is no scene 'nix:b:.toml', neither"),
    ],
    ids=["line", "long", "colons"],
)
def test_odd_texts_get_one_sentence(run, tmp_path, arguments, message):
    result = run(["run", *arguments])
    assert result.exit_code == 1
    check_refused(result, message)
    assert not [*tmp_path.iterdir()]


# real processes


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([b"run", b"auv\xff.toml"], r"SCENE is 'auv\udcff.toml'; it must be a text in UTF-8"),
        ([b"run", b"auv_waves", b"--set", b"title=\xc3"], r"--set is 'title=\udcc3'; it must be"),
    ],
)
def test_bytes_that_a_shell_can_carry_get_one_sentence(tmp_path, arguments, message):
    command = [sys.executable, "-m", "buoyancy_mj", *arguments]
    ended = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, errors="replace", check=False
    )
    assert ended.returncode == 1
    *_, last = ended.stderr.splitlines()
    assert last.startswith("error: ")
    check_sentence(last, message)
    assert "Traceback" not in ended.stderr
    assert not [*tmp_path.iterdir()]


@pytest.mark.slow
def test_an_output_without_letters_shows_their_numbers(tmp_path):
    command = "run hourglass_drop_still --no-record --duration 0.02 --set title=\xe9:b:"
    ended = subprocess.run(
        [sys.executable, "-m", "buoyancy_mj", *command.split()],
        cwd=tmp_path, env=os.environ | {"PYTHONIOENCODING": "ascii", "PYTHONUTF8": "1"},
        capture_output=True, check=False,
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.startswith(rb"\xe9:b:")


# python


@pytest.mark.parametrize(
    "value",
    [None, True, "1", b"1", 1j, [1.0], {}, np.array([1.0]), 10**400, 10**5000, float("nan")],
    ids=describe,
)
def test_numbers_from_python_are_refused_by_name(value):
    for make, name in (
        (lambda: Water(density=value), "density"),
        (lambda: Water(level=value), "level"),
        (lambda: RegularWave(value, period=3.0), "amplitude"),
        (lambda: RegularWave(0.1, period=3.0, depth=value), "depth"),
        (lambda: LevelOscillation(0.1, value), "frequency"),
        (lambda: JonswapSea(0.1, 3.0, gamma=value), "gamma"),
        (lambda: JonswapSea(0.1, 3.0, spreading=value), "spreading"),
        (lambda: JonswapSea(0.1, 3.0, seed=value), "seed"),
        (lambda: PiersonMoskowitzSea(value), "significant_height"),
        (lambda: Start(roll=value), "roll"),
        (lambda: Start(position=(value,) * 3), "position"),
        (lambda: Water(current=(value,) * 3), "current"),
        (lambda: CurrentSeries((value,), ((0.0, 0.0, 0.0),)), "times"),
    ):
        with pytest.raises((WaterError, SceneError)) as refusal:
            make()
        check_sentence(str(refusal.value), name)


def test_data_of_another_shape_are_refused_and_never_reshaped():
    water = Water(waves=RegularWave(0.1, period=3.0))
    for points in ((1.0, 2.0), np.zeros((3, 2)), np.zeros(6), 1.0, [[0, 0, 1j]], ["x", "y", "z"]):
        for method in (water.depth, water.velocity, water.acceleration, water.pressure):
            with pytest.raises(WaterError, match=r"points is .*; it must be numbers of shape "):
                method(points, 0.0)
    assert water.velocity(np.zeros((2, 4, 3)), 0.0).shape == (2, 4, 3)
    for position in ((1.0, 2.0), np.zeros((3, 1)), np.zeros((1, 3)), 0.0):
        with pytest.raises(SceneError, match=r"position is .*; it must be numbers of shape \(3,\)"):
            Start(position=position)
    with pytest.raises(WaterError, match=r"it must be numbers of shape \(n, 3\)"):
        CurrentProfile((0.0, 1.0), np.zeros((3, 2)))


def test_an_array_of_numbers_keeps_its_shape():
    for value in (range(3), (1, 2.5, 10**18), np.ones(3, np.float32), np.ones(3, np.int8)):
        assert read_array(WaterError, "x", value, (3,)) == pytest.approx(np.array([*value], float))
    for value in (
        [1, 2],
        [True, False, True],
        [1, 2, None],
        [[1, 2], [3]],
        object(),
        "abc",
        [10**400] * 3,
    ):
        with pytest.raises(WaterError, match=r"x is .*; it must be numbers of shape \(3,\)"):
            read_array(WaterError, "x", value, (3,))


def test_a_long_value_is_shown_short_and_on_one_line():
    nested = []
    for _ in range(5000):
        nested = [nested]
    for value in (nested, "x" * 10**6, 10**10_000, np.zeros((50, 50)), [1.0] * 10**5, "a\nb"):
        text = describe(value)
        assert len(text) < 200
        assert "\n" not in text
    assert describe(1.5) == "1.5"
    assert describe("it's") == '"it\'s"'
    assert describe(-(10**40)) == "a whole number of about 40 digits"


def test_a_sweep_from_python_has_bounds_too():
    one = ranges.FieldRange("mass", 0.0, 1.0, 0)
    for many in (10**7, 10**400):
        with pytest.raises(SweepError, match="it may have 1000000 at most"):
            ranges.draws([one], many, 0)
    with pytest.raises(SweepError, match="--seed is -1; it must be at least 0"):
        ranges.draws([one], 3, -1)

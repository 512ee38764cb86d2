"""Whatever TOML, a shell or a plugin's config can carry gets one sentence that names its key."""

import dataclasses
import itertools
import re
import subprocess
import sys
import typing

import numpy as np
import pytest
import typer
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
from buoyancy_mj.errors import BuoyancyError, describe
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.loads.damping import VISCOUS
from buoyancy_mj.scenes import ranges
from buoyancy_mj.scenes.scene import KEYS, Scene
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
    "file": '"x"',
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
    for name, plain in types_of(cls):
        rest = "".join(f", {key}={value}" for key, value in needed.items() if key != name)
        yield f"{path}.{name}", plain, f'{path}={{kind="{kind}"{rest}, {name}=%s}}'


def keys_of_scene():
    """Each key of a scene, its type, and a setting with a hole for its value."""
    for cls, path in ((Scene, ""), (Start, "start."), (Water, "water.")):
        for name, kind in types_of(cls):
            if path or name in KEYS:
                yield path + name, kind, f"{path}{name}=%s"
    for name in ("geoms", "hull", "fill"):
        yield name, tuple, f"{name}=%s"
    for kind, cls in WAVES.items():
        for key, plain, text in table_of("wave", kind, cls):
            yield key, plain, text.replace("wave={", "water.waves=[{").replace("}", "}]")
    for kind, cls in CURRENTS.items():
        yield from table_of("water.current", kind, cls)
    for kind, cls in METHODS.items():
        yield from table_of("method", kind, cls)
    for kind, cls in VISCOUS.items():
        if cls is not None:
            yield from table_of("damping", kind, cls)
    for name, kind in types_of(CoefficientsFile):
        rest = "".join(f", {key}={NEEDED[key]}" for key in ("file", "period") if key != name)
        yield f"coefficients.{name}", kind, f"coefficients={{{name}=%s{rest}}}"


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

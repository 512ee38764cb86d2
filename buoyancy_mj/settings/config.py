"""Settings as the short texts that MJCF can hold, and back."""

import dataclasses
import math
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from buoyancy_mj.errors import BuoyancyError, MethodError, ModelError, SceneError, WaterError
from buoyancy_mj.loads.damping import VISCOUS, Damping
from buoyancy_mj.sea.currents import Current
from buoyancy_mj.sea.waves import RegularWave, Wave
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.toml import (
    CURRENTS,
    WAVES,
    damping_from_table,
    method_from_table,
    selection_from_table,
    water_from_table,
)
from buoyancy_mj.submersion.methods import METHODS

WATER = ("density", "level", "waves", "current")
"""Keys of the plugin that describe the sea: the fields of `Water`."""
SELECTION = ("geoms", "hull", "fill")
"""Keys that choose geoms: the fields of `Selection`."""
KEYS = (*WATER, "method", "pressure", "damping", "added_mass", *SELECTION)
"""All keys of the plugin."""


def parse_plugin_config(texts: Mapping[str, str], where: str) -> Settings:
    """What texts by the names of `KEYS` describe; empty ones, and missing ones, are defaults.

    A wave is its kind and its fields, 'regular amplitude=0.3 frequency=0.5', several stand between
    semicolons; a current is three numbers, or 'profile depths=[0,5] velocities=[[1,0,0],[0,0,0]]', or
    'series ...'; a method is its name and its options; damping is false, or its kind and its numbers,
    'silhouette coefficient=1.1 radiation=false'.

    Raises:
        SceneError: a text that makes no sense; the message names its key.
    """
    given = {key: text.strip() for key, text in texts.items() if text.strip()}
    sea: dict[str, Any] = {
        key: parse_value(given[key]) for key in ("density", "level") if key in given
    }
    if "current" in given:
        text = given["current"]
        speeds = [parse_value(word) for word in text.replace(",", " ").split()]
        sea["current"] = _words(text, f"{where}: current") if "=" in text else speeds
    if "waves" in given:
        sea["waves"] = [
            _words(wave, f"{where}: waves") for wave in given["waves"].split(";") if wave.strip()
        ]
    damping = given.get("damping", "true")
    words = {key: given[key].replace(",", " ").split() for key in SELECTION if key in given}
    return Settings(
        water=water_from_table(sea, where),
        method=method_from_table(
            _words(given.get("method", "exact"), f"{where}: method"), f"{where}: method"
        ),
        pressure=given.get("pressure", "archimedes"),
        added_mass=given.get("added_mass", "model"),
        damping=damping_from_table(
            _words(damping, f"{where}: damping") if "=" in damping else parse_value(damping),
            f"{where}: damping",
        ),
        selection=selection_from_table(words, where),
    )


def write_plugin_config(settings: Settings) -> dict[str, str]:
    """Texts from which `parse_plugin_config` makes the same settings again, to the last bit.

    Raises:
        WaterError, MethodError, ModelError: a wave, a method or added mass of a kind that has no text.
    """
    water, texts = settings.water, {}
    texts["density"], texts["level"] = repr(float(water.density)), repr(float(water.level))
    texts["current"] = _current_text(water.current)
    assert isinstance(water.waves, Sequence)
    texts["waves"] = "; ".join(_wave_text(wave) for wave in water.waves)
    method = settings.method
    if type(method) not in METHODS.values():
        raise MethodError(
            f"{method!r} cannot be written into a model; possible are {', '.join(METHODS)}"
        )
    texts["method"] = " ".join([method.name, *_fields(method)])
    if isinstance(settings.added_mass, Mapping):
        raise ModelError(
            "added mass by matrices cannot be written into a model; state it there as numerics 'added_mass:BODY'"
        )
    texts["pressure"] = settings.pressure
    texts["added_mass"] = settings.added_mass or "none"
    texts["damping"] = _damping_text(settings.damping)
    texts |= {key: " ".join(getattr(settings.selection, key) or ()) for key in SELECTION}
    return {key: text for key, text in texts.items() if text}


def parse_value(text: str) -> Any:
    """A value of TOML, or a bare word."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text.strip()


def _words(text: str, where: str) -> dict[str, Any]:
    """The table that 'kind key=value key=value' describes; the kind may be missing."""
    kind, *words = text.split() if "=" not in text.split()[0] else ("", *text.split())
    for word in words:
        if "=" not in word:
            raise SceneError(
                f"{where} is '{text.strip()}'; after the kind it must be key=value pairs between blanks, not '{word}'"
            )
    pairs = (word.split("=", 1) for word in words)
    return ({"kind": kind} if kind else {}) | {key: parse_value(value) for key, value in pairs}


def _damping_text(damping: Damping | None) -> str:
    """Damping in words, with all its numbers, which may get other defaults one day."""
    if damping is None:
        return "false"
    viscous = damping.viscous
    (kind,) = (k for k, cls in VISCOUS.items() if (type(viscous) if viscous else None) is cls)
    numbers = _fields(viscous, all_of_them=True) if viscous else []
    return " ".join([kind, *numbers, f"radiation={_toml(damping.radiation)}"])


def _current_text(current: Current) -> str:
    """A current in words."""
    for kind, cls in CURRENTS.items():
        if isinstance(current, cls):
            return " ".join([kind, *_fields(current)])
    assert isinstance(current, tuple)
    return " ".join(repr(float(speed)) for speed in current)


def _wave_text(wave: Wave) -> str:
    """A wave in words, by whichever of its fields give it back to the last bit."""
    kinds = [kind for kind, cls in WAVES.items() if type(wave) is cls]
    if not kinds:
        raise WaterError(
            f"{wave!r} cannot be written into a model; possible are {', '.join(WAVES)}"
        )
    if isinstance(wave, RegularWave):
        others = {
            f.name: getattr(wave, f.name) for f in dataclasses.fields(wave) if f.name not in _SAME
        }
        for name in _SAME:
            try:
                again = RegularWave(**others, **{name: getattr(wave, name)})
            except BuoyancyError:
                continue
            if np.array_equal(again.rows, wave.rows):
                leave = [other for other in _SAME if other != name]
                return " ".join([kinds[0], *_fields(wave, leave)])
    return " ".join([kinds[0], *_fields(wave)])


_SAME = ("frequency", "period", "wavelength")
"""Fields of a regular wave that say the same."""


def _fields(value: Any, leave: Sequence[str] = (), *, all_of_them: bool = False) -> list[str]:
    """The fields of a dataclass that are not at their defaults, as key=value."""
    fields = [field for field in dataclasses.fields(value) if field.name not in leave]
    return [
        f"{field.name}={_toml(getattr(value, field.name))}"
        for field in fields
        if all_of_them or getattr(value, field.name) != field.default
    ]


def _toml(value: Any) -> str:
    """A value without blanks, as `parse_value` reads it."""
    if isinstance(value, bool | str):
        return str(value).lower() if isinstance(value, bool) else value
    if isinstance(value, tuple):
        return f"[{','.join(_toml(item) for item in value)}]"
    number = float(value)
    return (
        str(int(value))
        if isinstance(value, int)
        else ("inf" if math.isinf(number) else repr(number))
    )

"""Water, drag and method as tables of plain values, as TOML has them, and as the short texts that MJCF can hold."""

import dataclasses
import math
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from buoyancy_mj.errors import BuoyancyError, MethodError, SceneError, WaterError, choices
from buoyancy_mj.loads.drag import Drag
from buoyancy_mj.sea.currents import Current, CurrentProfile, CurrentSeries
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LevelOscillation, RegularWave, Wave
from buoyancy_mj.settings.tables import build
from buoyancy_mj.submersion.exact import Exact
from buoyancy_mj.submersion.methods import METHODS, Method

WAVES: Mapping[str, type[Wave]] = {
    "regular": RegularWave,
    "jonswap": JonswapSea,
    "pierson-moskowitz": PiersonMoskowitzSea,
    "level": LevelOscillation,
}
"""Kinds of waves."""
CURRENTS: Mapping[str, type[CurrentProfile] | type[CurrentSeries]] = {
    "profile": CurrentProfile,
    "series": CurrentSeries,
}
"""Kinds of currents that are not everywhere and always the same."""
KEYS = (
    "density",
    "level",
    "waves",
    "current",
    "method",
    "pressure",
    "drag",
    "added_mass",
    "geoms",
    "hull",
    "fill",
)
"""What texts describe: the fields of `Water`, and the arguments of `Buoyancy`."""
_CHOICES = KEYS[-3:]
"""Words about geoms."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Settings:
    """All that `Buoyancy` is told beside the model."""

    water: Water = Water()
    """The sea."""
    method: Method = Exact()
    """How the submersion is found."""
    pressure: str = "archimedes"
    """What the pressure in waves is taken for."""
    drag: Drag | None = Drag()
    """How damping is estimated; None for none."""
    added_mass: str = "model"
    """Where the bodies' added mass comes from."""
    geoms: tuple[str, ...] | None = None
    """Which geoms displace water."""
    hull: tuple[str, ...] | None = None
    """Which of them as their convex hull."""
    fill: tuple[str, ...] | None = None
    """Which displace in part."""


# from tables -------------------------------------------------------------------------------------------


def water_from_table(value: Any, where: str, folder: Path = Path()) -> Water:
    """The sea that a table describes; `where` names it in errors, and paths in it start from `folder`.

    Raises:
        SceneError: an unknown key or kind of wave, or a value that makes no sense. So do the others here.
    """
    plain = dict(table_of(value, where))
    entries = plain.pop("waves", [])
    if not isinstance(entries, list):
        raise SceneError(
            f"{where}: waves is {entries!r}; needed is a list of tables [[water.waves]]"
        )
    waves: list[Wave] = []
    for i, entry in enumerate(entries):
        place = f"{where}.waves.{i}"
        wave = dict(table_of(entry, place))
        kind = wave.pop("kind", "regular")
        if not isinstance(kind, str) or kind not in WAVES:
            raise SceneError(f"{place}: unknown kind {kind!r}; {choices(str(kind), WAVES)}")
        waves.append(build(WAVES[kind], wave, place))
    given: dict[str, Any] = {"waves": tuple(waves)}
    if isinstance(plain.get("current"), dict):
        given["current"] = current_from_table(plain.pop("current"), f"{where}.current", folder)
    return build(Water, plain, where, **given)


def current_from_table(
    value: Mapping[str, Any], where: str, folder: Path = Path()
) -> CurrentProfile | CurrentSeries:
    """A current by depth or by time; a series may stand in a `file`, see `CurrentSeries.read`."""
    plain = dict(value)
    kind = plain.pop("kind", None)
    if not isinstance(kind, str) or kind not in CURRENTS:
        raise SceneError(
            f"{where}: kind is {kind!r}; {choices(str(kind), CURRENTS)}, or a list of 3 numbers instead"
        )
    if kind == "series" and "file" in plain:
        file = plain.pop("file")
        if plain or not isinstance(file, str):
            raise SceneError(
                f"{where}: a series has a file, a text, and nothing else, or times and velocities"
            )
        try:
            return CurrentSeries.read(folder / file)
        except WaterError as error:
            raise SceneError(f"{where}: {error}") from error
    return build(CURRENTS[kind], plain, where)


def method_from_table(value: Any, where: str) -> Method:
    """A method by its name, or a table of its `kind` and its options."""
    plain = {"kind": value} if isinstance(value, str) else dict(table_of(value, where))
    if "kind" not in plain:
        raise SceneError(f"{where}: 'kind' is missing; needed is one of {', '.join(METHODS)}")
    kind = plain.pop("kind")
    if not isinstance(kind, str) or kind not in METHODS:
        raise SceneError(f"{where}: unknown kind {kind!r}; {choices(str(kind), METHODS)}")
    return build(METHODS[kind], plain, where)


def drag_from_table(value: Any, where: str) -> Drag | None:
    """Whether there is drag, or a table of its coefficients."""
    if isinstance(value, bool):
        return Drag() if value else None
    return build(Drag, table_of(value, where), where)


def table_of(value: Any, where: str) -> Mapping[str, Any]:
    """A table, or an error that says it should be one."""
    if not isinstance(value, dict):
        raise SceneError(f"{where} is {value!r}; needed is a table")
    return value


# from texts, and back ----------------------------------------------------------------------------------


def parse_plugin_config(texts: Mapping[str, str], where: str) -> Settings:
    """What texts by the names of `KEYS` describe; empty ones, and missing ones, are defaults.

    A wave is its kind and its fields, 'regular amplitude=0.3 frequency=0.5', several stand between
    semicolons; a current is three numbers, or 'profile depths=[0,5] velocities=[[1,0,0],[0,0,0]]', or
    'series ...'; a method is its name and its options; drag is true, false, or its coefficients.

    Raises:
        SceneError: a text that makes no sense; the message names its key.
    """
    given = {key: text.strip() for key, text in texts.items() if text.strip()}
    sea: dict[str, Any] = {
        key: plain_value(given[key]) for key in ("density", "level") if key in given
    }
    if "current" in given:
        text = given["current"]
        speeds = [plain_value(word) for word in text.replace(",", " ").split()]
        sea["current"] = _words(text, f"{where}: current") if "=" in text else speeds
    if "waves" in given:
        sea["waves"] = [
            _words(wave, f"{where}: waves") for wave in given["waves"].split(";") if wave.strip()
        ]
    drag = given.get("drag", "true")
    return Settings(
        water=water_from_table(sea, where),
        method=method_from_table(
            _words(given.get("method", "exact"), f"{where}: method"), f"{where}: method"
        ),
        pressure=given.get("pressure", "archimedes"),
        added_mass=given.get("added_mass", "model"),
        drag=drag_from_table(
            _words(drag, f"{where}: drag") if "=" in drag else plain_value(drag), f"{where}: drag"
        ),
        **{key: tuple(given[key].replace(",", " ").split()) for key in _CHOICES if key in given},
    )


def write_plugin_config(settings: Settings) -> dict[str, str]:
    """Texts from which `settings_from_texts` makes the same settings again, to the last bit.

    Raises:
        WaterError, MethodError: a wave or a method of a kind that has no text.
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
    texts["pressure"], texts["added_mass"] = settings.pressure, settings.added_mass
    texts["drag"] = " ".join(_fields(settings.drag, all_of_them=True)) if settings.drag else "false"
    texts |= {key: " ".join(getattr(settings, key) or ()) for key in _CHOICES}
    return {key: text for key, text in texts.items() if text}


def plain_value(text: str) -> Any:
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
    return ({"kind": kind} if kind else {}) | {key: plain_value(value) for key, value in pairs}


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
    """A value without blanks, as `plain_value` reads it."""
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

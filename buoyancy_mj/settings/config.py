"""Settings as the short texts that the `<config>` of an MJCF plugin can hold, and back."""

import dataclasses
from collections.abc import Mapping
from typing import Any, cast

from buoyancy_mj.errors import BuoyancyError, MethodError, ModelError, WaterError, describe
from buoyancy_mj.hulls.selection import Selection, join_words, split_words
from buoyancy_mj.loads.damping import VISCOUS, Damping
from buoyancy_mj.sea.currents import Current
from buoyancy_mj.sea.spectra import PiersonMoskowitzSea
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LENGTHS, RegularWave, Wave
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.tables import convert
from buoyancy_mj.settings.texts import format_table, format_value, parse_table, parse_value
from buoyancy_mj.settings.toml import (
    CURRENTS,
    WAVES,
    damping_from_table,
    method_from_table,
    selection_from_table,
    water_from_table,
)
from buoyancy_mj.submersion.methods import METHODS, Method

WATER = tuple(field.name for field in dataclasses.fields(Water))
"""Keys of the plugin that describe the sea: the fields of `Water`."""
SELECTION = tuple(field.name for field in dataclasses.fields(Selection))
"""Keys that choose geoms: the fields of `Selection`."""
KEYS = (*WATER, "method", "pressure", "damping", "added_mass", "slamming", "threads", *SELECTION)
"""All keys of the plugin that hold settings."""
INSTANCE = "instance"
"""Key that holds the name of the instance where `add_water` put it. If the model has another name
for it, the instance was attached under a prefix, and is the water of what came with it."""


def parse_plugin_config(texts: Mapping[str, str], where: str) -> Settings:
    """The settings that texts describe; an empty or missing text is a default.

    - A wave is its kind and its fields, 'regular amplitude=0.3 frequency=0.5'; several stand
      between semicolons.
    - A current is three numbers, 'profile depths=[0,5] velocities=[[1,0,0],[0,0,0]]', or
      'series ...'.
    - A method is its name and its options.
    - Damping is false, or its kind and its numbers, 'silhouette coefficient=1.1 radiation=false'.

    Args:
        texts: by the names of `KEYS`.
        where: how messages call the texts.

    Raises:
        SceneError: a text that makes no sense; the message names its key.
    """
    words = {key: text.strip() for key, text in texts.items() if text.strip()}
    method = parse_table(words.get("method", "exact"), f"{where}: method")
    slamming = parse_value(words.get("slamming", "false"), f"{where}: slamming")
    damping = _parse_damping(words.get("damping", "true"), f"{where}: damping")
    threads = parse_value(words.get("threads", "1"), f"{where}: threads")
    selection = {
        key: split_words(words[key], f"{where}: {key}") for key in SELECTION if key in words
    }
    return Settings(
        water=water_from_table(_parse_water(words, where), where),
        method=method_from_table(method, f"{where}: method"),
        pressure=words.get("pressure", "archimedes"),
        added_mass=words.get("added_mass", "model"),
        slamming=convert(slamming, bool, f"{where}: slamming"),
        damping=damping_from_table(damping, f"{where}: damping"),
        selection=selection_from_table(selection, where),
        threads=convert(threads, int, f"{where}: threads"),
    )


def write_plugin_config(settings: Settings) -> dict[str, str]:
    """Texts from which `parse_plugin_config` makes the same settings again, to the last bit.

    Raises:
        WaterError: a wave of a kind that has no text.
        MethodError: a method of a kind that has no text.
        ModelError: added mass by matrices.
    """
    if isinstance(settings.added_mass, Mapping):
        raise ModelError(
            "added mass by matrices cannot be written into a model; "
            "give it there as numerics 'added_mass:BODY'"
        )
    water = settings.water
    if type(water) is not Water:
        raise WaterError(
            f"{describe(water)} cannot be written into a model; possible is a Water itself"
        )
    waves = cast(tuple[Wave, ...], water.waves)
    texts = {
        "density": format_value(float(water.density)),
        "level": format_value(float(water.level)),
        "waves": "; ".join(map(_format_wave, waves)),
        "current": _format_current(water.current),
        "method": _format_method(settings.method),
        "pressure": settings.pressure,
        "damping": _format_damping(settings.damping),
        "added_mass": settings.added_mass or "none",
        "slamming": format_value(settings.slamming),
        "threads": str(settings.threads) if settings.threads > 1 else "",
        **{key: join_words(getattr(settings.selection, key) or ()) for key in SELECTION},
    }
    return {key: text for key, text in texts.items() if text}


def has_texts(settings: Settings) -> bool:
    """Whether settings can be written as texts: all but those of somebody's own classes can."""
    try:
        write_plugin_config(settings)
    except BuoyancyError:
        return False
    return True


def _parse_water(words: Mapping[str, str], where: str) -> dict[str, Any]:
    """The table of a sea."""
    table = {
        key: parse_value(words[key], f"{where}: {key}")
        for key in ("density", "level")
        if key in words
    }
    if "current" in words:
        text = words["current"]
        place = f"{where}: current"
        speeds = [parse_value(word, place) for word in text.replace(",", " ").split()]
        table["current"] = parse_table(text, place) if "=" in text else speeds
    if "waves" in words:
        waves = [wave for wave in words["waves"].split(";") if wave.strip()]
        table["waves"] = [parse_table(wave, f"{where}: waves") for wave in waves]
    return table


def _parse_damping(text: str, where: str) -> Any:
    """The table of damping, or its kind, or whether there is any."""
    return parse_table(text, where) if "=" in text else parse_value(text, where)


def _format_wave(wave: Wave) -> str:
    """A wave as text."""
    kinds = [kind for kind, cls in WAVES.items() if type(wave) is cls]
    if not kinds:
        raise WaterError(
            f"{describe(wave)} cannot be written into a model; possible are {', '.join(WAVES)}"
        )
    return format_table(kinds[0], wave, leave_out=_list_derived(wave))


def _list_derived(wave: Wave) -> tuple[str, ...]:
    """Fields of a wave that follow from others, under any gravity."""
    if isinstance(wave, RegularWave):
        return tuple(name for name in LENGTHS if name != wave.given)
    if isinstance(wave, PiersonMoskowitzSea) and wave.is_developed:
        return ("peak_period",)
    return ()


def _format_current(current: Current) -> str:
    """A current as text."""
    for kind, cls in CURRENTS.items():
        if type(current) is cls:
            return format_table(kind, current)
    if not isinstance(current, tuple):
        raise WaterError(
            f"{describe(current)} cannot be written into a model; possible are three numbers, "
            f"{', '.join(CURRENTS)}"
        )
    return " ".join(format_value(float(speed)) for speed in current)


def _format_method(method: Method) -> str:
    """A method as text."""
    if type(method) not in METHODS.values():
        raise MethodError(
            f"{describe(method)} cannot be written into a model; possible are {', '.join(METHODS)}"
        )
    return format_table(method.name, method)


def _format_damping(damping: Damping | None) -> str:
    """Damping as text, with all its numbers, which may get other defaults one day."""
    if damping is None:
        return "false"
    radiation = f"radiation={format_value(damping.radiation)}"
    for kind, cls in VISCOUS.items():
        if cls is not None and type(damping.viscous) is cls:
            return f"{format_table(kind, damping.viscous, defaults=True)} {radiation}"
    return f"none {radiation}"

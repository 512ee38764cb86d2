"""Settings from tables of plain values, as TOML has them."""

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from buoyancy_mj.errors import SceneError, SceneTypeError, WaterError, choices, describe
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.loads.damping import VISCOUS, Damping
from buoyancy_mj.sea.currents import CurrentProfile, CurrentSeries
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LevelOscillation, RegularWave, Wave
from buoyancy_mj.settings.tables import build, convert
from buoyancy_mj.submersion.methods import METHODS, Method

K = TypeVar("K")

WAVES: Mapping[str, type[Wave]] = {
    "regular": RegularWave,
    "jonswap": JonswapSea,
    "pierson-moskowitz": PiersonMoskowitzSea,
    "level": LevelOscillation,
}
"""Classes of waves by their kind."""
CURRENTS: Mapping[str, type[CurrentProfile] | type[CurrentSeries]] = {
    "profile": CurrentProfile,
    "series": CurrentSeries,
}
"""Classes of currents that depend on depth or time, by their kind."""


def water_from_table(value: Any, where: str, folder: Path = Path()) -> Water:
    """The sea that a table describes.

    Args:
        value: the table.
        where: how messages call it.
        folder: where relative paths in it start.

    Raises:
        SceneError: an unknown key or kind, or a value that makes no sense; so in all functions
            here.
    """
    table = dict(table_of(value, where))
    waves = table.pop("waves", [])
    if not isinstance(waves, list):
        raise SceneTypeError(
            f"{where}: waves is {describe(waves)}; needed is a list of tables [[water.waves]]"
        )
    fields: dict[str, Any] = {
        "waves": tuple(wave_from_table(wave, f"{where}.waves.{i}") for i, wave in enumerate(waves))
    }
    if isinstance(table.get("current"), dict):
        fields["current"] = current_from_table(table.pop("current"), f"{where}.current", folder)
    return build(Water, table, where, **fields)


def wave_from_table(value: Any, where: str) -> Wave:
    """A wave from a table of its `kind`, 'regular' by default, and its fields."""
    table = dict(table_of(value, where))
    return build(_find_kind(table.pop("kind", "regular"), WAVES, where), table, where)


def current_from_table(
    value: Mapping[str, Any], where: str, folder: Path = Path()
) -> CurrentProfile | CurrentSeries:
    """A current by depth or by time; `CurrentSeries.read` reads a series from its `file`."""
    table = dict(value)
    kind = table.pop("kind", None)
    if not isinstance(kind, str) or kind not in CURRENTS:
        raise SceneTypeError(
            f"{where}: kind is {describe(kind)}; {choices(kind, CURRENTS)}, "
            "or a list of 3 numbers instead"
        )
    if kind == "series" and "file" in table:
        file = table.pop("file")
        if table or not isinstance(file, str):
            raise SceneError(
                f"{where}: a series has a file, a text, and nothing else, or times and velocities"
            )
        try:
            return CurrentSeries.read(folder / convert(file, str, f"{where}: file"))
        except WaterError as error:
            raise SceneError(f"{where}: {error}") from error
    return build(CURRENTS[kind], table, where)


def method_from_table(value: Any, where: str) -> Method:
    """A method from its name, or from a table of its `kind` and its options."""
    table = {"kind": value} if isinstance(value, str) else dict(table_of(value, where))
    if "kind" not in table:
        raise SceneError(f"{where}: 'kind' is missing; needed is one of {', '.join(METHODS)}")
    return build(_find_kind(table.pop("kind"), METHODS, where), table, where)


def damping_from_table(value: Any, where: str) -> Damping | None:
    """Damping from the kind of viscous drag, or a table of `kind`, its options and `radiation`.

    'none' alone is no damping at all, as false is, and as None is in Python; beside it,
    radiation = true keeps the damping of the waves that bodies make.
    """
    if isinstance(value, bool):
        return Damping() if value else None
    if not isinstance(value, str | dict):
        raise SceneTypeError(
            f"{where} is {describe(value)}; needed is true, false, one of {', '.join(VISCOUS)}, "
            "or a table"
        )
    table = {"kind": value} if isinstance(value, str) else dict(table_of(value, where))
    viscous = _find_kind(table.pop("kind", "silhouette"), VISCOUS, where)
    if viscous is None and not table:
        return None
    radiation = convert(table.pop("radiation", True), bool, f"{where}: radiation")
    options = [field.name for field in dataclasses.fields(viscous)] if viscous else []
    for key in table:
        if key not in options:
            raise SceneTypeError(
                f"{where}: unknown key {describe(key)}; "
                f"{choices(key, ('kind', 'radiation', *options))}, "
                f"where kind is one of {', '.join(VISCOUS)}"
            )
    return Damping(
        viscous=None if viscous is None else build(viscous, table, where), radiation=radiation
    )


def selection_from_table(table: Mapping[str, Any], where: str) -> Selection:
    """The selection of the lists `geoms`, `hull` and `fill` of a table."""
    words = {
        key: convert(value, tuple[str, ...], f"{where}: {key}") for key, value in table.items()
    }
    for key, chosen in words.items():
        if not " ".join(chosen).strip():
            raise SceneError(
                f"{where}: {key} is {describe(table[key])}, which chooses nothing; give patterns "
                f"such as 'hull*' or 'group:2', or leave {key} out"
            )
    return Selection(**words)


def table_of(value: Any, where: str) -> Mapping[str, Any]:
    """A table, or an error that says it should be one."""
    if not isinstance(value, dict):
        raise SceneTypeError(f"{where} is {describe(value)}; needed is a table")
    return value


def _find_kind(kind: Any, kinds: Mapping[str, K], where: str) -> K:
    """The class of a kind."""
    if not isinstance(kind, str) or kind not in kinds:
        raise SceneTypeError(f"{where}: unknown kind {describe(kind)}; {choices(kind, kinds)}")
    return kinds[kind]

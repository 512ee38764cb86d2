"""Settings from tables of plain values, as TOML has them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import SceneError, WaterError, choices
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.loads.damping import VISCOUS, Damping
from buoyancy_mj.sea.currents import CurrentProfile, CurrentSeries
from buoyancy_mj.sea.spectra import JonswapSea, PiersonMoskowitzSea
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import LevelOscillation, RegularWave, Wave
from buoyancy_mj.settings.tables import build, convert
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
"""Kinds of currents that change by depth or by time."""


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


def damping_from_table(value: Any, where: str) -> Damping | None:
    """Damping by the kind of viscous drag, or a table of its `kind`, the kind's options and `radiation`."""
    if isinstance(value, bool):
        return Damping() if value else None
    plain = {"kind": value} if isinstance(value, str) else dict(table_of(value, where))
    kind = plain.pop("kind", "silhouette")
    if not isinstance(kind, str) or kind not in VISCOUS:
        raise SceneError(f"{where}: unknown kind {kind!r}; {choices(str(kind), VISCOUS)}")
    radiation = convert(plain.pop("radiation", True), bool, f"{where}: radiation")
    viscous = VISCOUS[kind]
    if viscous is None and plain:
        raise SceneError(f"{where}: unknown key '{next(iter(plain))}'; possible: kind, radiation")
    return Damping(
        viscous=None if viscous is None else build(viscous, plain, where), radiation=radiation
    )


def selection_from_table(table: Mapping[str, Any], where: str) -> Selection:
    """The selection that the lists `geoms`, `hull` and `fill` of a table make."""
    return Selection(
        **{key: convert(value, tuple[str, ...], f"{where}: {key}") for key, value in table.items()}
    )


def table_of(value: Any, where: str) -> Mapping[str, Any]:
    """A table, or an error that says it should be one."""
    if not isinstance(value, dict):
        raise SceneError(f"{where} is {value!r}; needed is a table")
    return value

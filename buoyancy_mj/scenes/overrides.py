"""Single values laid over the table of a scene: KEY=VALUE, as `--set` gives them."""

from typing import Any

from buoyancy_mj.errors import SceneError, SceneTypeError, describe
from buoyancy_mj.settings.texts import parse_value
from buoyancy_mj.values import read_text

_VECTORS = (
    "cog_shift",
    "water.current",
    "start.position",
    "start.velocity",
    "start.angular_velocity",
)
"""Keys of vectors whose numbers may be set one by one, though the file has none of them."""


def apply_setting(table: dict[str, Any], setting: str) -> None:
    """Lay one KEY=VALUE over a table; VALUE is TOML, or a bare word.

    KEY is a path through tables, by names, and through lists, by places counted from 0:
    'water.waves.0.amplitude'. Tables that are missing on the way are made.

    Raises:
        SceneError: the text is no setting, or its key leads nowhere.
    """
    key, equals, text = setting.partition("=")
    if not equals or not key.strip():
        raise SceneError(
            f"{describe(setting)} is no setting; write KEY=VALUE, for example duration=3 or "
            "water.level=0.2"
        )
    key = read_text(SceneError, "the key of a setting", key.strip())
    value = parse_value(text, key)
    *path, last = key.split(".")
    if _is_vector(path):
        _add_vector(table, path)

    # the table or list that holds the value
    holder: Any = table
    for depth, part in enumerate(path):
        holder = _step(holder, part, ".".join(path[: depth + 1]))

    # the value
    if isinstance(holder, list):
        holder[_index(holder, last, key)] = value
    elif isinstance(holder, dict):
        holder[last] = value
    else:
        raise SceneTypeError(
            f"cannot set '{key}': '{'.'.join(path)}' is {describe(holder)}, no table"
        )


def _is_vector(path: list[str]) -> bool:
    """Whether a path leads to a vector, of the scene or of one of its vehicles."""
    of_vehicle = path[2:] if path[:1] == ["vehicles"] else path
    return ".".join(of_vehicle) in _VECTORS


def _add_vector(table: dict[str, Any], path: list[str]) -> None:
    """Add a vector of zeros at the end of a path, where there is none."""
    *above, name = path
    holder: Any = table
    for depth, part in enumerate(above):
        holder = _step(holder, part, ".".join(above[: depth + 1]))
    if isinstance(holder, dict):
        holder.setdefault(name, [0.0, 0.0, 0.0])


def _step(holder: Any, part: str, key: str) -> Any:
    """What a table or a list holds at one part of a path; an empty table where there is nothing."""
    if isinstance(holder, list):
        return holder[_index(holder, part, key)]
    if not isinstance(holder, dict):
        raise SceneTypeError(f"cannot set '{key}': it lies in {describe(holder)}, no table")
    return holder.setdefault(part, {})


def _index(entries: list[Any], part: str, key: str) -> int:
    """The place in a list that one part of a path names."""
    places = {str(place): place for place in range(len(entries))}
    if part not in places:
        raise SceneTypeError(
            f"cannot set '{key}': the list has {len(entries)} entries, counted from 0"
        )
    return places[part]

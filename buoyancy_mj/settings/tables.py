"""Tables of plain values, as TOML has them, become frozen dataclasses; a wrong one is refused."""

import dataclasses
import math
import types
import typing
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from buoyancy_mj.errors import BuoyancyError, SceneError, SceneTypeError, choices, describe
from buoyancy_mj.values import is_number, read_text

T = TypeVar("T")

_PLAIN_TYPES = {
    float: "a number",
    int: "a whole number",
    bool: "true or false",
    str: "a text in quotes",
}
"""Types that TOML has too, in words."""
_PLURALS = {str: "words", float: "numbers"}
"""Types of which TOML has lists, in words."""


def build(cls: type[T], table: Mapping[str, Any], where: str, **values: Any) -> T:
    """Build a dataclass from a table.

    Args:
        cls: the dataclass.
        table: its fields as plain values, by their names.
        where: how messages call the table.
        values: fields that the caller sets, which are no keys of the table.

    Raises:
        SceneTypeError: a key that `cls` lacks, or a value of the wrong type.
        SceneError: a missing value, or one that `cls` itself refuses.
    """
    hints = typing.get_type_hints(cls)
    fields = {field.name: field for field in dataclasses.fields(cls) if field.name not in values}  # type: ignore[arg-type]

    # the keys
    for key in table:
        if key not in fields:
            raise SceneTypeError(f"{where}: unknown key {describe(key)}; {choices(key, fields)}")
    for name, field in fields.items():
        if name not in table and not _has_default(field):
            raise SceneError(f"{where}: '{name}' is missing; needed is {_describe(hints[name])}")

    # the values
    converted = {key: convert(table[key], hints[key], f"{where}: {key}") for key in table}
    try:
        return cls(**converted, **values)
    except BuoyancyError as error:
        raise SceneError(f"{where}: {error}") from error


def convert(value: Any, hint: Any, where: str) -> Any:
    """Convert a plain value to a type.

    Args:
        value: any value.
        hint: the type: bool, int, float, str or a tuple of these; of a union, its first type
            counts.
        where: how messages call the value.

    Raises:
        SceneTypeError: the value is of another type.
        SceneError: it is nan, beyond what a float holds, or a text of several lines.
    """
    kind = _first_type(hint)
    if kind in (float, int) and is_number(value):
        return _convert_number(value, kind, where)
    if kind is bool and isinstance(value, bool):
        return value
    if kind is str and isinstance(value, str):
        return read_text(SceneError, where, value)
    if typing.get_origin(kind) is tuple and isinstance(value, list | tuple):
        items = typing.get_args(kind)
        if items[-1] is Ellipsis:
            items = (items[0],) * len(value)
        if len(items) == len(value):
            return _convert_items(value, items, where)
    raise SceneTypeError(f"{where} is {describe(value)}; needed is {_describe(kind)}")


def _convert_number(value: float, kind: type, where: str) -> float:
    """A number as a float or an int; a whole number may be written with a point."""
    try:
        number = float(value)
    except OverflowError:
        raise SceneError(
            f"{where} is {describe(value)}; needed is {_describe(kind)} below 1.8e308"
        ) from None
    if math.isnan(number):
        raise SceneError(f"{where} is nan; needed is {_describe(kind)}")
    if kind is float:
        return number
    if not number.is_integer():
        raise SceneTypeError(f"{where} is {describe(value)}; needed is {_describe(kind)}")
    return int(value)


def _convert_items(values: Sequence[Any], hints: Sequence[Any], where: str) -> tuple[Any, ...]:
    """Each item of a list, converted to its type."""
    return tuple(convert(value, hint, where) for value, hint in zip(values, hints, strict=True))


def _has_default(field: dataclasses.Field[Any]) -> bool:
    missing = dataclasses.MISSING
    return field.default is not missing or field.default_factory is not missing


def _first_type(hint: Any) -> Any:
    """The first type of a union that is not None, or the type itself."""
    if isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union:
        return next(option for option in typing.get_args(hint) if option is not type(None))
    return hint


def _describe(hint: Any) -> str:
    """A type in words."""
    kind = _first_type(hint)
    if typing.get_origin(kind) is tuple:
        items = typing.get_args(kind)
        if items[-1] is not Ellipsis:
            return f"a list of {len(items)} numbers"
        plural = _PLURALS.get(items[0], f"lists of {len(typing.get_args(items[0]))} numbers")
        return f"a list of {plural}"
    return _PLAIN_TYPES.get(kind, f"a table ({getattr(kind, '__name__', kind)})")

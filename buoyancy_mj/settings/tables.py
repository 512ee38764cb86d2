"""Tables of plain values, as TOML has them, into frozen dataclasses: unknown keys and wrong types are told."""

import dataclasses
import math
import types
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

from buoyancy_mj.errors import BuoyancyError, SceneError, choices

T = TypeVar("T")


def build(cls: type[T], table: Mapping[str, Any], where: str, **given: Any) -> T:
    """A `cls` from `table`; `given` fields are set by the caller and are no keys of the table.

    Raises:
        SceneError: a key that `cls` lacks, a value of the wrong type, a missing one, or one that
            `cls` itself refuses; `where` names the table.
    """
    hints = typing.get_type_hints(cls)
    fields = {field.name: field for field in dataclasses.fields(cls) if field.name not in given}  # type: ignore[arg-type]
    for key in table:
        if key not in fields:
            raise SceneError(f"{where}: unknown key '{key}'; {choices(key, fields)}")
    for name, field in fields.items():
        if (
            name not in table
            and field.default is dataclasses.MISSING
            and field.default_factory is dataclasses.MISSING
        ):
            raise SceneError(f"{where}: '{name}' is missing; needed is {_described(hints[name])}")
    values = {key: convert(value, hints[key], f"{where}: {key}") for key, value in table.items()}
    try:
        return cls(**values, **given)
    except BuoyancyError as error:
        raise SceneError(f"{where}: {error}") from error


def convert(value: Any, hint: Any, where: str) -> Any:
    """`value` as `hint` wants it: bool, int, float, str, a tuple of floats or of strings, or one of those or None."""
    if isinstance(hint, types.UnionType) or typing.get_origin(hint) is typing.Union:
        options = [option for option in typing.get_args(hint) if option is not type(None)]
        return convert(value, options[0], where)
    if hint is float and isinstance(value, int | float) and not isinstance(value, bool):
        if math.isnan(value):
            raise SceneError(f"{where} is nan; needed is a number")
        return float(value)
    if hint is bool and isinstance(value, bool):
        return value
    if hint is int and isinstance(value, int) and not isinstance(value, bool):
        return value
    if hint is str and isinstance(value, str):
        return value
    if typing.get_origin(hint) is tuple and isinstance(value, list | tuple):
        items = typing.get_args(hint)
        if items[-1] is Ellipsis:
            return tuple(convert(item, items[0], where) for item in value)
        if len(items) == len(value):
            return tuple(
                convert(item, kind, where) for item, kind in zip(value, items, strict=True)
            )
    raise SceneError(f"{where} is {value!r}; needed is {_described(hint)}")


def _described(hint: Any) -> str:
    """A type in words."""
    if isinstance(hint, types.UnionType):
        return _described(
            next(option for option in typing.get_args(hint) if option is not type(None))
        )
    if typing.get_origin(hint) is tuple:
        items = typing.get_args(hint)
        return "a list of words" if items[-1] is Ellipsis else f"a list of {len(items)} numbers"
    return {
        float: "a number",
        int: "a whole number",
        bool: "true or false",
        str: "a text in quotes",
    }.get(hint, f"a table ({getattr(hint, '__name__', hint)})")

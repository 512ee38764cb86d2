"""Values and tables as short texts without blanks inside a value, and back."""

import contextlib
import dataclasses
import math
import re
import tomllib
from collections.abc import Sequence
from typing import Any

from buoyancy_mj.errors import SceneError, describe
from buoyancy_mj.values import read_text

_NUMBERS = re.compile(r"[-+.,\s\d\[\]eE]+")
"""A number, or lists of numbers."""
_LEADING = re.compile(r"(?<![\d_])\.(?=\d)")
"""A point with no digit before it."""
_TRAILING = re.compile(r"(?<=\d)\.(?!\d)")
"""A point with no digit behind it."""


def parse_toml(text: str, where: str) -> dict[str, Any]:
    """The table that a text of TOML describes.

    Args:
        text: the text.
        where: how messages call it.

    Raises:
        SceneError: it is no TOML, or more than Python reads of it.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"{where} is no valid TOML: {error}") from error
    except (ValueError, RecursionError) as error:
        raise SceneError(
            f"{where} cannot be read: {_explain(error)}, near {_find_cause(text, error)}"
        ) from error


def parse_value(text: str, where: str) -> Any:
    """A value of TOML, or the text itself as a bare word.

    Args:
        text: the text, on one line.
        where: how messages call it.

    Raises:
        SceneError: it is more than one line, or more than Python reads.
    """
    line = read_text(SceneError, where, text)
    try:
        return tomllib.loads(f"value = {line}")["value"]
    except tomllib.TOMLDecodeError:
        return _read_bare_points(line.strip())
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{where} is {describe(text)}: {_explain(error)}") from error


def format_value(value: bool | str | float | tuple[Any, ...]) -> str:
    """A value as a text without blanks, from which `parse_value` makes the same value again."""
    match value:
        case bool():
            return str(value).lower()
        case str():
            return value
        case tuple():
            return f"[{','.join(map(format_value, value))}]"
        case int():
            return str(value)
    return "inf" if math.isinf(value) else repr(float(value))


def parse_table(text: str, where: str) -> dict[str, Any]:
    """The table that 'kind key=value key=value' describes; the kind may be missing.

    Raises:
        SceneError: a word after the kind is no key=value pair.
    """
    kind, *words = text.split()
    if "=" in kind:
        kind, words = "", [kind, *words]
    table: dict[str, Any] = {"kind": kind} if kind else {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals:
            raise SceneError(
                f"{where} is {describe(text.strip())}; after the kind it must be key=value pairs "
                f"between blanks, not {describe(word)}"
            )
        if key in table:
            raise SceneError(f"{where} is {describe(text.strip())}; it gives '{key}' twice")
        table[key] = parse_value(value, f"{where}: {key}")
    return table


def format_table(
    kind: str, value: Any, *, leave_out: Sequence[str] = (), defaults: bool = False
) -> str:
    """A dataclass as 'kind key=value key=value', which `parse_table` reads.

    Args:
        kind: the first word.
        value: the dataclass.
        leave_out: fields that are not written.
        defaults: whether fields at their defaults are written too.
    """
    words = [kind]
    for field in dataclasses.fields(value):
        item = getattr(value, field.name)
        if field.name not in leave_out and (defaults or item != field.default):
            words.append(f"{field.name}={format_value(item)}")
    return " ".join(words)


def _read_bare_points(text: str) -> Any:
    """Numbers as MJCF may have them, '.5' or '1.', which TOML has not; or the text itself."""
    if _NUMBERS.fullmatch(text):
        digits = _LEADING.sub("0.", _TRAILING.sub(".0", text))
        with contextlib.suppress(tomllib.TOMLDecodeError):
            return tomllib.loads(f"value = {digits}")["value"]
    return text


def _find_cause(text: str, error: Exception) -> str:
    """The line of a text that Python can most likely not read, and how it begins."""
    suspects = "[{" if isinstance(error, RecursionError) else "0123456789"
    lines = text.split("\n")
    weights = [sum(line.count(suspect) for suspect in suspects) for line in lines]
    number = weights.index(max(weights))
    return f"line {number + 1}, which begins {describe(lines[number][:30])}"


def _explain(error: Exception) -> str:
    """What Python cannot read, in words."""
    if isinstance(error, RecursionError):
        return "its lists or tables lie too deep in one another"
    return "a number in it has too many digits"

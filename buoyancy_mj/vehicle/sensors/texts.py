"""Settings of a sensor as keys of MJCF, and back."""

import dataclasses
import typing
from collections.abc import Mapping
from typing import Any, TypeVar

from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.texts import format_value, parse_value
from buoyancy_mj.vehicle.sensors.sampling import SiteSensor

S = TypeVar("S", bound=SiteSensor)


def list_keys(cls: type[SiteSensor]) -> tuple[str, ...]:
    """The keys of a kind: the fields of its class."""
    return tuple(field.name for field in dataclasses.fields(cls))


def parse_sensor(cls: type[S], texts: Mapping[str, str], where: str) -> S:
    """The settings that texts describe; an empty or missing text is a default.

    Raises:
        SceneError: a text that makes no sense; the message names its key.
    """
    hints = typing.get_type_hints(cls)
    words = {key: text.strip() for key, text in texts.items() if text.strip()}
    table = {key: _parse(text, hints[key], f"{where}: {key}") for key, text in words.items()}
    return build(cls, table, where)


def format_sensor(sensor: SiteSensor) -> dict[str, str]:
    """Texts from which `parse_sensor` makes the same settings again, those at defaults left out."""
    texts = {}
    for field in dataclasses.fields(sensor):
        value = getattr(sensor, field.name)
        if value != field.default:
            texts[field.name] = (
                " ".join(map(format_value, value))
                if isinstance(value, tuple)
                else format_value(value)
            )
    return texts


def _parse(text: str, hint: Any, where: str) -> Any:
    """A text as a plain value: names stay texts, and of numbers there may be several."""
    if hint is str:
        return text
    if isinstance(hint, type):
        return parse_value(text, where)
    return [parse_value(word, where) for word in text.replace(",", " ").split()]

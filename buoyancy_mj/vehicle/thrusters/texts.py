"""Thrusters as the short texts that the `<config>` of an MJCF plugin can hold, and back."""

import dataclasses
import functools
from collections.abc import Mapping

from buoyancy_mj.errors import ModelError, SceneError
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.texts import format_value, parse_value
from buoyancy_mj.vehicle.thrusters.thruster import Thruster

KEYS = tuple(field.name for field in dataclasses.fields(Thruster))
"""Keys of the plugin: the fields of `Thruster`."""


def parse_thruster(texts: Mapping[str, str], where: str) -> Thruster:
    """The thruster that texts describe; an empty or missing text is a default.

    A table is a list of rows, '[[0,0.45,0.07],[0.5,0.25,0.04]]'.

    Args:
        texts: by the names of `KEYS`.
        where: how messages call the thruster.

    Raises:
        ModelError: a text that makes no sense; the message names its key.
    """
    words = {key: text.strip() for key, text in texts.items() if text.strip()}
    return _build(tuple(words.items()), where)


def write_thruster(thruster: Thruster) -> dict[str, str]:
    """Texts from which `parse_thruster` makes the same thruster again, to the last bit."""
    texts = {}
    for field in dataclasses.fields(Thruster):
        value = getattr(thruster, field.name)
        if value != field.default:
            texts[field.name] = format_value(value)
    return texts


@functools.lru_cache(maxsize=256)
def _build(words: tuple[tuple[str, str], ...], where: str) -> Thruster:
    """The thruster of some texts, made once: others ask for it in each frame."""
    try:
        table = {key: parse_value(text, f"{where}: {key}") for key, text in words}
        return build(Thruster, table, where)
    except SceneError as error:
        raise ModelError(str(error)) from error

"""Plugin instances of a compiled model, and the texts of their configuration."""

from collections.abc import Sequence

import mujoco

_known: dict[str, tuple[int, tuple[str, ...]]] = {}
"""The number by which models refer to each plugin, and the keys of its configuration."""


def note_plugin(name: str, number: int, keys: Sequence[str]) -> None:
    """Keep what MuJoCo was told of a plugin when it was registered."""
    _known[name] = number, tuple(keys)


def read_instances(model: mujoco.MjModel, plugin: str) -> dict[int, dict[str, str]]:
    """The texts of all instances of a plugin, by key, and by the index of the instance.

    A key that an instance does not state has the text ''.
    """
    number, keys = _known.get(plugin, (-1, ()))
    found = {}
    for instance in range(model.nplugin):
        if model.plugin[instance] == number:
            start = int(model.plugin_attradr[instance])
            words = model.plugin_attr[start:].tobytes().split(b"\0", len(keys))
            texts = (word.decode(errors="replace") for word in words)
            found[instance] = dict(zip(keys, texts, strict=False))
    return found

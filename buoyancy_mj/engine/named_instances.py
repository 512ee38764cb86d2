"""Names for the plugin instances of a spec that have none.

MuJoCo writes instances into `<extension>` up to the first without a name. Those that a thruster or
a sensor states in its own element have none, and all that are added after them would be lost in the
MJCF saved from the spec.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import mujoco

_MARK = {"": ""}
"""A configuration that no instance has."""


def name_instances(spec: mujoco.MjSpec) -> None:
    """Name all plugin instances of actuators and sensors, after those that they belong to."""
    taken = {plugin.name for plugin in spec.plugins}
    for plugin in spec.plugins:
        if plugin.name:
            continue
        element = _find_owner(spec, plugin)
        if element is None:
            continue
        name = _find_free_name(element.name or element.plugin.plugin_name, taken)
        taken.add(name)
        plugin.name, plugin.plugin_name, plugin.active = name, element.plugin.plugin_name, True
        element.plugin.name = name


def add_instance(spec: mujoco.MjSpec, element: Any, plugin: str, config: Mapping[str, str]) -> None:
    """Give an actuator or a sensor of a spec a plugin instance of its own, under its own name.

    Args:
        spec: the model.
        element: the actuator or sensor.
        plugin: name of the plugin.
        config: its keys.
    """
    name_instances(spec)
    name = _find_free_name(element.name, {other.name for other in spec.plugins})
    spec.activate_plugin(plugin)
    instance = spec.add_plugin(name=name, plugin_name=plugin, active=True)
    instance.config = dict(config)
    element.plugin.active, element.plugin.plugin_name, element.plugin.name = True, plugin, name


def _find_owner(spec: mujoco.MjSpec, plugin: Any) -> Any:
    """The element that states an instance; the two share their configuration."""
    config = dict(plugin.config)
    plugin.config = _MARK
    try:
        return next((e for e in _unnamed(spec) if dict(e.plugin.config) == _MARK), None)
    finally:
        plugin.config = config


def _unnamed(spec: mujoco.MjSpec) -> Iterator[Any]:
    """Actuators and sensors with an instance that has no name."""
    for element in (*spec.actuators, *spec.sensors):
        if element.plugin.active and not element.plugin.name:
            yield element


def _find_free_name(stem: str, taken: set[str]) -> str:
    """A name that no instance has."""
    names = (stem, *(f"{stem}_{n}" for n in range(2, len(taken) + 3)))
    return next(name for name in names if name not in taken)

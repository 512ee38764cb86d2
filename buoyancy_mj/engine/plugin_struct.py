"""MuJoCo's mjpPlugin: how one is registered from Python, and how it gets other functions."""

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any

from buoyancy_mj.engine import library

HOOKS = (
    "nstate", "nsensordata", "init", "destroy", "copy", "reset", "compute", "advance", "visualize",
    "actuator_act_dot",
    "sdf_distance", "sdf_gradient", "sdf_staticdistance", "sdf_attribute", "sdf_aabb",
)  # fmt: skip
"""Functions of MuJoCo's mjpPlugin, in their order."""
_INT = ctypes.c_int


class _Plugin(ctypes.Structure):
    """MuJoCo's mjpPlugin, of mjplugin.h."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("nattribute", _INT),
        ("attributes", ctypes.POINTER(ctypes.c_char_p)),
        ("capabilityflags", _INT),
        ("needstage", _INT),
        *((name, ctypes.c_void_p) for name in HOOKS),
    )


def register_plugin(
    name: str, keys: Sequence[str], capability: int, stage: int, functions: Mapping[str, int]
) -> int:
    """Register a plugin with MuJoCo, which has none of that name.

    Args:
        name: of the plugin.
        keys: of its configuration.
        capability: one of mjtPluginCapabilityBit.
        stage: the mjtStage at which it acts as a sensor.
        functions: addresses of C functions, by the names of `HOOKS`; they must live for ever.

    Returns:
        Its number, by which models refer to it.
    """
    words = [key.encode() for key in keys]
    attributes = (ctypes.c_char_p * len(words))(*words)
    plugin = _Plugin(
        name=name.encode(),
        nattribute=len(words),
        attributes=attributes,
        capabilityflags=capability,
        needstage=stage,
        **functions,
    )
    # MuJoCo copies the struct with its texts
    register = library.function("mjp_registerPlugin", _INT, ctypes.c_void_p)
    slot: int = register(ctypes.addressof(plugin))
    return slot


def find_plugin(name: str) -> int:
    """The number of a plugin that MuJoCo knows; -1 for none of that name."""
    slot = _INT(-1)
    find = library.function("mjp_getPlugin", ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
    find(name.encode(), ctypes.addressof(slot))
    return slot.value


def replace_hooks(slot: int, functions: Mapping[str, int]) -> None:
    """Give a registered plugin other functions, which MuJoCo calls from then on.

    MuJoCo looks each up in its own table of plugins whenever it calls one.

    Args:
        slot: number of the plugin.
        functions: as those of `register_plugin`.
    """
    at_slot = library.function("mjp_getPluginAtSlot", ctypes.POINTER(_Plugin), _INT)
    plugin: Any = at_slot(slot).contents
    # whoever finds the new `init` finds all that comes after it
    for hook in sorted(functions, key=HOOKS.index, reverse=True):
        setattr(plugin, hook, functions[hook])

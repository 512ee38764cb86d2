"""MuJoCo's mjpPlugin, and how one is registered from Python."""

import ctypes
from collections.abc import Mapping, Sequence

from buoyancy_mj.engine import layout

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
    """Register a plugin with MuJoCo.

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
    register = layout.function("mjp_registerPlugin", _INT, ctypes.c_void_p)
    slot: int = register(ctypes.addressof(plugin))
    return slot

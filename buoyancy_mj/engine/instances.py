"""The plugin instances of a compiled model by which it brings its own water."""

import ctypes

import mujoco
import numpy as np

from buoyancy_mj.engine import layout
from buoyancy_mj.errors import ModelError, choices

PLUGIN = "buoyancy_mj.water"
"""Name of the engine plugin; `engine.registration` registers it."""


def plugin_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances by which a model brings its own water."""
    slot = ctypes.c_int(-1)
    find = layout.function("mjp_getPlugin", ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
    find(PLUGIN.encode(), ctypes.addressof(slot))
    if slot.value < 0:
        return []
    return [i for i in range(model.nplugin) if model.plugin[i] == slot.value]


def instance_name(model: mujoco.MjModel, instance: int) -> str:
    """The name of an instance; '' without one."""
    return mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, instance) or ""


def find_instance(model: mujoco.MjModel, name: str | None) -> int:
    """The index of an instance by its name; None finds the only one.

    Raises:
        ModelError: there is no such instance, or several and no name.
    """
    instances = {instance_name(model, i): i for i in plugin_instances(model)}
    if name is None and len(instances) == 1:
        return next(iter(instances.values()))
    if not instances:
        raise ModelError(
            "the model has no water of its own: add_water(spec, water) gives it one before it is "
            "compiled, and Buoyancy(model, water) puts it into water as it is"
        )
    if name not in instances:
        raise ModelError(
            f"the model has no water named '{name or ''}'; {choices(name or '', instances)}"
        )
    return instances[name]


def find_instance_bodies(model: mujoco.MjModel, instance: int) -> tuple[int, ...] | None:
    """Indices of the bodies of an instance; None for all.

    A body that is welded to one that joined an instance belongs to it too. If no body joined this
    instance, it has all bodies but those of the other instances.
    """
    instances = plugin_instances(model)
    joined = model.body_plugin.copy()
    for body in range(1, model.nbody):
        parent = int(model.body_parentid[body])
        if joined[body] not in instances and model.body_weldid[body] == model.body_weldid[parent]:
            joined[body] = joined[parent]
    if instance in joined:
        return tuple(np.flatnonzero(joined == instance).tolist())
    in_others = np.isin(joined, instances)
    return tuple(np.flatnonzero(~in_others).tolist()) if in_others.any() else None

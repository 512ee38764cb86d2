"""The plugin instances of a compiled model by which it brings its own water."""

import ctypes

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine import library
from buoyancy_mj.engine.model_memory import read_first_name
from buoyancy_mj.engine.plugin_struct import find_plugin
from buoyancy_mj.errors import ModelError, choices
from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.scopes import BASE, Scope, find_scope

PLUGIN = "buoyancy_mj.water"
"""Name of the engine plugin; `engine.registration` registers it."""


def plugin_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances by which a model brings its own water."""
    slot = find_plugin(PLUGIN)
    if slot < 0:
        return []
    return [i for i in range(model.nplugin) if model.plugin[i] == slot]


def plugin_name(model: mujoco.MjModel, instance: int) -> str:
    """The name of the plugin that an instance is of, ours or another's."""
    find = library.function("mjp_getPluginAtSlot", ctypes.POINTER(ctypes.c_char_p), ctypes.c_int)
    # the name is the first field of an mjpPlugin
    return bytes(find(int(model.plugin[instance]))[0]).decode()


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
    if name is None:
        raise ModelError(
            f"the model has {len(instances)} waters of its own; name one of them; "
            f"{choices('', instances)}"
        )
    if name not in instances:
        raise ModelError(f"the model has no water named '{name}'; {choices(name, instances)}")
    return instances[name]


def find_instance_scope(model: mujoco.MjModel, instance: int) -> Scope:
    """What an instance of `add_water` was attached with; the base if it was not attached."""
    first_name = read_first_name(model._address, instance)
    return find_scope(instance_name(model, instance), first_name) or BASE if first_name else BASE


def find_instance_bodies(model: mujoco.MjModel, instance: int) -> tuple[int, ...] | None:
    """Indices of the bodies of an instance; None for all.

    A body that is welded to one that joined an instance belongs to it too. Bodies that joined none
    belong to the instance that came with them, or else to the one that was not attached; but an
    instance of MJCF that any body joined has those alone.

    Raises:
        ModelError: no body that moves belongs to the instance, or to another one as well.
    """
    owners = _find_joined(model)
    instances = plugin_instances(model)

    # bodies that came with an attached instance, by their names
    scopes = {i: find_instance_scope(model, i) for i in instances}
    for i, scope in scopes.items():
        for body in np.flatnonzero(owners < 0) if scope != BASE else ():
            if scope.separates and scope.has(str(model.body(body).name)):
                owners[body] = i

    # the others
    takers = [i for i in instances if scopes[i] == BASE and _takes_others(model, i, owners)]
    free = np.flatnonzero((owners < 0) & find_moving_bodies(model))
    if instance in takers and len(takers) > 1 and len(free):
        one, other = (instance_name(model, i) for i in takers[:2])
        raise ModelError(
            f"body '{body_name(model, int(free[0]))}' is in the waters '{one}' and '{other}'; let "
            f"each body join one of them, as by <plugin instance='{one}'/>, or remove one"
        )
    if instance in takers:
        owners[owners < 0] = instance

    mine = owners == instance
    if not (mine & find_moving_bodies(model)).any():
        raise ModelError(
            f"no body that moves is in the water '{instance_name(model, instance)}'; let one join "
            "it, as by <plugin instance=.../>, or remove it"
        )
    return None if mine.all() else tuple(np.flatnonzero(mine).tolist())


def _find_joined(model: mujoco.MjModel) -> NDArray[np.int64]:
    """The instance that each body, or what it is welded to, joined (nbody,); -1 for none."""
    joined = np.where(
        np.isin(model.body_plugin, plugin_instances(model)), model.body_plugin, -1
    ).astype(np.int64)
    for body in range(1, model.nbody):
        parent = int(model.body_parentid[body])
        if joined[body] < 0 and model.body_weldid[body] == model.body_weldid[parent]:
            joined[body] = joined[parent]
    return joined


def _takes_others(model: mujoco.MjModel, instance: int, owners: NDArray[np.int64]) -> bool:
    """Whether bodies that joined no instance are in this one, which was not attached."""
    return bool(read_first_name(model._address, instance)) or instance not in owners

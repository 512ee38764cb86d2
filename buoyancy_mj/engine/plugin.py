"""The water as a plugin of the engine: part of a model, and at work wherever MuJoCo steps it.

    <extension>
      <plugin plugin="buoyancy_mj.water">
        <instance name="sea"><config key="waves" value="regular amplitude=0.3 frequency=0.5"/></instance>
      </plugin>
    </extension>

A body joins the instance by `<plugin instance="sea"/>`; where none does, all bodies that move are in it.
The keys are those of `settings.KEYS`. MuJoCo calls compiled functions alone, from any thread; Python
is asked once for each mjData, when it is made, and when data are stepped with another model.
"""

import ctypes
import functools
import hashlib
import threading
import warnings
from typing import Unpack

import mujoco
import numpy as np

from buoyancy_mj.engine import compiled, layout
from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import address_of, wrap_python
from buoyancy_mj.engine.callbacks import PLUGIN, plugin_instances, skips_passive
from buoyancy_mj.errors import BuoyancyWarning, EngineError, ModelError, choices
from buoyancy_mj.kernels.entries import plugin_hooks
from buoyancy_mj.kernels.entries.closures import Closure
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.kernels.passes import ALIVE, MODEL, WATER
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.config import KEYS, parse_plugin_config, write_plugin_config
from buoyancy_mj.settings.settings import Options, Settings, settings_with

KEPT = 32
"""Waters that are kept although no data use them, lest a model whose data come and go be read again and again."""
REMEMBERED = 1024
"""Settings that are remembered; what is older is read from its texts."""
_READ = (
    "geom_type", "geom_contype", "geom_conaffinity", "geom_bodyid", "geom_dataid", "geom_group", "geom_size", "geom_pos",
    "geom_quat", "mesh_vertadr", "mesh_vertnum", "mesh_vert", "mesh_faceadr", "mesh_facenum", "mesh_face", "body_parentid",
    "body_weldid", "body_pos", "body_quat", "body_plugin", "text_adr", "text_size", "text_data", "numeric_adr",
    "numeric_size", "numeric_data", "names", "plugin",
)  # fmt: skip
"""Arrays of mjModel of which the hulls and their drag are made: models that agree in them share one water.

What else matters, as masses and the timestep, is read anew in each pass."""
_OFF, _ON = mujoco.mjtDisableBit, mujoco.mjtEnableBit
_FLAGS = {
    "mjModel.opt.disableflags": int(_OFF.mjDSBL_SPRING)
    | int(_OFF.mjDSBL_DAMPER)
    | int(_OFF.mjDSBL_GRAVITY),
    "mjModel.opt.enableflags": int(_ON.mjENBL_SLEEP),
}
"""Flags that matter likewise."""
_INT, _WORD = ctypes.c_int, ctypes.c_int64


def add_water(
    spec: mujoco.MjSpec,
    water: Water | Settings | None = None,
    *,
    instance: str = "sea",
    **options: Unpack[Options],
) -> None:
    """Put water into a model: compiled from `spec`, it floats wherever MuJoCo steps it, and its saved MJCF keeps the water.

    Args:
        spec: the model; all its bodies that move are in the water, but those that joined another instance.
        water: the sea, fresh and still at z = 0 if None; or `Settings`, which hold it and all options.
        instance: name of the plugin's instance in the model.
        options: any of the other fields of `Settings`: method, pressure, damping, added_mass, selection.

    Raises:
        ModelError: the model has an instance of that name.
        WaterError, MethodError: a wave or a method that MJCF cannot hold.
        EngineError: this MuJoCo is not as expected inside.
    """
    register()
    if any(plugin.name == instance for plugin in spec.plugins):
        raise ModelError(
            f"the model already has a plugin instance '{instance}'; give the water another name (instance=)"
        )
    settings = settings_with(water, options)
    config = write_plugin_config(settings)
    _remember(config, settings)
    spec.activate_plugin(PLUGIN)
    plugin = spec.add_plugin(name=instance, plugin_name=PLUGIN, active=True)
    plugin.config = config


def water_in(model: mujoco.MjModel, instance: str | None = None) -> Buoyancy:
    """The `Buoyancy` behind a plugin instance of a model: for the loads on its data, and to look at its hulls.

    Args:
        model: a model that brings its own water.
        instance: name of the instance; None for the only one.

    Raises:
        ModelError: there is no such instance; and all that `Buoyancy` raises.
    """
    with _lock:
        return _found(model._address, _instance(model, instance))


def _instance(model: mujoco.MjModel, name: str | None) -> int:
    """Index of an instance by name."""
    own = {
        mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, i) or "": i
        for i in plugin_instances(model)
    }
    if name is None and len(own) == 1:
        return next(iter(own.values()))
    if name is None or name not in own:
        raise ModelError(f"the model has no water named '{name or ''}'; {choices(name or '', own)}")
    return own[name]


# what the engine finds -----------------------------------------------------------------------------------


_lock = threading.RLock()
_waters: dict[bytes, Buoyancy] = {}
"""By what they are made of, the last used last."""
_reading = threading.local()
_remembered: dict[str, Settings] = {}
"""Settings that this process has put into models, by the spelling of their texts, the last one last."""


def _remember(config: dict[str, str], settings: Settings) -> None:
    """Keep settings that go into a model, so that they need not be read back from their texts."""
    with _lock:
        _remembered[_spelling(config)] = settings
        for oldest in list(_remembered)[:-REMEMBERED]:
            del _remembered[oldest]


def _spelling(texts: dict[str, str]) -> str:
    """The texts of a configuration in one."""
    return repr(sorted((key, text) for key, text in texts.items() if text))


def _resolve(model: int, data: int, instance: int) -> None:
    """Put the address of a record for a model into the engine's data."""
    # data made while a model is read, to look at its poses
    if getattr(_reading, "now", False):
        return
    with _lock:
        water = _found(model, instance).compiled
        slot = layout.word(data + layout.offset("mjData.plugin_data")) + 8 * instance
        record = layout.word(slot)
        if record and compiled.read_ids(record)[WATER] == water.address:
            compiled.read_ids(record)[MODEL] = model
            return
        if record:
            compiled.read_ids(record)[ALIVE] = 0
        _WORD.from_address(slot).value = water.record(model).address


def _found(model: int, instance: int) -> Buoyancy:
    """The water of an instance of the model at an address."""
    key = _key(model, instance)
    if key not in _waters:
        unused = [old for old, water in _waters.items() if not water.compiled.used]
        for old in unused[: max(0, len(unused) - KEPT)]:
            del _waters[old]
        _reading.now = True
        try:
            _waters[key] = _made(_copied(model), instance)
        finally:
            _reading.now = False
    _waters[key] = _waters.pop(key)
    return _waters[key]


def _made(model: mujoco.MjModel, instance: int) -> Buoyancy:
    """The water of an instance of a model, which it keeps."""
    if skips_passive(model.opt.disableflags):
        raise ModelError(
            "this model disables springs and dampers, and MuJoCo then skips the passive forces, the water's among them: "
            "enable one of them, <flag damper='enable'/>"
        )
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_PLUGIN, instance) or str(instance)
    texts = _texts(model._address, instance)
    settings = _remembered.get(_spelling(texts))
    if settings is None:
        settings = parse_plugin_config(texts, f"plugin '{PLUGIN}', instance '{name}'")
    # nobody lends this one as a control callback
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    return Buoyancy(model, settings, bodies=_joined(model, instance))


def _key(model: int, instance: int) -> bytes:
    """What the water of an instance is made of, in short."""
    digest = hashlib.blake2b(f"{instance} {_texts(model, instance)}".encode(), digest_size=16)
    for name in _READ:
        values = layout.content(f"mjModel.{name}", model)
        digest.update(len(values).to_bytes(8))
        digest.update(values)
    # the compiler disables other flags for a while
    for path, flags in _FLAGS.items():
        digest.update(
            str(ctypes.c_int.from_address(model + layout.offset(path)).value & flags).encode()
        )
    digest.update(ctypes.string_at(model + layout.offset("mjModel.opt.gravity"), 24))
    return digest.digest()


def _copied(model: int) -> mujoco.MjModel:
    """A copy of the engine's model at an address, as a Python object."""
    # a batch's models refer to the meshes of another
    error = ctypes.create_string_buffer(1000)
    whole = layout.function("mj_embedAssets", _WORD, _WORD, _WORD, _INT)(
        model, ctypes.addressof(error), len(error)
    )
    if not whole:
        raise ModelError(f"MuJoCo cannot copy the model to find its water: {error.value.decode()}")
    buffer = ctypes.create_string_buffer(layout.function("mj_sizeModel", _WORD, _WORD)(whole))
    layout.function("mj_saveModel", None, *[_WORD] * 4)(
        whole, 0, ctypes.addressof(buffer), len(buffer)
    )
    layout.function("mj_deleteModel", None, _WORD)(whole)
    return mujoco.MjModel.from_binary_path("model.mjb", {"model.mjb": buffer.raw})


def _texts(model: int, instance: int) -> dict[str, str]:
    """The configuration of an instance."""
    read = layout.function("mj_getPluginConfig", ctypes.c_char_p, _WORD, _INT, ctypes.c_char_p)
    return {key: (read(model, instance, key.encode()) or b"").decode() for key in KEYS}


def _joined(model: mujoco.MjModel, instance: int) -> tuple[int, ...] | None:
    """Bodies of an instance; None for all. What is welded to a body that joined is part of it."""
    own = plugin_instances(model)
    joined = model.body_plugin.copy()
    for body in range(1, model.nbody):
        parent = int(model.body_parentid[body])
        if joined[body] not in own and model.body_weldid[body] == model.body_weldid[parent]:
            joined[body] = joined[parent]
    if instance in joined:
        return tuple(np.flatnonzero(joined == instance).tolist())
    others = np.isin(joined, own)
    return tuple(np.flatnonzero(~others).tolist()) if others.any() else None


# registration --------------------------------------------------------------------------------------------


class _Plugin(ctypes.Structure):
    """MuJoCo's mjpPlugin, of mjplugin.h."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("nattribute", _INT),
        ("attributes", ctypes.POINTER(ctypes.c_char_p)),
        ("capabilityflags", _INT),
        ("needstage", _INT),
        *(
            (name, ctypes.c_void_p)
            for name in ("nstate", "nsensordata", "init", "destroy", "copy", "reset", "compute")
        ),
        *(
            (name, ctypes.c_void_p)
            for name in ("advance", "visualize", "actuator_act_dot", "sdf_distance", "sdf_gradient")
        ),
        *((name, ctypes.c_void_p) for name in ("sdf_staticdistance", "sdf_attribute", "sdf_aabb")),
    )


class _Engine:
    """The plugin as the engine knows it, never freed: data may be deleted after the interpreter has gone."""

    def __init__(self) -> None:
        compiled.require_known_layout()
        layout.verify(["mjData.plugin_data", *(f"mjModel.{name}" for name in _READ)])
        self._resolve = wrap_python(_resolve)
        self._context = Table(
            plugin_hooks.Context(
                layout.offset("mjData.plugin_data"),
                address_of(self._resolve),
                layout.symbol("mju_error"),
            )
        )
        bound = {"init", "destroy", "copy", "compute"}
        self._functions = {
            hook.__name__: Closure(
                hook, *([self._context.address] if hook.__name__ in bound else [])
            )
            for hook in plugin_hooks.HOOKS
        }
        self._attributes = (ctypes.c_char_p * len(KEYS))(*(key.encode() for key in KEYS))
        self._plugin = _Plugin(
            name=PLUGIN.encode(),
            nattribute=len(KEYS),
            attributes=self._attributes,
            capabilityflags=int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE),
            needstage=int(mujoco.mjtStage.mjSTAGE_VEL),
            **{name: closure.address for name, closure in self._functions.items()},
        )
        layout.function("mjp_registerPlugin", _INT, ctypes.c_void_p)(ctypes.addressof(self._plugin))
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))


@functools.cache
def register() -> None:
    """See that MuJoCo knows the plugin.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """
    _Engine()


try:
    register()
except EngineError as _error:
    warnings.warn(
        f"models cannot bring their own water here: {_error}", BuoyancyWarning, stacklevel=2
    )

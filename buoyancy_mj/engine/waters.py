"""Waters of models that bring their own; models that agree in what it is made of share one."""

import atexit
import collections
import contextlib
import ctypes
import dataclasses
import threading
from collections.abc import Iterator, Mapping

import mujoco

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.checks import skips_passive
from buoyancy_mj.engine.forks import make_lock
from buoyancy_mj.engine.instances import (
    PLUGIN,
    find_instance_bodies,
    find_instance_scope,
    instance_name,
)
from buoyancy_mj.engine.kept_scenes import keep_scenes
from buoyancy_mj.engine.model_memory import copy_model, fingerprint_model, read_config
from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.selection import rename_patterns
from buoyancy_mj.settings.config import parse_plugin_config
from buoyancy_mj.settings.settings import Settings

MOST_UNUSED = 32
"""Waters that are kept although no data use them, for a model whose data come and go."""
MOST_SETTINGS = 1024
"""Settings that are remembered; older ones are read from their texts."""

LOCK = make_lock()
"""Held while a water is looked up, made or attached to data: MuJoCo may ask from any thread."""
_waters: collections.OrderedDict[bytes, Buoyancy] = collections.OrderedDict()
"""Waters by the fingerprint of their models, the last used last."""
# data may be deleted after the interpreter has gone, and then write to records of their waters
atexit.register(ctypes.pythonapi.Py_IncRef, ctypes.py_object(_waters))
_settings: dict[str, Settings] = {}
"""Settings that this process has put into models, by their texts, the newest last."""
_thread = threading.local()


def remember_settings(config: Mapping[str, str], settings: Settings) -> None:
    """Keep settings that go into a model, so that they need not be read back from their texts."""
    with LOCK:
        _settings[_spell(config)] = settings
        for oldest in list(_settings)[:-MOST_SETTINGS]:
            del _settings[oldest]


def find_water(model: int, instance: int) -> Buoyancy:
    """The water of an instance of the model at an address; made if there is none yet.

    Raises:
        ModelError: the model skips passive forces; and all that `Buoyancy` raises.
    """
    with LOCK:
        key = fingerprint_model(model, instance)
        if key not in _waters:
            _drop_unused()
            keep_scenes()
            with _making_water():
                _waters[key] = _make_water(copy_model(model), instance)
        _waters.move_to_end(key)
        return _waters[key]


def is_making_water() -> bool:
    """Whether this thread makes a water now; data that it makes meanwhile need none."""
    return getattr(_thread, "makes_water", False)


@contextlib.contextmanager
def _making_water() -> Iterator[None]:
    _thread.makes_water = True
    try:
        yield
    finally:
        _thread.makes_water = False


def _make_water(model: mujoco.MjModel, instance: int) -> Buoyancy:
    """The water of an instance of a model, which it keeps."""
    if skips_passive(model.opt.disableflags):
        raise ModelError(
            "this model disables springs and dampers, and MuJoCo then skips the passive forces, "
            "the water's among them: enable one of them, <flag damper='enable'/>"
        )
    texts = read_config(model._address, instance)
    settings = _settings.get(_spell(texts))
    if settings is None:
        name = instance_name(model, instance) or instance
        settings = parse_plugin_config(texts, f"plugin '{PLUGIN}', instance '{name}'")

    # where it was attached, its patterns are those of its file
    scope = find_instance_scope(model, instance)
    selection = rename_patterns(settings.selection, scope.prefix, scope.suffix)
    settings = dataclasses.replace(settings, selection=selection)

    # nobody installs this one as a control callback
    model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    return Buoyancy(model, settings, bodies=find_instance_bodies(model, instance))


def _drop_unused() -> None:
    """Forget the waters that no data use and that were used longest ago, but for the last few."""
    unused = [key for key, water in _waters.items() if not water.compiled.used]
    for key in unused[: max(0, len(unused) - MOST_UNUSED)]:
        del _waters[key]


def _spell(texts: Mapping[str, str]) -> str:
    """The texts of a configuration as one, whatever their order."""
    return repr(sorted((key, text) for key, text in texts.items() if text))

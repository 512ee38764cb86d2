"""The water's plugin registered with MuJoCo: its compiled functions, and what they ask."""

import ctypes
import functools

import mujoco

from buoyancy_mj.engine import compiled, layout, library
from buoyancy_mj.engine.announced import Announced
from buoyancy_mj.engine.announcing import put_hooks
from buoyancy_mj.engine.c_functions import PythonFunction
from buoyancy_mj.engine.instances import PLUGIN
from buoyancy_mj.engine.late_hooks import make_hook
from buoyancy_mj.engine.model_memory import MODEL_ARRAYS
from buoyancy_mj.engine.waters import LOCK, find_water, is_making_water
from buoyancy_mj.kernels.entries import plugin_hooks
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.kernels.passes import ALIVE, MODEL, WATER
from buoyancy_mj.settings.config import INSTANCE, KEYS

_WORD = ctypes.c_int64


@functools.cache
def register() -> None:
    """Register the plugin with MuJoCo, once.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """
    _Engine()


def _resolve(model: int, data: int, instance: int) -> None:
    """Put the address of a record for a model into the engine's data."""
    # data made while a water is made, to look at the poses of its hulls
    if is_making_water():
        return
    with LOCK:
        water = find_water(model, instance).compiled
        slot = layout.word(data + layout.offset("mjData.plugin_data")) + 8 * instance
        record = layout.word(slot)
        if record and compiled.read_ids(record)[WATER] == water.address:
            compiled.read_ids(record)[MODEL] = model
            return
        # in this order, for Ctrl-C may come between
        _WORD.from_address(slot).value = water.record(model).address
        if record:
            compiled.read_ids(record)[ALIVE] = 0


class _Engine:
    """The plugin as the engine knows it.

    It is never freed, since data may be deleted after the interpreter has gone.
    """

    def __init__(self) -> None:
        compiled.require_known_layout()
        layout.verify(["mjData.plugin_data", *(f"mjModel.{name}" for name in MODEL_ARRAYS)])
        self._resolve = PythonFunction(_resolve)
        self._context = Table(
            plugin_hooks.Context(
                layout.offset("mjData.plugin_data"),
                self._resolve.address,
                library.symbol("mju_error"),
            )
        )
        bound = {"init", "destroy", "copy", "compute"}
        self._functions = {
            hook.__name__: make_hook(
                hook, *([self._context.address] if hook.__name__ in bound else [])
            )
            for hook in plugin_hooks.HOOKS
        }
        put_hooks(
            Announced(
                PLUGIN,
                (*KEYS, INSTANCE),
                int(mujoco.mjtPluginCapabilityBit.mjPLUGIN_PASSIVE),
                int(mujoco.mjtStage.mjSTAGE_VEL),
            ),
            {name: closure.address for name, closure in self._functions.items()},
        )
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

"""Water installed as a callback of MuJoCo, beside the callback that is there already."""

import contextlib
import ctypes
from collections.abc import Callable, Iterator
from typing import Any, Protocol

import mujoco

from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.engine.checks import check_actuation, skips_passive
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.engine.instances import PLUGIN, plugin_instances
from buoyancy_mj.errors import EngineError, ModelError
from buoyancy_mj.kernels.entries.closures import Closure

_ENGINE_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_installed: dict[int, tuple["Installable", ...]] = {}
"""The waters that act in a callback, by the identity of the callback."""


class Installable(Protocol):
    """Water that can act as a callback."""

    model: mujoco.MjModel

    @property
    def compiled(self) -> CompiledWater:
        """What compiled code needs of this water."""
        ...

    def act(self, data: mujoco.MjData) -> None:
        """Add the water's forces to the passive forces of `data`, in Python."""
        ...


@contextlib.contextmanager
def install(water: Installable, native: bool | None, *, copies: bool) -> Iterator[None]:
    """Install a water as a callback of MuJoCo, and put the old callback back at the end.

    Args:
        water: the water; installed already, it changes nothing.
        native: whether as a compiled C function; None where it can be.
        copies: whether to act on copies of its model too.

    Raises:
        ModelError: the model disables actuation, or brings its own water.
        EngineError: `native` or `copies` is asked for and cannot be.
    """
    # the model must call it, and call it once
    check_actuation(water.model)
    if plugin_instances(water.model):
        raise ModelError(
            f"this model brings its own water, as the plugin '{PLUGIN}', and a callback would "
            "double it: leave out the one or the other"
        )
    if is_installed(water):
        yield
        return

    # the callback that was there runs before the water
    slot = "control" if skips_passive(water.model.opt.disableflags) else "passive"
    previous = getattr(mujoco, f"get_mjcb_{slot}")()
    set_callback = getattr(mujoco, f"set_mjcb_{slot}")
    closure = _compiled(water, slot, previous, native, copies=copies)
    callback = _in_python(water, previous) if closure is None else _ENGINE_FUNCTION(closure.address)
    _installed[id(callback)] = (*_installed.get(id(previous), ()), water)

    set_callback(callback)
    try:
        yield
    finally:
        set_callback(previous)
        del _installed[id(callback)]


def is_installed(water: Installable) -> bool:
    """Whether MuJoCo has a callback of this water now."""
    now = mujoco.get_mjcb_passive(), mujoco.get_mjcb_control()
    return any(water is other for callback in now for other in _installed.get(id(callback), ()))


def _compiled(
    water: Installable, slot: str, previous: Any, native: bool | None, *, copies: bool
) -> Closure | None:
    """The callback as a C function; None where Python serves, or must."""
    try:
        if native is False:
            raise EngineError("native=False asks for a callback in Python")
        if slot == "control":
            raise EngineError(
                "the model disables springs and dampers, and MuJoCo then skips its passive forces"
            )
        if previous is not None and not hasattr(previous, "argtypes"):
            raise EngineError("a callback in Python is installed as mjcb_passive; remove it first")
        return water.compiled.callback(
            0 if previous is None else address_of(previous), copies=copies
        )
    except EngineError as error:
        if native:
            raise EngineError(f"the water cannot act as compiled code: {error}") from error
        if copies:
            raise EngineError(
                f"copies of a model are known to compiled code alone: {error}"
            ) from error
        return None


def _in_python(
    water: Installable, previous: Any
) -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """The callback in Python: first the one that was there, then the water on its own model."""

    def callback(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if hasattr(previous, "argtypes"):
            previous(model._address, data._address)
        elif previous is not None:
            previous(model, data)
        if model._address == water.model._address:
            water.act(data)

    return callback

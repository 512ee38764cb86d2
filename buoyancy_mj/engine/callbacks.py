"""How water is lent to MuJoCo as one of its callbacks, beside whoever is there already."""

import contextlib
import ctypes
from collections.abc import Callable, Iterator
from typing import Any, Protocol

import mujoco

from buoyancy_mj.engine import layout
from buoyancy_mj.engine.c_functions import address_of
from buoyancy_mj.engine.compiled import CompiledWater
from buoyancy_mj.errors import EngineError, ModelError
from buoyancy_mj.kernels.entries.closures import Closure

PLUGIN = "buoyancy_mj.water"
"""Name of the engine plugin by which a model brings its own water, see `plugin`."""
_ENGINE_FUNCTION = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
_lent: dict[int, tuple["Lendable", ...]] = {}
"""What acts in a callback, by the identity of the callback, while it is lent."""


class Lendable(Protocol):
    """Water that can act as a callback."""

    model: mujoco.MjModel

    @property
    def compiled(self) -> CompiledWater:
        """For compiled code."""
        ...

    def act(self, data: mujoco.MjData) -> None:
        """Add to the passive forces of `data`, as Python code."""
        ...


@contextlib.contextmanager
def lend(water: Lendable, native: bool | None, *, copies: bool) -> Iterator[None]:
    """Lend `water` to MuJoCo, see `Buoyancy.installed`."""
    refuse_actuation(water.model)
    if plugin_instances(water.model):
        raise ModelError(
            f"this model brings its own water, as the plugin '{PLUGIN}', and a callback would "
            "double it: leave out the one or the other"
        )
    if is_lent(water):
        yield
        return
    slot = "control" if skips_passive(water.model.opt.disableflags) else "passive"
    previous = getattr(mujoco, f"get_mjcb_{slot}")()
    lend = getattr(mujoco, f"set_mjcb_{slot}")
    closure = _compiled(water, slot, previous, native, copies=copies)
    callback = _in_python(water, previous) if closure is None else _ENGINE_FUNCTION(closure.address)
    _lent[id(callback)] = (*_lent.get(id(previous), ()), water)
    lend(callback)
    try:
        yield
    finally:
        lend(previous)
        del _lent[id(callback)]


def is_lent(water: Lendable) -> bool:
    """Whether it is lent, and MuJoCo would call it now."""
    now = mujoco.get_mjcb_passive(), mujoco.get_mjcb_control()
    return any(water is other for callback in now for other in _lent.get(id(callback), ()))


def plugin_instances(model: mujoco.MjModel) -> list[int]:
    """Indices of the plugin instances by which a model brings its own water."""
    at = ctypes.c_int(-1)
    find = layout.function("mjp_getPlugin", ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p)
    find(PLUGIN.encode(), ctypes.addressof(at))
    return [] if at.value < 0 else [i for i in range(model.nplugin) if model.plugin[i] == at.value]


def skips_passive(disableflags: int) -> bool:
    """Whether MuJoCo skips the passive forces of a model with these flags, ours among them."""
    both = int(mujoco.mjtDisableBit.mjDSBL_SPRING) | int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
    return disableflags & both == both


def refuse_actuation(model: mujoco.MjModel) -> None:
    """Refuse a model for which MuJoCo would skip a control callback, without a word.

    Raises:
        ModelError: it disables actuation.
    """
    if model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_ACTUATION:
        raise ModelError(
            "this model disables actuation, and MuJoCo then skips the control callback through "
            "which water acts: remove <flag actuation='disable'/>, and disable single actuators "
            "by <option actuatorgroupdisable> instead, or put the water into the model (add_water)"
        )


def _compiled(
    water: Lendable, slot: str, previous: Any, native: bool | None, *, copies: bool
) -> Closure | None:
    """The callback as a C function; None where it is not wanted, or cannot be and need not."""
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


def _in_python(water: Lendable, previous: Any) -> Callable[[mujoco.MjModel, mujoco.MjData], None]:
    """The callback in Python: first the previous one, then the water on its own model."""

    def callback(model: mujoco.MjModel, data: mujoco.MjData) -> None:
        if hasattr(previous, "argtypes"):
            previous(model._address, data._address)
        elif previous is not None:
            previous(model, data)
        if model._address == water.model._address:
            water.act(data)

    return callback

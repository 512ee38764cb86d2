"""`announce`: MuJoCo knows the plugins before anything else of this package is imported.

`import mujoco` calls it, where this package is installed, by an entry point of the group
`mujoco.plugins`; and so does `import buoyancy_mj`. An announced plugin has its name, its keys and
the first hooks that MuJoCo calls of any. These import Numba, the kernels and the rest, by which the
compiled hooks take their place in MuJoCo's table.
"""

import contextlib
import ctypes
import functools
import importlib
import itertools
import warnings
from collections.abc import Mapping
from typing import Any

from buoyancy_mj.engine.announced import PLUGINS, Announced
from buoyancy_mj.engine.kept_scenes import keep_scenes
from buoyancy_mj.engine.plugin_struct import find_plugin, register_plugin, replace_hooks
from buoyancy_mj.errors import BuoyancyWarning, EngineError
from buoyancy_mj.hulls.plugins import note_plugin

_WORD, _INT = ctypes.c_void_p, ctypes.c_int
_COUNT = ctypes.CFUNCTYPE(_INT, _WORD, _INT)
"""MuJoCo's nstate; what nsensordata is given besides goes unread."""
_INIT = ctypes.CFUNCTYPE(_INT, _WORD, _WORD, _INT)
_hooks: list[Any] = []
"""The first hooks, which must live for ever."""
_compiled: set[str] = set()
"""Plugins that have their compiled hooks."""
_raised: list[BaseException] = []
"""What the import raised while MuJoCo asked for a number, which it cannot be refused."""


@functools.cache
def announce() -> None:
    """Tell MuJoCo of all plugins of this package, once; it warns where that cannot be."""
    try:
        for plugin in PLUGINS:
            slot = find_plugin(plugin.name)
            if slot < 0:
                slot = register_plugin(*plugin[:4], _make_first_hooks(plugin))
            note_plugin(plugin.name, slot, plugin.keys)
    except EngineError as error:
        warnings.warn(
            f"models cannot bring their own water here: {error}", BuoyancyWarning, stacklevel=2
        )


def load_plugins() -> None:
    """Import all that stands behind the plugins, so that MuJoCo has their compiled hooks."""
    importlib.import_module("buoyancy_mj.vehicle.plugins")
    keep_scenes()


def put_hooks(plugin: Announced, functions: Mapping[str, int]) -> int:
    """Put the compiled hooks of a plugin in the place of the first ones.

    Args:
        plugin: what it was announced as.
        functions: addresses of C functions, as those of `plugin_struct.register_plugin`.

    Returns:
        Its number, by which models refer to it.

    Raises:
        ValueError: it was announced as something else.
    """
    if plugin not in PLUGINS:
        raise ValueError(f"{plugin} is not what engine.announced says of it; correct it there")
    announce()
    slot = find_plugin(plugin.name)
    replace_hooks(slot, functions)
    _compiled.add(plugin.name)
    return slot


def _make_first_hooks(plugin: Announced) -> dict[str, int]:
    """Hooks that import the rest, by the names that MuJoCo has for them."""
    hooks = {"nstate": _make_count(plugin.states), "init": _make_init(plugin.name)}
    if plugin.numbers:
        hooks["nsensordata"] = _make_count(plugin.numbers)
    _hooks.extend(hooks.values())
    return {name: ctypes.cast(hook, _WORD).value or 0 for name, hook in hooks.items()}


def _make_count(number: int) -> Any:
    """A C function that imports the rest and answers a number.

    A signal may raise before the first line of a function of Python, and what that answers then is
    anything. So the function of Python answers nothing, and iterators of C give the number.
    """
    importing = ctypes.CFUNCTYPE(None, _WORD, _INT)(_import_rest)
    importing.restype = functools.partial(next, itertools.repeat(number))
    return _COUNT(importing)


def _import_rest(_model: int, _instance: int) -> None:
    """Import the rest; what that raises is kept for the hook that may fail."""
    try:
        load_plugins()
    except BaseException as error:
        _raised.append(error)


def _make_init(name: str) -> Any:
    """The first `init` of a plugin, which MuJoCo calls only where the import failed before.

    If it succeeds now, the first pass over the data finds what the compiled one would have put.
    """

    def init(_: int, data: int, instance: int) -> int:
        try:
            if _raised:
                raise _raised[-1]
            load_plugins()
            _clear_slot(data, instance)
        except BaseException as error:
            _tell(error)
            return -1
        return 0 if name in _compiled else -1

    return _INIT(init)


def _clear_slot(data: int, instance: int) -> None:
    """Say in the data of MuJoCo at an address that an instance keeps nothing there yet."""
    from buoyancy_mj.engine import layout

    records = layout.word(data + layout.offset("mjData.plugin_data"))
    ctypes.c_int64.from_address(records + 8 * instance).value = 0


def _tell(error: BaseException) -> None:
    """Tell why there can be no water; MuJoCo tells only that there is none."""
    _raised.clear()
    said = str(error) or type(error).__name__
    with contextlib.suppress(Warning):
        warnings.warn(
            f"models cannot bring their own water here: {said}", BuoyancyWarning, stacklevel=2
        )

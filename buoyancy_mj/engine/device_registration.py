"""Thrusters, tanks and sensors as plugins of the engine: how a kind of them is registered.

A kind says what its numbers mean and which kernels are at work. All kinds share the C functions of
`kernels.entries.device_hooks`. MuJoCo calls only compiled functions, from any thread. Python is
asked once for each device of each mjData, see `engine.devices`.
"""

import ctypes
import functools
from collections.abc import Callable
from typing import Any

from buoyancy_mj.engine import compiled, layout, library, presence
from buoyancy_mj.engine.announced import Announced
from buoyancy_mj.engine.announcing import put_hooks
from buoyancy_mj.engine.c_functions import PythonFunction
from buoyancy_mj.engine.device_kinds import KINDS, DeviceKind
from buoyancy_mj.engine.devices import resolve_device
from buoyancy_mj.engine.late_hooks import make_hook
from buoyancy_mj.kernels.entries import device_hooks
from buoyancy_mj.kernels.entries.closures import Closure
from buoyancy_mj.kernels.entries.views import Table


def register_kind(kind: DeviceKind) -> None:
    """Register a kind with MuJoCo.

    Raises:
        EngineError: this MuJoCo is not as expected inside.
    """
    hooks = _hooks()
    functions = dict(hooks.functions)
    functions["nstate"] = hooks.count(device_hooks.count, kind.states)
    functions["reset"] = hooks.count(device_hooks.reset, kind.states)
    if kind.numbers:
        functions["nsensordata"] = hooks.count(device_hooks.count_readings, kind.numbers)
    plugin = Announced(
        kind.plugin,
        kind.keys,
        int(kind.capability),
        int(kind.stage),
        kind.states,
        kind.numbers,
    )
    KINDS[put_hooks(plugin, functions)] = kind


class _Hooks:
    """The C functions that all kinds share.

    They are never freed, since data may be deleted after the interpreter has gone.
    """

    def __init__(self) -> None:
        compiled.require_known_layout()
        self._resolve = PythonFunction(resolve_device)
        self._context = Table(
            device_hooks.DeviceContext(
                layout.offset("mjData.plugin_data"),
                self._resolve.address,
                presence.CHANGES,
                library.symbol("mju_error"),
            )
        )
        self._closures = [make_hook(hook, self._context.address) for hook in device_hooks.BOUND]
        self._counts: dict[tuple[Any, int], Closure] = {}
        self.functions = {
            hook.__name__: closure.address
            for hook, closure in zip(device_hooks.BOUND, self._closures, strict=True)
        }
        """Addresses by the names that MuJoCo has for them."""
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

    def count(self, hook: Callable[..., Any], number: int) -> int:
        """Address of a hook that a number is bound to."""
        key = hook, number
        if key not in self._counts:
            self._counts[key] = make_hook(hook, number)
        address: int = self._counts[key].address
        return address


@functools.cache
def _hooks() -> _Hooks:
    return _Hooks()

"""Hooks of plugins that are compiled, or read from an earlier run, when MuJoCo first calls one.

So whoever imports this package does not wait for a compiler.
"""

import functools
from collections.abc import Callable
from typing import Any

from buoyancy_mj.engine import library
from buoyancy_mj.engine.c_functions import PythonFunction
from buoyancy_mj.kernels.entries.closures import Closure, Late, compile_kernel

_late: dict[int, tuple[Callable[..., Any], Closure]] = {}
"""Kernels and the hooks that call them, by the addresses of the words that `Closure.target` is."""


def make_hook(kernel: Callable[..., Any], *bound: int) -> Closure:
    """A C function that calls a kernel with numbers bound to it; it must live for ever."""
    hook = Closure(kernel, *bound, late=_links())
    _late[hook.target_address] = kernel, hook
    return hook


def _compile(target: int, _: int, __: int) -> None:
    """Compile the kernel of a hook, and those of its module.

    MuJoCo may free data when Python has gone, and what it calls then must be there.
    """
    module = _late[target][0].__module__
    for kernel, hook in list(_late.values()):
        if kernel.__module__ == module:
            hook.target.value = compile_kernel(kernel).address


_compiler = functools.cache(lambda: PythonFunction(_compile))
"""Kept as long as the process runs."""


def _links() -> Late:
    return Late(_compiler().address, library.symbol("mju_error"))

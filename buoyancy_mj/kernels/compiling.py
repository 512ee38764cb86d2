"""How kernels are compiled: Numba's decorators, without what kernels do not need.

Beside each function Numba compiles a wrapper for C, which only `entries.closures` has a use for,
and one for Python. And it counts references to arrays wherever a function may make some: then a
NamedTuple of a hundred arrays costs much, to compile and to pass on.
"""

from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba import extending

F = TypeVar("F", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[F], F]:
    """Numba's `njit` for a kernel, which may make arrays unless `_nrt=False` says otherwise."""
    decorate: Callable[[F], F] = numba.njit(**{"no_cfunc_wrapper": True, "_nrt": True} | options)
    return decorate


def inner(function: F) -> F:
    """Compile a kernel that makes no arrays and that only kernels call.

    There is no way to it from Python: a call from there ends the process.
    """
    return njit(cache=True, error_model="numpy", _nrt=False, no_cpython_wrapper=True)(function)


def register_jitable(**options: Any) -> Callable[[F], F]:
    """Numba's `register_jitable`, for a function that makes no arrays unless its callers may."""
    decorate: Callable[[F], F] = extending.register_jitable(no_cfunc_wrapper=True, **options)
    return decorate

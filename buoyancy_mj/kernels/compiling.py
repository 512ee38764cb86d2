"""How kernels are compiled: Numba's decorators, without what kernels do not need.

Beside each function Numba compiles a wrapper for C, which only `entries.closures` has a use for,
and one for Python. And it counts references to arrays wherever a function may make some: then a
NamedTuple of a hundred arrays costs much, to compile and to pass on.
"""

from typing import Any

import numba
from numba import extending


def njit(**options: Any) -> Any:
    """Numba's `njit` for a kernel, which may make arrays unless `_nrt=False` says otherwise."""
    return numba.njit(**{"no_cfunc_wrapper": True, "_nrt": True} | options)


def inner(function: Any) -> Any:
    """Compile a kernel that makes no arrays and that only kernels call.

    There is no way to it from Python: a call from there ends the process.
    """
    return njit(cache=True, error_model="numpy", _nrt=False, no_cpython_wrapper=True)(function)


def inlined(function: Any) -> Any:
    """Compile a kernel that makes no arrays, and have the compiler put it into all its callers.

    Numba's `inline="always"` does so before it looks for types, which takes long in large callers;
    it alone gives callers' `fastmath` to what is put into them.
    """
    return njit(cache=True, error_model="numpy", _nrt=False, forceinline=True)(function)


def register_jitable(**options: Any) -> Any:
    """Numba's `register_jitable`, for a function that makes no arrays unless its callers may."""
    return extending.register_jitable(no_cfunc_wrapper=True, **options)

"""Kernels as C functions with numbers bound to them, which C function pointers cannot carry."""

import functools
from collections.abc import Callable
from typing import Any

import llvmlite.binding as llvm
import numba
from llvmlite import ir

_WORD = ir.IntType(64)
_TYPES = {numba.int64: _WORD, numba.int32: ir.IntType(32), numba.void: ir.VoidType()}


class Closure:
    """The C function f(...) that calls a kernel as kernel(..., *bound) and returns what it gives.

    The annotations of the kernel's arguments and of what it gives are Numba's types; pointers and
    bound numbers are 64-bit words. The function takes no lock and knows no Python. Its code lives
    as long as this object.
    """

    def __init__(self, kernel: Callable[..., Any], *bound: int) -> None:
        target = _WORD(compile_kernel(kernel).address)
        result, kinds = _signature(kernel)
        module = ir.Module()
        free = [_TYPES[kind] for kind in kinds[: len(kinds) - len(bound)]]
        closed = ir.Function(module, ir.FunctionType(_TYPES[result], free), "closed")
        builder = ir.IRBuilder(closed.append_basic_block())
        kind = ir.FunctionType(_TYPES[result], free + [_WORD] * len(bound))
        returned = builder.call(
            builder.inttoptr(target, kind.as_pointer()),
            [*closed.args, *(_WORD(number) for number in bound)],
        )
        if result == numba.void:
            builder.ret_void()
        else:
            builder.ret(returned)
        self._engine = load_module(module)
        self.address = self._engine.get_function_address("closed")
        """Of the function."""


def load_module(module: ir.Module) -> Any:
    """Machine code of a module, by which its functions have addresses; it lives as long as that."""
    engine = llvm.create_mcjit_compiler(
        llvm.parse_assembly(str(module)), _machine().create_target_machine()
    )
    engine.finalize_object()
    return engine


@functools.cache
def compile_kernel(kernel: Callable[..., Any]) -> Any:
    """A kernel as a C function with its `address`, compiled or read from an earlier run."""
    result, kinds = _signature(kernel)
    return numba.cfunc(result(*kinds), cache=True)(kernel)


def _signature(kernel: Callable[..., Any]) -> tuple[Any, list[Any]]:
    """What a kernel gives, and its arguments, as Numba's types."""
    *kinds, result = kernel.__annotations__.values()
    return result, kinds


@functools.cache
def _machine() -> llvm.Target:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple()

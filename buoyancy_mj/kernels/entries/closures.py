"""Kernels as C functions with numbers bound to them, which C function pointers cannot carry."""

import ctypes
import functools
from collections.abc import Callable
from typing import Any, NamedTuple

import llvmlite.binding as llvm
import numba
from llvmlite import ir

_WORD = ir.IntType(64)
_TYPES = {numba.int64: _WORD, numba.int32: ir.IntType(32), numba.void: ir.VoidType()}


class Late(NamedTuple):
    """Who compiles a kernel when its C function is first called: addresses of C functions."""

    compile: int
    """f(address of a word, 0, 0), which writes there where the compiled kernel is; it returns 0, or
    the address of a text that tells why it cannot."""
    error: int
    """MuJoCo's mju_error, which is given that text."""


class Closure:
    """The C function f(...) that calls a kernel as kernel(..., *bound) and returns what it gives.

    The annotations of the kernel's arguments and of what it gives are Numba's types; pointers and
    bound numbers are 64-bit words. The function takes no lock and knows no Python. Its code lives
    as long as this object.

    Args:
        kernel: the kernel.
        bound: numbers for its last arguments.
        late: who compiles it when the function is first called; now if None.
    """

    def __init__(self, kernel: Callable[..., Any], *bound: int, late: Late | None = None) -> None:
        self.target = ctypes.c_int64(0 if late else compile_kernel(kernel).address)
        """Address of the compiled kernel; 0 for none yet."""
        self.target_address = ctypes.addressof(self.target)
        """Where that stands."""
        result, kinds = _signature(kernel)
        module = ir.Module()
        free = [_TYPES[kind] for kind in kinds[: len(kinds) - len(bound)]]
        closed = ir.Function(module, ir.FunctionType(_TYPES[result], free), "closed")
        builder = ir.IRBuilder(closed.append_basic_block())
        place = builder.inttoptr(_WORD(self.target_address), _WORD.as_pointer())
        if late:
            _compile_once(builder, place, late, _TYPES[result])
        kind = ir.FunctionType(_TYPES[result], free + [_WORD] * len(bound))
        returned = builder.call(
            builder.inttoptr(builder.load(place), kind.as_pointer()),
            [*closed.args, *(_WORD(number) for number in bound)],
        )
        if result == numba.void:
            builder.ret_void()
        else:
            builder.ret(returned)
        self._engine = load_module(module)
        self.address = self._engine.get_function_address("closed")
        """Of the function."""


def _compile_once(builder: ir.IRBuilder, place: ir.Value, late: Late, result: ir.Type) -> None:
    """Let a function compile its kernel where none is, and return nothing if that fails."""
    word_of_three = ir.FunctionType(_WORD, [_WORD] * 3).as_pointer()
    with builder.if_then(builder.icmp_signed("==", builder.load(place), _WORD(0)), likely=False):
        text = builder.call(
            builder.inttoptr(_WORD(late.compile), word_of_three),
            [builder.ptrtoint(place, _WORD), _WORD(0), _WORD(0)],
        )
        with builder.if_then(builder.icmp_signed("!=", text, _WORD(0))):
            tell = ir.FunctionType(ir.VoidType(), [_WORD]).as_pointer()
            builder.call(builder.inttoptr(_WORD(late.error), tell), [text])
            if isinstance(result, ir.VoidType):
                builder.ret_void()
            else:
                builder.ret(result(0))


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
    return numba.cfunc(result(*kinds), cache=True, _nrt=False)(kernel)


def _signature(kernel: Callable[..., Any]) -> tuple[Any, list[Any]]:
    """What a kernel gives, and its arguments, as Numba's types."""
    *kinds, result = kernel.__annotations__.values()
    return result, kinds


@functools.cache
def _machine() -> llvm.Target:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple()

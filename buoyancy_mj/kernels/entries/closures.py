"""Compiled functions with numbers bound to them: what a C function pointer cannot carry else."""

import ctypes
import functools
from typing import Any

import llvmlite.binding as llvm
from llvmlite import ir

_WORD, _INT = ir.IntType(64), ir.IntType(32)
_TYPES: dict[Any, ir.Type] = {ctypes.c_int64: _WORD, ctypes.c_int: _INT, None: ir.VoidType()}


class Closure:
    """The C function f(...) that calls the compiled function at `target` as target(..., *bound) and returns what it gives.

    It takes no lock and knows no Python. Its code lives as long as this object.
    """

    def __init__(
        self, target: int, result: type | None, arguments: tuple[type, ...], *bound: int
    ) -> None:
        """Compile it.

        Args:
            target: address of the function called; pointers and bound numbers are 64-bit words to it.
            result: ctypes.c_int, ctypes.c_int64 or None.
            arguments: of those types.
            bound: appended to the arguments.
        """
        kinds = [_TYPES[kind] for kind in arguments]
        module = ir.Module()
        closed = ir.Function(module, ir.FunctionType(_TYPES[result], kinds), "closed")
        builder = ir.IRBuilder(closed.append_basic_block())
        kind = ir.FunctionType(_TYPES[result], kinds + [_WORD] * len(bound))
        called = builder.inttoptr(_WORD(target), kind.as_pointer())
        returned = builder.call(called, [*closed.args, *(_WORD(number) for number in bound)])
        if result is None:
            builder.ret_void()
        else:
            builder.ret(returned)
        self._engine = llvm.create_mcjit_compiler(
            llvm.parse_assembly(str(module)), _machine().create_target_machine()
        )
        self._engine.finalize_object()
        self.address = self._engine.get_function_address("closed")
        """Of the function."""


@functools.cache
def _machine() -> llvm.Target:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple()

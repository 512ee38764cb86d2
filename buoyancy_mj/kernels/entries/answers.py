"""What a C function answers that may end without an answer."""

import ctypes

from llvmlite import ir

from buoyancy_mj.kernels.entries.closures import load_module

_WORD = ir.IntType(64)


class Answering:
    """The C function f(first, second, third) that returns what another writes.

    It calls the function at `target`, f(first, second, third, address), and returns the word at the
    address, in which the target finds `silence`. A function of Python whose first lines a signal
    interrupts returns garbage, but writes nothing. It is never freed.
    """

    def __init__(self, silence: int) -> None:
        self.target = ctypes.c_int64(0)
        """Address of the other function."""
        module = ir.Module()
        function = ir.Function(module, ir.FunctionType(_WORD, [_WORD] * 3), "answering")
        builder = ir.IRBuilder(function.append_basic_block())
        kind = ir.FunctionType(ir.VoidType(), [_WORD] * 4).as_pointer()
        held = builder.inttoptr(_WORD(ctypes.addressof(self.target)), _WORD.as_pointer())
        place = builder.alloca(_WORD)
        builder.store(_WORD(silence), place)
        builder.call(
            builder.inttoptr(builder.load(held), kind),
            [*function.args, builder.ptrtoint(place, _WORD)],
        )
        builder.ret(builder.load(place))
        self._engine = load_module(module)
        self.address = self._engine.get_function_address("answering")
        """Of the function."""
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))

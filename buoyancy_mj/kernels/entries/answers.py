"""What a C function answers that may end without an answer."""

from llvmlite import ir

from buoyancy_mj.kernels.entries.closures import load_module

_WORD = ir.IntType(64)


class Answering:
    """The C function f(first, second, third) that returns what another writes.

    It calls target(first, second, third, address) and returns the word at the address, in which the
    target finds `silence`. A function of Python whose first lines a signal interrupts returns
    garbage, but writes nothing. The code lives as long as this object.
    """

    def __init__(self, target: int, silence: int) -> None:
        module = ir.Module()
        function = ir.Function(module, ir.FunctionType(_WORD, [_WORD] * 3), "answering")
        builder = ir.IRBuilder(function.append_basic_block())
        place = builder.alloca(_WORD)
        builder.store(_WORD(silence), place)
        kind = ir.FunctionType(ir.VoidType(), [_WORD] * 4)
        builder.call(
            builder.inttoptr(_WORD(target), kind.as_pointer()),
            [*function.args, builder.ptrtoint(place, _WORD)],
        )
        builder.ret(builder.load(place))
        self._engine = load_module(module)
        self.address = self._engine.get_function_address("answering")
        """Of the function."""

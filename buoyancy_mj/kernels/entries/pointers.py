"""Words at an address, C functions at an address, and a flag that threads share."""

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from buoyancy_mj.kernels.compiling import njit

_WORD = ir.IntType(64)


@intrinsic
def call(typing, function, words):
    """Call the C function at an address with a tuple of words; it returns one.

    A function may take fewer words, or return none.
    """
    count = len(words)

    def code(context, builder, signature, args):
        kind = ir.FunctionType(_WORD, [_WORD] * count)
        values = [builder.extract_value(args[1], n) for n in range(count)]
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), values)

    return types.int64(types.int64, types.UniTuple(types.int64, count)), code


@intrinsic
def call_number(typing, function, words):
    """Call the C function at an address with a tuple of words; it returns a double."""
    count = len(words)

    def code(context, builder, signature, args):
        kind = ir.FunctionType(ir.DoubleType(), [_WORD] * count)
        values = [builder.extract_value(args[1], n) for n in range(count)]
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), values)

    return types.float64(types.int64, types.UniTuple(types.int64, count)), code


@intrinsic
def add_to_word(typing, address, value):
    """Add to the word at an address at one go with all threads; what it was."""

    def code(context, builder, signature, args):
        place = builder.inttoptr(args[0], ir.IntType(64).as_pointer())
        return builder.atomic_rmw("add", place, args[1], "seq_cst")

    return types.int64(types.int64, types.int64), code


@intrinsic
def exchange(typing, address, value):
    """Set the word at an address at one go with all threads; what it was."""

    def code(context, builder, signature, args):
        place = builder.inttoptr(args[0], _WORD.as_pointer())
        return builder.atomic_rmw("xchg", place, args[1], "seq_cst")

    return types.int64(types.int64, types.int64), code


@intrinsic
def word(typing, address):
    """The 64-bit word at an address."""

    def code(context, builder, signature, args):
        return builder.load(builder.inttoptr(args[0], _WORD.as_pointer()))

    return types.int64(types.int64), code


@njit(cache=True, error_model="numpy", _nrt=False, inline="always")
def integers(address):
    """The two 32-bit integers at an address."""
    both = word(address)
    return (both << 32) >> 32, both >> 32


@intrinsic
def set_word(typing, address, value):
    """Set the 64-bit word at an address."""

    def code(context, builder, signature, args):
        builder.store(args[1], builder.inttoptr(args[0], _WORD.as_pointer()))
        return context.get_dummy_value()

    return types.void(types.int64, types.int64), code

"""Words at an address, C functions at an address, and a flag that threads share."""

import numpy as np
from llvmlite import ir
from numba import carray, njit, types
from numba.extending import intrinsic


@intrinsic
def pointer(typing, address):
    """An address as a pointer."""

    def code(context, builder, signature, args):
        return builder.inttoptr(args[0], context.get_value_type(signature.return_type))

    return types.voidptr(types.int64), code


@intrinsic
def call(typing, function, words):
    """Call the C function at an address with a tuple of words; it returns one.

    A function may take fewer words, or return none.
    """
    count = len(words)

    def code(context, builder, signature, args):
        word = ir.IntType(64)
        kind = ir.FunctionType(word, [word] * count)
        values = [builder.extract_value(args[1], n) for n in range(count)]
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), values)

    return types.int64(types.int64, types.UniTuple(types.int64, count)), code


@intrinsic
def call_number(typing, function, words):
    """Call the C function at an address with a tuple of words; it returns a double."""
    count = len(words)

    def code(context, builder, signature, args):
        word = ir.IntType(64)
        kind = ir.FunctionType(ir.DoubleType(), [word] * count)
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
        place = builder.inttoptr(args[0], ir.IntType(64).as_pointer())
        return builder.atomic_rmw("xchg", place, args[1], "seq_cst")

    return types.int64(types.int64, types.int64), code


@njit(cache=True, error_model="numpy", inline="always")
def word(address):
    """The 64-bit word at an address."""
    return carray(pointer(address), (1,), np.int64)[0]


@njit(cache=True, error_model="numpy", inline="always")
def set_word(address, value):
    """Set the 64-bit word at an address."""
    carray(pointer(address), (1,), np.int64)[0] = value

"""Words and arrays at an address, C functions at an address, and a flag that threads share.

A table is a row of 64-bit words: three for each array, its address, rows and columns.
"""

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
def call(typing, function, first, second, third, fourth):
    """Call the C function at an address with four words; it gives one. What takes fewer or gives none does not mind."""

    def code(context, builder, signature, args):
        word = ir.IntType(64)
        kind = ir.FunctionType(word, [word] * 4)
        return builder.call(builder.inttoptr(args[0], kind.as_pointer()), args[1:])

    return types.int64(*[types.int64] * 5), code


@intrinsic
def take(typing, address):
    """Set the word at an address to 1 at one go with all threads; what it was."""

    def code(context, builder, signature, args):
        word = ir.IntType(64)
        return builder.atomic_rmw(
            "xchg", builder.inttoptr(args[0], word.as_pointer()), word(1), "seq_cst"
        )

    return types.int64(types.int64), code


@intrinsic
def give(typing, address):
    """Set it back to 0."""

    def code(context, builder, signature, args):
        word = ir.IntType(64)
        return builder.atomic_rmw(
            "xchg", builder.inttoptr(args[0], word.as_pointer()), word(0), "seq_cst"
        )

    return types.int64(types.int64), code


@njit(cache=True, error_model="numpy", inline="always")
def word(address):
    """The 64-bit word at an address."""
    return carray(pointer(address), (1,), np.int64)[0]


@njit(cache=True, error_model="numpy", inline="always")
def number(address):
    """The double at an address."""
    return carray(pointer(address), (1,), np.float64)[0]


@njit(cache=True, error_model="numpy", inline="always")
def doubles(address, rows, columns):
    """The doubles (rows, columns) at an address."""
    return carray(pointer(address), (rows, columns), np.float64)


@njit(cache=True, error_model="numpy", inline="always")
def int32s(address, rows):
    """The 32-bit integers (rows,) at an address."""
    return carray(pointer(address), (rows,), np.int32)


@njit(cache=True, error_model="numpy", inline="always")
def grid(table, k):
    """The k-th array of a table, of two dimensions."""
    return carray(
        pointer(word(table + 24 * k)),
        (word(table + 24 * k + 8), word(table + 24 * k + 16)),
        np.float64,
    )


@njit(cache=True, error_model="numpy", inline="always")
def row(table, k):
    """The k-th array of a table, of doubles, of one dimension."""
    return carray(pointer(word(table + 24 * k)), (word(table + 24 * k + 8),), np.float64)


@njit(cache=True, error_model="numpy", inline="always")
def words(table, k):
    """The k-th array of a table, of words."""
    return carray(pointer(word(table + 24 * k)), (word(table + 24 * k + 8),), np.int64)


@njit(cache=True, error_model="numpy", inline="always")
def spans(table, k):
    """The k-th array of a table, of words (n, 5)."""
    return carray(pointer(word(table + 24 * k)), (word(table + 24 * k + 8), 5), np.int64)


@njit(cache=True, error_model="numpy", inline="always")
def corners(table, k):
    """The k-th array of a table, of corners of faces (n, 3)."""
    return carray(pointer(word(table + 24 * k)), (word(table + 24 * k + 8), 3), np.uint32)

"""Tables of arrays in memory, and views of them: NamedTuples that go to compiled code by address.

A table has three 64-bit words for each array or number of a NamedTuple, nested ones in their place:
an array's address, rows and columns, or the bits of the number. See `kernels.arrays` for how a
NamedTuple declares its arrays.
"""

from typing import Any, Generic

import numpy as np
from llvmlite import ir
from numba.extending import intrinsic

from buoyancy_mj.kernels.arrays import Field, T, conform, fields, leaves, numba_type
from buoyancy_mj.kernels.paths import PATHS

WORDS = 3
"""Words of a table for each array."""
_WORD = ir.IntType(64)
_SLOTS = {path: slot for slot, path in enumerate(PATHS)}


class Table(Generic[T]):
    """A NamedTuple of arrays where compiled code finds it, as long as this object lives."""

    def __init__(self, arrays: T) -> None:
        self.arrays: T = conform(arrays)
        """The arrays, copied only where they were not as declared."""
        rows = [_describe(value) for value in _flatten(self.arrays)]
        self._words = np.array(rows, np.int64)
        self.address: int = self._words.ctypes.data
        """Of the table."""

    def set_number(self, name: str, value: int) -> None:
        """Change a number of the table; `arrays` keep the one that was there at first."""
        self._words[slot(type(self.arrays), name), 0] = value


def slot(kind: type, name: str) -> int:
    """Which array of a NamedTuple class, counted with nested ones in their place, has a name."""
    return [leaf.name for leaf in leaves(kind)].index(name)


def _flatten(arrays: tuple[Any, ...]) -> list[Any]:
    """The arrays of a NamedTuple, those of nested ones in their place."""
    return [
        leaf
        for value in arrays
        for leaf in (_flatten(value) if isinstance(value, tuple) else [value])
    ]


def _describe(value: Any) -> tuple[int, int, int]:
    """The words of one array or number."""
    if value.ndim == 0:
        return int(value.view(np.int64)), 1, 1
    return value.ctypes.data, value.shape[0], value.shape[1] if value.ndim > 1 else 1


@intrinsic
def view(typing, table, kind):
    """The NamedTuple of a class whose table is at an address."""

    def code(context, builder, signature, args):
        words = builder.inttoptr(args[0], _WORD.as_pointer())
        count = iter(range(len(leaves(kind.instance_class))))

        def read(field):
            first = WORDS * next(count)
            if not field.shape:
                return _load(context, builder, builder.gep(words, [_WORD(first)]), field)
            address, *extents = (
                builder.load(builder.gep(words, [_WORD(first + n)])) for n in range(WORDS)
            )
            shape = [
                _WORD(n) if isinstance(n, int) else extent
                for n, extent in zip(field.shape, extents, strict=False)
            ]
            return _array(context, builder, field, address, shape)

        return _build(context, builder, kind.instance_class, read)

    return numba_type(kind.instance_class)(table, kind), code


@intrinsic
def view_engine(typing, model, data, offsets, kind):
    """The NamedTuple of a class, such as `multibody.Engine`, that an mjModel and an mjData hold.

    `offsets` is the address of the byte offsets of `PATHS`, which holds them in that order.
    """

    def code(context, builder, signature, args):
        model, data, offsets, _ = args
        table = builder.inttoptr(offsets, _WORD.as_pointer())

        def place(path):
            owner = data if path.startswith("mjData") else model
            return builder.add(owner, builder.load(builder.gep(table, [_WORD(_SLOTS[path])])))

        def word(path):
            return builder.load(builder.inttoptr(place(path), _WORD.as_pointer()))

        def read(field):
            if not field.shape:
                return _load(context, builder, place(field.path), field)
            # options stand in their struct, all else where that points to
            inside = field.struct.endswith(".opt")
            address = place(field.path) if inside else word(field.path)
            shape = [_WORD(n) if isinstance(n, int) else word(f"mjModel.{n}") for n in field.shape]
            return _array(context, builder, field, address, shape)

        return _build(context, builder, kind.instance_class, read)

    return numba_type(kind.instance_class)(model, data, offsets, kind), code


def _build(context, builder, kind, read):
    """A NamedTuple of a class from its fields, each read by `read`, in their order."""
    values = [
        read(field) if isinstance(field, Field) else _build(context, builder, field, read)
        for field in fields(kind)
    ]
    return context.make_tuple(builder, numba_type(kind), values)


def _load(context, builder, place, field):
    """The number at a pointer or an address."""
    pointer = context.get_value_type(numba_type(field)).as_pointer()
    if isinstance(place.type, ir.IntType):
        return builder.load(builder.inttoptr(place, pointer))
    return builder.load(builder.bitcast(place, pointer))


def _array(context, builder, field, address, shape):
    """The contiguous array of a shape at an address; nobody counts references to it."""
    # whoever compiles has it at hand
    from numba.np.arrayobj import make_array, populate_array

    kind, size = numba_type(field), field.dtype.itemsize
    strides = [_WORD(size)]
    for extent in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], extent))
    array = make_array(kind)(context, builder)
    pointer = context.get_data_type(kind.dtype).as_pointer()
    populate_array(array, builder.inttoptr(address, pointer), shape, strides, size, None)
    return array._getvalue()

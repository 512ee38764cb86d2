"""NamedTuples of arrays: each array is declared once, with its dtype and its shape.

A field is annotated as `Annotated[Doubles, (n, 3)]`. The shape has a number for each fixed extent
and a word for each that varies. A field of MuJoCo's structs also names the struct that holds it, as
`Annotated[Doubles, "mjData", ("nbody", 3)]`: its name is MuJoCo's, and so are the words in its
shape. A field without a shape is one number. A field may be such a NamedTuple itself.

Kernels read the arrays out of a NamedTuple before they loop over them: each reading counts
references.
"""

import functools
from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple, TypeVar, get_args, get_origin, get_type_hints

import numpy as np
from numba import from_dtype, types
from numpy.typing import DTypeLike

# NDArray in full, which from NumPy 2.5 on hides its dtype behind an alias
Doubles = np.ndarray[tuple[Any, ...], np.dtype[np.float64]]
Words = np.ndarray[tuple[Any, ...], np.dtype[np.int64]]
Int32s = np.ndarray[tuple[Any, ...], np.dtype[np.int32]]
Truths = np.ndarray[tuple[Any, ...], np.dtype[np.bool_]]
Corners = np.ndarray[tuple[Any, ...], np.dtype[np.uint32]]
"""Unsigned, since Numba asks of a signed index whether it counts from the end."""
T = TypeVar("T", bound=tuple[Any, ...])


class Field(NamedTuple):
    """One array, or one number, of a NamedTuple."""

    name: str
    """Its name."""
    dtype: np.dtype[Any]
    """Of its elements."""
    shape: tuple[int | str, ...]
    """Its extents; () for a number."""
    struct: str
    """The struct of MuJoCo's that holds it, as "mjModel.opt"; "" if none does."""

    @property
    def path(self) -> str:
        """Its place among MuJoCo's structs, as "mjModel.opt.timestep"."""
        return f"{self.struct}.{self.name}"


@functools.cache
def fields(kind: type) -> tuple[Field | type, ...]:
    """The fields of a NamedTuple class in their order; a nested NamedTuple stands as its class."""
    hints = get_type_hints(kind, include_extras=True)
    return tuple(_field(name, hints[name]) for name in kind._fields)  # type: ignore[attr-defined]


def _field(name: str, hint: Any) -> Field | type:
    """One field from its annotation."""
    if hasattr(hint, "_fields"):
        return hint
    extras: tuple[Any, ...] = ()
    if get_origin(hint) is Annotated:
        hint, *extras = get_args(hint)  # type: ignore[assignment]
    shape = next((extra for extra in extras if isinstance(extra, tuple)), ())
    struct = next((extra for extra in extras if isinstance(extra, str)), "")
    # the dtype of an ndarray[shape, dtype]
    scalar: DTypeLike = get_args(get_args(hint)[1])[0] if shape else hint
    return Field(name, np.dtype(scalar), shape, struct)


def leaves(kind: type) -> tuple[Field, ...]:
    """All arrays and numbers of a NamedTuple class, those of nested ones in their place."""
    return tuple(
        leaf
        for field in fields(kind)
        for leaf in ((field,) if isinstance(field, Field) else leaves(field))
    )


def numba_type(kind: Field | type) -> types.Type:
    """What Numba takes a field, or an instance of a NamedTuple class, for."""
    if not isinstance(kind, Field):
        return types.BaseTuple.from_types([numba_type(field) for field in fields(kind)], kind)
    scalar = from_dtype(kind.dtype)
    return types.Array(scalar, len(kind.shape), "C") if kind.shape else scalar


def empty(kind: type[T]) -> T:
    """A NamedTuple of a class whose arrays have no elements and whose numbers are 0."""
    return kind._make(  # type: ignore[attr-defined]
        (
            np.zeros([n if isinstance(n, int) else 0 for n in field.shape], field.dtype)[()]
            if isinstance(field, Field)
            else empty(field)
        )
        for field in fields(kind)
    )


def gather(kind: type[T], structs: Mapping[str, object]) -> T:
    """A NamedTuple of a class from the attributes of MuJoCo's structs, which come by name."""
    return kind._make(  # type: ignore[attr-defined]
        (
            getattr(structs[field.struct], field.name)
            if isinstance(field, Field)
            else gather(field, structs)
        )
        for field in fields(kind)
    )


def conform(arrays: T) -> T:
    """The arrays of a NamedTuple as its class declares them, copied only where they are not so yet.

    Kernels are compiled once for each combination of types: these are contiguous, writeable and of
    the declared dtypes.
    """
    kind = type(arrays)
    return kind._make(  # type: ignore[attr-defined]
        np.require(value, field.dtype, ["C", "W"])[()]
        if isinstance(field, Field)
        else conform(value)
        for field, value in zip(fields(kind), arrays, strict=True)
    )

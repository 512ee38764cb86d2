"""Values that somebody gives, checked in one place: numbers, truths, texts and arrays of numbers.

In: any value, what messages call it, and the error that refuses it.
Out: the same as a plain float, int, bool, str or array; or that error, in one sentence.
May import: errors.
"""

import math
import numbers
import unicodedata
from typing import TypeGuard

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyError, describe

ANY = -1
"""In a shape, an extent that may be any."""


def is_number(value: object) -> TypeGuard[float]:
    """Whether a value is a real number, of Python or of NumPy; True and False are none."""
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def read_number(
    error: type[BuoyancyError],
    name: str,
    value: object,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
) -> float:
    """A finite number in a range, as a float.

    Args:
        error: what is raised.
        name: what messages call the value.
        value: any value.
        above: the number must be greater.
        least: the least number.
        most: the greatest number.

    Raises:
        error: the value is no number, not finite, or out of the range.
    """
    number = _to_float(value)
    if not math.isfinite(number):
        raise error(f"{name} is {describe(value)}; it must be a finite number")
    if not number > above:
        raise error(f"{name} is {describe(value)}; it must be above {above:g}")
    if not least <= number <= most:
        raise error(f"{name} is {describe(value)}; it must be {_range(least, most)}")
    return number


def set_number(
    record: object, error: type[BuoyancyError], field: str, *, prefix: str = "", **bounds: float
) -> None:
    """Keep a field of a frozen dataclass as a float, from its `__post_init__`.

    Args:
        record: the dataclass.
        error: what is raised.
        field: name of the field.
        prefix: what messages say before it.
        bounds: `above`, `least`, `most`, as for `read_number`.

    Raises:
        error: see `read_number`.
    """
    number = read_number(error, prefix + field, getattr(record, field), **bounds)
    object.__setattr__(record, field, number)


def read_whole_number(
    error: type[BuoyancyError], name: str, value: object, least: int, most: int
) -> int:
    """A whole number from `least` to `most`, as an int.

    Raises:
        error: it is none; the message calls it `name`.
    """
    is_whole = isinstance(value, numbers.Integral) and not isinstance(value, bool)
    if not is_whole or not least <= int(value) <= most:  # type: ignore[call-overload]
        raise error(
            f"{name} is {describe(value)}; it must be a whole number from {least} to {most}"
        )
    return int(value)  # type: ignore[call-overload, no-any-return]


def read_truth(error: type[BuoyancyError], name: str, value: object) -> bool:
    """True or False, of Python or of NumPy, as a bool.

    Raises:
        error: it is neither; the message calls it `name`.
    """
    if not isinstance(value, bool | np.bool_):
        raise error(f"{name} is {describe(value)}; it must be true or false")
    return bool(value)


def read_text(error: type[BuoyancyError], name: str, value: object) -> str:
    """A text of one line in Unicode, without control characters.

    Raises:
        error: it is none; the message calls it `name`.
    """
    if not isinstance(value, str):
        raise error(f"{name} is {describe(value)}; it must be a text")
    for character in value:
        category = unicodedata.category(character)
        if category == "Cs":
            raise error(f"{name} is {describe(value)}; it must be a text in UTF-8")
        if category == "Cc":
            raise error(
                f"{name} is {describe(value)}; it must be one line, "
                f"without the control character {character!r}"
            )
    return value


def read_array(
    error: type[BuoyancyError],
    name: str,
    value: object,
    *shapes: tuple[int, ...],
    finite: bool = True,
) -> NDArray[np.float64]:
    """An array of real numbers of one of some shapes.

    Args:
        error: what is raised.
        name: what messages call the value.
        value: any value.
        shapes: the shapes that it may have, with `ANY` for any extent.
        finite: whether all numbers must be finite.

    Raises:
        error: the value is no such array. It is never reshaped, and complex numbers, truths and
            texts are no numbers here.
    """
    array = _to_array(value)
    is_right = array is not None and (
        array.shape in shapes or any(_has_shape(array, shape) for shape in shapes)
    )
    if array is None or not is_right:
        got = "" if array is None else f", of shape {array.shape}"
        wanted = " or ".join(map(_show_shape, shapes))
        raise error(f"{name} is {describe(value)}{got}; it must be numbers of shape {wanted}")
    if finite and not _is_finite(array):
        raise error(f"{name} holds {array[~np.isfinite(array)][0]}; its numbers must be finite")
    return array


def _to_float(value: object) -> float:
    """A real number as a float; nan for anything else, and for what a float cannot hold."""
    if not is_number(value):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _to_array(value: object) -> NDArray[np.float64] | None:
    """Real numbers as an array of floats; None for anything else."""
    try:
        array = np.asarray(value)
        if array.dtype.char == "d":
            return array
        # whole numbers beyond 64 bits come as objects
        if array.dtype == object and all(map(is_number, array.ravel())):
            array = array.astype(float)
    except (TypeError, ValueError, OverflowError, RecursionError):
        return None
    if array.dtype.kind not in "iuf" and array.size:
        return None
    return array.astype(float, copy=False)


def _is_finite(array: NDArray[np.float64]) -> bool:
    """Whether all numbers of an array are finite; of a few, their sum mostly says so."""
    is_sure = array.size <= 16 and math.isfinite(sum(array.ravel().tolist()))
    return is_sure or bool(np.isfinite(array).all())


def _has_shape(array: NDArray[np.float64], shape: tuple[int, ...]) -> bool:
    """Whether an array has a shape, in which `ANY` stands for any extent."""
    return len(shape) == array.ndim and all(
        wanted in (ANY, extent) for wanted, extent in zip(shape, array.shape, strict=True)
    )


def _show_shape(shape: tuple[int, ...]) -> str:
    """A shape in words: (3,), (n, 3)."""
    words = ["n" if extent == ANY else str(extent) for extent in shape]
    return f"({words[0]},)" if len(words) == 1 else f"({', '.join(words)})"


def _range(least: float, most: float) -> str:
    """A range in words."""
    bounds = []
    if math.isfinite(least):
        bounds.append(f"at least {least:g}")
    if math.isfinite(most):
        bounds.append(f"at most {most:g}")
    return " and ".join(bounds)

"""Python functions as C functions, and the errors that they raise there."""

import collections
import ctypes
import threading
from collections.abc import Callable
from typing import Any

_WORD = ctypes.c_int64
_THREE_WORDS = ctypes.CFUNCTYPE(_WORD, _WORD, _WORD, _WORD)
_RAISED = threading.local()
_TEXTS: collections.deque[Any] = collections.deque(maxlen=256)
"""The last texts that the engine was given to read."""


def wrap_python(function: Callable[[int, int, int], None]) -> Any:
    """A Python function of three words as a C function.

    The C function returns 0, or the address of a text if the function raises.
    """

    def called(first: int, second: int, third: int) -> int:
        try:
            function(first, second, third)
        except BaseException as error:
            # without its frames: what they hold must not be freed by the end of a thread
            error.__context__ = error.__cause__ = None
            _RAISED.error = error.with_traceback(None)
            # kept for the engine to read; a thread that is not Python's keeps nothing of its own
            _TEXTS.append(encode_text(f"buoyancy_mj: {error}"))
            return ctypes.addressof(_TEXTS[-1])
        return 0

    return _THREE_WORDS(called)


def pop_error() -> BaseException | None:
    """What the last function of `wrap_python` that failed in this thread raised; then forgotten."""
    error: BaseException | None = getattr(_RAISED, "error", None)
    _RAISED.error = None
    return error


def encode_text(text: str) -> Any:
    """A text for MuJoCo's error function, which formats it and has room for a thousand letters."""
    return ctypes.create_string_buffer(text.replace("%", "%%").encode()[:1000])


def address_of(function: Any) -> int:
    """Of a ctypes function."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0

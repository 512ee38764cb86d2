"""Python functions as C functions, and the errors that they raise there."""

import collections
import ctypes
import weakref
from collections.abc import Callable
from contextlib import AbstractContextManager
from typing import Any, NamedTuple

import mujoco

from buoyancy_mj.kernels.entries.answers import Answering

_WORD = ctypes.c_int64
_FOUR_WORDS = ctypes.CFUNCTYPE(None, _WORD, _WORD, _WORD, _WORD)
_ROOM = 1000
"""Most letters of a text that MuJoCo's error function has room for."""
_KNOWN = 100
"""So many letters at its beginning tell a text from others: the engine may cut its end off."""

MOST_FREE = 16
"""C functions that rest before one is used again: a thread may still be about to leave one."""
_free: collections.deque[Answering] = collections.deque()
_INTERRUPTED = "buoyancy_mj: interrupted by a signal"
"""What the engine is told when a signal raised where no Python could catch it."""


class _Raised(NamedTuple):
    """An error, and the text of it that the engine was given to read."""

    error: BaseException
    text: str
    memory: Any


_RAISED: collections.deque[_Raised] = collections.deque(maxlen=256)
"""The last errors of all threads, kept for the engine to read."""


def encode_text(text: str) -> Any:
    """A text for MuJoCo's error function, which formats it and has room for a thousand letters."""
    return ctypes.create_string_buffer(text.replace("%", "%%").encode()[:_ROOM])


_SILENCE = encode_text(_INTERRUPTED)


class PythonFunction:
    """A Python function of three words as a C function, at `address`.

    The C function returns 0, or the address of a text if the function raises. The engine makes an
    error of its own of that text, and `find_cause` finds what was raised.
    """

    def __init__(self, function: Callable[[int, int, int], None]) -> None:
        def called(first: int, second: int, third: int, answer: int) -> None:
            # a signal may raise before this line and after it
            try:
                function(first, second, third)
                text = 0
            except BaseException as error:
                text = _keep_error(error)
            _WORD.from_address(answer).value = text

        self._called = _FOUR_WORDS(called)
        reused = len(_free) > MOST_FREE
        answering = _free.popleft() if reused else Answering(ctypes.addressof(_SILENCE))
        answering.target.value = address_of(self._called)
        self.address = answering.address
        """Of the C function."""
        weakref.finalize(self, _free.append, answering).atexit = False


def _keep_error(error: BaseException) -> int:
    """Keep an error for `find_cause`; the address of its text."""
    # without its frames: what they hold must not be freed by the end of a thread
    error.__context__ = error.__cause__ = None
    text = f"buoyancy_mj: {str(error) or type(error).__name__}"
    memory = encode_text(text)
    _RAISED.append(_Raised(error.with_traceback(None), text, memory))
    return ctypes.addressof(memory)


def find_cause(told: Exception | str) -> BaseException | None:
    """What a `PythonFunction` raised and the engine told; it may be Ctrl-C.

    Args:
        told: an error of the engine, or its message.

    Returns:
        What was raised; None for an error that is the engine's own.
    """
    message = str(told)
    if _INTERRUPTED in message:
        return KeyboardInterrupt()
    causes = (last.error for last in reversed(list(_RAISED)) if last.text[:_KNOWN] in message)
    return next(causes, None)


class _RaiseCauses:
    """What `raise_causes` gives; a generator would cost more than all else around a step."""

    def __enter__(self) -> None:
        pass

    def __exit__(self, _: Any, error: BaseException | None, __: Any) -> None:
        cause = find_cause(error) if isinstance(error, mujoco.FatalError) else None
        if cause is not None:
            raise cause from None


_RAISE_CAUSES = _RaiseCauses()


def raise_causes() -> AbstractContextManager[None]:
    """Raise what Python functions raised, Ctrl-C among it, in place of the engine's errors."""
    return _RAISE_CAUSES


def address_of(function: Any) -> int:
    """Of a ctypes function."""
    return ctypes.cast(function, ctypes.c_void_p).value or 0

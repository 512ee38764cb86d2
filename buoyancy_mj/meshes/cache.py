"""Results about meshes that were found before, in this process or in another, by checksum.

What one depends on besides, as the code that finds it, is told by `cache_version`, and how it is
kept on disk by `cache_files`.
"""

import hashlib
from collections.abc import Callable, Mapping
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.files import find_cache_folder
from buoyancy_mj.meshes import cache_files
from buoyancy_mj.meshes.cache_version import find_version

T = TypeVar("T")
Arrays = Mapping[str, NDArray[Any]]
"""Arrays by name."""
MOST_IN_MEMORY = 256 << 20
"""Most bytes of results that a process keeps for itself; those that were not used longest go."""


class Form(NamedTuple, Generic[T]):
    """How results of one kind are kept as arrays."""

    name: str
    """Of the kind, unlike that of any other."""
    to_arrays: Callable[[T], Arrays]
    """Gives the arrays of a result."""
    from_arrays: Callable[[Arrays], T]
    """Gives the result of its arrays, which cannot be written to."""


class _Known(NamedTuple):
    """A result that this process keeps."""

    result: Any
    size: int
    """Of its arrays [bytes]."""


_known: dict[bytes, _Known] = {}
"""By checksum, the one that was used last at the end."""


def recall(
    form: Form[T], parts: tuple[object, ...], find: Callable[[], T], *, on_disk: bool = True
) -> T:
    """A result that depends on some parts alone, found once for the same parts.

    It is kept in this process, and in the folder of `files.find_cache_folder`. What stands there
    and is damaged is found anew, and where nothing can be written it is kept in this process alone.

    Args:
        form: how it is kept.
        parts: what it depends on: arrays, numbers, texts, bytes.
        find: finds it; its arrays are not to be written to afterwards.
        on_disk: whether it is kept for other processes too.
    """
    checksum = take_checksum(form.name, *parts)
    # taken out and put back at the end; another thread in between finds it once more
    known = _known.pop(checksum, None)
    if known is None:
        known = _read(form, checksum) if on_disk else None
    if known is None:
        found = find()
        arrays = form.to_arrays(found)
        if on_disk:
            _write(checksum, arrays)
        known = _Known(found, _measure(arrays))
    _known[checksum] = known
    _forget_oldest()
    result: T = known.result
    return result


def forget() -> None:
    """Forget all that this process keeps; what is on disk stays."""
    _known.clear()


def take_checksum(*parts: object) -> bytes:
    """A checksum of arrays, numbers, texts and bytes, of their values and kinds."""
    checksum = hashlib.sha256()
    for part in parts:
        if isinstance(part, str):
            part = part.encode()
        if isinstance(part, bytes):
            checksum.update(b"%d " % len(part) + part)
            continue
        array = np.ascontiguousarray(part)
        checksum.update(f"{array.dtype.str}{array.shape}".encode())
        checksum.update(array.data if array.size else b"")
    return checksum.digest()


def _forget_oldest() -> None:
    """Forget what was not used longest, until little enough is left."""
    kept = list(_known.items())
    excess = sum(known.size for _, known in kept) - MOST_IN_MEMORY
    for checksum, known in kept[:-1]:
        if excess <= 0:
            return
        _known.pop(checksum, None)
        excess -= known.size


def _measure(arrays: Arrays) -> int:
    """The size of arrays [bytes]."""
    return sum(array.nbytes for array in arrays.values())


def _read(form: Form[T], checksum: bytes) -> _Known | None:
    """What another process has found; None if none has."""
    folder, version = find_cache_folder(), find_version()
    if folder is None or version is None:
        return None
    arrays = cache_files.read_arrays(folder / "meshes", version + checksum)
    if arrays is None:
        return None
    return _Known(form.from_arrays(arrays), _measure(arrays))


def _write(checksum: bytes, arrays: Arrays) -> None:
    """Keep a result for other processes."""
    folder, version = find_cache_folder(), find_version()
    if folder is not None and version is not None:
        cache_files.write_arrays(folder / "meshes", version + checksum, arrays)

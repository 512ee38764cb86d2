"""Arrays in files that may be lost at any time, in a folder of bounded size.

A file is one record in NumPy's own format, `.npy`, without pickled objects, whose fields are the
arrays. Behind it stands the sum by which damage is found. The name of the file is a checksum of the
key.
"""

import contextlib
import hashlib
import io
import os
import time
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from buoyancy_mj.files import replace_file

MOST = 512 << 20
"""Most bytes of all files of a folder; a larger one is emptied of what was not used longest."""
LARGEST = MOST // 4
"""Most bytes of the arrays of one file."""
SURE = 600.0
"""Age [s] from which a file that is read is marked as used now."""
LEAST = 64 << 10
"""What a file counts at least [bytes], so that there are not too many."""
_SUM = 4
"""Bytes of the sum at the end of a file."""
_LOOK = MOST // 16
"""Bytes that a process writes before it looks again how large the folder is."""
_written: dict[Path, int] = {}
"""Bytes that this process has written to a folder since it looked last."""


def read_arrays(folder: Path, key: bytes) -> dict[str, NDArray[Any]] | None:
    """Read what is kept under a key; None if there is nothing, or it is damaged.

    Nobody can write to the arrays.
    """
    path = _name_file(folder, key)
    try:
        with open(path, "rb", buffering=0) as file:
            content = file.read()
            if time.time() - os.fstat(file.fileno()).st_mtime > SURE:
                os.utime(path)
    except OSError:
        return None
    if _sum_up(memoryview(content)[:-_SUM]) != content[-_SUM:]:
        return None

    # as it was written, since the sum is right
    stream = io.BytesIO(content)
    npy.read_magic(stream)
    _, _, dtype = npy.read_array_header_1_0(stream)
    fields = np.frombuffer(content, dtype, 1, stream.tell()).reshape(())
    return {name: fields[name] for name in dtype.names or ()}


def write_arrays(folder: Path, key: bytes, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Keep arrays under a key, if they are not too large and the folder can be written to."""
    if sum(array.nbytes for array in arrays.values()) > LARGEST:
        return
    fields = [(name, array.dtype, array.shape) for name, array in arrays.items()]
    record = np.zeros((), np.dtype(fields, align=True))
    for name, array in arrays.items():
        record[name] = array
    stream = io.BytesIO()
    npy.write_array(stream, record, (1, 0), allow_pickle=False)
    content = stream.getbuffer()
    with contextlib.suppress(OSError):
        with replace_file(_name_file(folder, key)) as part, part.open("wb") as file:
            file.write(content)
            file.write(_sum_up(content))
        _keep_small(folder, len(content))


def _name_file(folder: Path, key: bytes) -> Path:
    """The file of a key."""
    return folder / f"{hashlib.sha256(key).hexdigest()}.npy"


def _sum_up(content: memoryview) -> bytes:
    """A sum of bytes that differs if some of them do, or if some are missing."""
    return zlib.crc32(content, len(content) & 0xFFFFFFFF).to_bytes(_SUM)


def _keep_small(folder: Path, written: int) -> None:
    """Remove the files that were not used longest, now and then, if all are larger than `MOST`.

    Raises:
        OSError: the folder cannot be read.
    """
    _written[folder] = _written.get(folder, _LOOK) + max(written, LEAST)
    if _written[folder] < _LOOK:
        return
    _written[folder] = 0
    files = []
    with os.scandir(folder) as entries:
        for entry in entries:
            # another process may remove it
            with contextlib.suppress(OSError):
                status = entry.stat(follow_symlinks=False)
                files.append((status.st_mtime, max(status.st_size, LEAST), entry.path))
    excess = sum(size for _, size, _ in files) - MOST
    for _, size, path in sorted(files):
        if excess <= 0:
            return
        with contextlib.suppress(OSError):
            os.unlink(path)
        excess -= size

"""Files written whole or not at all, under names that nobody else has.

In: a path that somebody asked for.
Out: a file that may grow beside it, a file that takes its name at the end, and locks; a folder for
what may be lost.
May import: nothing of this package.
"""

import contextlib
import os
import secrets
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

_NEW = os.O_RDWR | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0)
"""How a file is opened that must not be there yet, not even as a link."""
_NEVER_WAIT = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_NOFOLLOW", 0)


class GrowingFile:
    """A file that grows piece by piece, and survives whatever ends it.

    It grows under the name `NAME.partial.EXT`, or `NAME.partial-2.EXT` and so on where that exists,
    and takes its own when it is whole: a file which was there is replaced at once or not at all.

    Args:
        path: the file; its folder is made.
        grows_as: the end of the name under which it grows, as '.csv'; '' for that of its own.

    Raises:
        BlockingIOError: another process is writing it; `filename` names where.
        OSError: it cannot be made; `strerror` says why.
    """

    def __init__(self, path: Path, grows_as: str = "") -> None:
        self.path = path
        """The name of the whole file."""
        self.partial: Path
        """The name under which it grows."""
        self.closed = False
        """Whether the file has its name already, or was discarded."""
        self.size = 0
        """Bytes written so far."""
        if path.is_dir():
            raise OSError(0, "it is a folder", str(path))
        if path.exists() and not path.is_file():
            raise OSError(0, "it is no regular file", str(path))
        path.parent.mkdir(parents=True, exist_ok=True)
        self._descriptor, self.partial = open_partial(path.with_suffix(grows_as or path.suffix))

    def append(self, piece: bytes | memoryview) -> None:
        """Append a piece, whole or not at all.

        Raises:
            OSError: the disk is full or gone; the file ends with its last whole piece.
        """
        rest = memoryview(piece)
        try:
            while rest:
                rest = rest[os.write(self._descriptor, rest) :]
        except OSError:
            with contextlib.suppress(OSError):
                os.ftruncate(self._descriptor, self.size)
            raise
        self.size += len(piece)

    def close(self) -> None:
        """Write no more; the file keeps the name under which it grew."""
        if not self.closed:
            os.close(self._descriptor)
            self.closed = True

    def take_name(self, *, complete: bool) -> Path:
        """Give the closed file its name.

        An incomplete one does not replace a file that is there, and keeps the name under which it
        grew.

        Args:
            complete: whether all that should be in the file is in it.

        Returns:
            Where the file is.

        Raises:
            OSError: it cannot take its name.
        """
        if not complete and os.path.lexists(self.path):
            return self.partial
        os.replace(self.partial, self.path)
        return self.path

    def discard(self) -> None:
        """Remove the file of something that never began."""
        self.close()
        self.partial.unlink(missing_ok=True)


def open_partial(path: Path) -> tuple[int, Path]:
    """Make a file in which the file at `path` may grow, and lock it.

    It is `NAME.partial.EXT`, or `NAME.partial-2.EXT` and so on where that exists: what is there was
    left by a process that was killed, or is somebody's own.

    Returns:
        Its descriptor, and its name.

    Raises:
        BlockingIOError: another process is writing the file at `path`; `filename` names where.
        OSError: no file can be made there.
    """
    number = 0
    while True:
        number += 1
        tail = "partial" if number == 1 else f"partial-{number}"
        partial = path.with_name(f"{path.stem}.{tail}{path.suffix}")
        try:
            descriptor = os.open(partial, _NEW, 0o666)
        except FileExistsError:
            require_unlocked(partial)
        else:
            lock(descriptor, partial)
            return descriptor, partial


def lock(descriptor: int, path: Path) -> None:
    """Keep other processes from locking the same file until the descriptor is closed.

    The system takes the lock back when the process ends, whatever ends it. Where the system knows
    no such locks, nothing is locked.

    Raises:
        BlockingIOError: another process has locked it.
    """
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise BlockingIOError(error.errno, error.strerror, str(path)) from None
    except OSError:
        # a file system without locks
        return


def require_unlocked(path: Path) -> None:
    """Check that no other process has locked a file.

    Raises:
        BlockingIOError: one has; `filename` names the file.
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | _NEVER_WAIT)
    except OSError:
        # a link, or a file of somebody else
        return
    try:
        lock(descriptor, path)
    finally:
        os.close(descriptor)


@contextlib.contextmanager
def replace_file(path: Path) -> Iterator[Path]:
    """Write a file anew: under another name in its folder, which becomes its own at the end.

    If the block fails, the file is as it was. What is no regular file, as /dev/stdout, is written
    where it is.

    Yields:
        Where to write.

    Raises:
        OSError: the file cannot be made, or is not to be written.
    """
    path = Path(os.path.realpath(path))
    if path.exists() and not path.is_file():
        yield path
        return
    if path.exists() and not os.access(path, os.W_OK):
        raise PermissionError(13, "Permission denied", str(path))
    path.parent.mkdir(parents=True, exist_ok=True)

    # the end of the name stays: it says what kind of file this is
    part = path.with_name(f".{secrets.token_hex(4)}{path.suffix}")
    os.close(os.open(part, _NEW, 0o666))
    try:
        if path.exists():
            shutil.copymode(path, part)
        yield part
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def find_cache_folder() -> Path | None:
    """The user's folder for what this package can compute again; it need not exist.

    The environment variable BUOYANCY_MJ_CACHE names another one. If it is empty, or for a user
    without a home, there is none.
    """
    chosen = os.environ.get("BUOYANCY_MJ_CACHE")
    try:
        if chosen is not None:
            return Path(chosen).expanduser().absolute() if chosen else None
        home = Path.home()
    except RuntimeError:
        return None
    if sys.platform == "darwin":
        folder = home / "Library" / "Caches"
    elif os.name == "nt":
        folder = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    else:
        folder = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return folder / "buoyancy_mj" if folder.is_absolute() else None


def require_own(path: Path, mark: str) -> None:
    """Check that a file of a name that nobody gave is not somebody else's.

    Args:
        path: where this package is to write.
        mark: a text that the files have which this package writes there.

    Raises:
        FileExistsError: there is a file without the mark.
    """
    if os.path.lexists(path) and not (path.is_file() and mark.encode() in path.read_bytes()):
        raise FileExistsError(17, "there is a file which was not made here", str(path))

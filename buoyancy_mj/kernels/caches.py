"""Where compiled kernels are kept: in Numba's folders, or else among temporary files."""

import functools
import os
import tempfile
from pathlib import Path
from typing import Any

from numba.core import caching, config

_LOCATORS = caching.CacheImpl._locator_classes
_UserWide = next(one for one in _LOCATORS if one.__name__.endswith("UserWideCacheLocator"))
_USER = Path(caching.AppDirs(appname="numba", appauthor=False).user_cache_dir)
"""The user's folder for what may be lost; a relative one for a user without a home."""
NOTICES: list[str] = []
"""What the user should know of the place, one sentence each."""


def list_caches(source: Path) -> tuple[Path, ...]:
    """Folders where the compiled kernels of a source file may be kept."""
    name = caching._CacheLocator.get_suitable_cache_subpath(str(source))
    # CACHE_DIR is NUMBA_CACHE_DIR, or empty; the user's serves where the sources are read-only
    folders = Path(config.CACHE_DIR or _USER), _USER, _temporary_folder()
    return source.parent / "__pycache__", *(folder / name for folder in folders)


class _Temporary(_UserWide):  # type: ignore[misc, valid-type]
    """A place among temporary files."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = str(_own_folder() / self.get_suitable_cache_subpath(file))


@functools.cache
def _own_folder() -> Path:
    """The folder among temporary files, made and told of.

    What lies in it is run, so nobody else may write there.
    """
    folder = _temporary_folder()
    folder.mkdir(mode=0o700, exist_ok=True)
    status = folder.lstat()
    if hasattr(os, "getuid") and (status.st_uid != os.getuid() or status.st_mode & 0o022):
        folder = Path(tempfile.mkdtemp(prefix="buoyancy_mj-"))
    NOTICES.append(
        f"compiled kernels are kept in '{folder}', since neither the folder of this package nor "
        f"'{_USER}' can be written to; NUMBA_CACHE_DIR names another place"
    )
    return folder


def _temporary_folder() -> Path:
    """The folder among temporary files."""
    user = os.getuid() if hasattr(os, "getuid") else 0
    return Path(tempfile.gettempdir(), f"buoyancy_mj-{user}")


# where Numba finds no folder, and before one in the working folder
_LOCATORS.insert(len(_LOCATORS) if _USER.is_absolute() else _LOCATORS.index(_UserWide), _Temporary)

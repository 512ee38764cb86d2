"""Numbers from arrays, compiled: no engine, no dataclass and no file is known here.

In: arrays, packed in rows whose columns have names.
Out: the same, filled: moments, depths, pressures, wrenches, generalized forces.
May import: nothing of this package.

Numba keeps compiled kernels and compiles anew when the file of a kernel changes, but not when a
kernel of another file changes that it has built in. So what is older than any source goes.
"""

import contextlib
from pathlib import Path

from numba.core import caching, config, event

from buoyancy_mj.kernels.progress import CompilationProgress

_FOLDER = Path(__file__).parent


def _caches(source: Path) -> tuple[Path, ...]:
    """Folders where Numba may keep the compiled kernels of a source file."""
    name = caching._CacheLocator.get_suitable_cache_subpath(str(source))
    user = caching.AppDirs(appname="numba", appauthor=False).user_cache_dir
    # CACHE_DIR is NUMBA_CACHE_DIR, or empty; the user's serves where the sources are read-only
    return source.parent / "__pycache__", Path(config.CACHE_DIR or user, name), Path(user, name)


def _drop_stale(folder: Path) -> None:
    """Remove compiled kernels that are older than the newest source in `folder`."""
    sources = list(folder.rglob("*.py"))
    newest = max(source.stat().st_mtime for source in sources)
    for cache in {cache for source in sources for cache in _caches(source)}:
        for compiled in cache.glob("*.nb[ci]"):
            # another process may be doing the same, or the folder be read-only
            with contextlib.suppress(OSError):
                if compiled.stat().st_mtime < newest:
                    compiled.unlink()


_drop_stale(_FOLDER)
event.register("numba:compile", CompilationProgress())

"""Numbers from arrays, compiled: no engine, no dataclass and no file is known here.

In: arrays, packed in rows whose columns have names.
Out: the same, filled: moments, depths, pressures, wrenches, generalized forces.
May import: nothing of this package.

Numba keeps compiled kernels and compiles anew when the file of a kernel changes, but not when a
kernel of another file changes that it has built in. So what is older than any source goes.
"""

import contextlib
import os
from pathlib import Path

from numba.core import event

from buoyancy_mj.kernels.caches import list_caches
from buoyancy_mj.kernels.progress import CompilationProgress

_FOLDER = Path(__file__).parent


def _drop_stale(folder: Path) -> None:
    """Remove compiled kernels that are older than the newest source in `folder`.

    Also those that another user has left unreadable: Numba would not go on beside them.
    """
    sources = list(folder.rglob("*.py"))
    newest = max(source.stat().st_mtime for source in sources)
    for cache in {cache for source in sources for cache in list_caches(source)}:
        for compiled in cache.glob("*.nb[ci]"):
            # another process may be doing the same, or the folder be read-only
            with contextlib.suppress(OSError):
                if compiled.stat().st_mtime < newest or not os.access(compiled, os.R_OK):
                    compiled.unlink()


_drop_stale(_FOLDER)
event.register("numba:compile", CompilationProgress())

"""Arrays in, numbers out, compiled by Numba: no engine, no dataclass and no file is known here.

Numba keeps compiled kernels beside their source and compiles anew when that one file changes, but
not when a kernel of another file changes that it has built in. So what is older than any source goes.
"""

import contextlib
from pathlib import Path

_FOLDER = Path(__file__).parent


def _drop_stale(folder: Path) -> None:
    """Remove compiled kernels that are older than the newest source in `folder`."""
    newest = max(source.stat().st_mtime for source in folder.glob("*.py"))
    for compiled in (folder / "__pycache__").glob("*.nb[ci]"):
        # another process may be doing the same, or the folder be read-only
        with contextlib.suppress(OSError):
            if compiled.stat().st_mtime < newest:
                compiled.unlink()


_drop_stale(_FOLDER)

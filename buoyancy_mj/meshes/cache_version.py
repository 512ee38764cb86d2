"""The version of all that finds what is kept: other code, or another processor, finds it anew."""

import functools
import hashlib
import importlib.metadata
import time
from pathlib import Path

import numpy as np

from buoyancy_mj.kernels.processor import describe_processor

_PACKAGE = Path(__file__).resolve().parents[1]
_LOADED = time.time()
"""When this process has read the sources, at the latest."""
SOURCES = (
    "errors.py",
    "files.py",
    "hulls/bodies.py",
    "hulls/hull.py",
    "hulls/overlaps.py",
    "hulls/welds.py",
    "kernels/*.py",
    "loads/exposure.py",
    "loads/silhouettes.py",
    "meshes/*.py",
)
"""The code that finds it, as patterns of files of this package."""
LIBRARIES = ("manifold3d", "scipy", "trimesh")
"""Libraries whose numbers are in it, besides those that are asked themselves."""


@functools.cache
def find_version() -> bytes | None:
    """A checksum of the code; None if it is not known, and nothing is to be kept on disk.

    So it is where no sources are, and where one of them is newer than what this process runs.
    """
    version = hashlib.sha256(f"{describe_processor()} NumPy {np.__version__}".encode())
    try:
        for library in LIBRARIES:
            version.update(f"{library} {importlib.metadata.version(library)}".encode())
        for pattern in SOURCES:
            # without a file there is none of the code, and so no version
            files = sorted(_PACKAGE.glob(pattern)) or [_PACKAGE / pattern]
            for file in files:
                if file.stat().st_mtime > _LOADED:
                    return None
                version.update(f"{file.name} ".encode() + file.read_bytes())
    except (OSError, importlib.metadata.PackageNotFoundError):
        return None
    return version.digest()

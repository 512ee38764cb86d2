"""The modules of the folder scripts, for tests."""

import importlib
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def script(name):
    """A module of the folder scripts, which may import its neighbours."""
    folder = str(ROOT / "scripts")
    sys.path.insert(0, folder)
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(folder)

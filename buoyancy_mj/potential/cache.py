"""Added mass that was computed before, in this process or in another, by the shape's checksum."""

import contextlib
import hashlib
import json
import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from buoyancy_mj.files import find_cache_folder, replace_file
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.potential.added_mass import UnboundedAddedMass, compute_added_mass

VERSION = "2"
"""Of the method: what another one has computed is computed anew."""
DIGITS = 9
"""Decimal digits of a coordinate that count, from the size of the shape on."""
_known: dict[str, UnboundedAddedMass] = {}


def find_added_mass(
    meshes: Sequence[TriMesh], tell: Callable[[], None] = lambda: None
) -> UnboundedAddedMass:
    """The added mass of the union of meshes, computed once for each shape.

    It is kept in the folder of `files.find_cache_folder`. What stands there and makes no sense is
    computed anew, and where nothing can be written it is kept in this process alone.

    Args:
        meshes: closed meshes in one frame.
        tell: called once, if this takes long.
    """
    checksum = _take_checksum(meshes)
    if checksum not in _known:
        folder = find_cache_folder()
        path = None if folder is None else folder / "added_mass" / f"{checksum}.json"
        found = None if path is None else _read(path)
        if found is None:
            found = compute_added_mass(meshes, tell)
            if path is not None:
                _write(path, found)
        _known[checksum] = found
    return _known[checksum]


def _take_checksum(meshes: Sequence[TriMesh]) -> str:
    """A checksum of meshes that poses with other roundings do not change."""
    size = max(float(np.abs(mesh.bounds).max()) for mesh in meshes)
    digits = DIGITS - math.ceil(math.log10(size))
    checksum = hashlib.sha256(VERSION.encode())
    for mesh in meshes:
        # a zero has no sign
        checksum.update((np.round(mesh.vertices, digits) + 0.0).tobytes())
        checksum.update(mesh.faces.tobytes())
    return checksum.hexdigest()


def _read(path: Path) -> UnboundedAddedMass | None:
    """What a file keeps; None if there is none, or it is not what was written here."""
    try:
        table = json.loads(path.read_text())
        matrix = np.array(table["matrix"], float).reshape(6, 6)
        change, triangles = float(table["change"]), int(table["triangles"])
        doubt = str(table["doubt"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
    sound = np.isfinite(matrix).all() and np.array_equal(matrix, matrix.T)
    return UnboundedAddedMass(matrix, change, triangles, doubt) if sound else None


def _write(path: Path, found: UnboundedAddedMass) -> None:
    """Keep a result in a file, if it can be written."""
    table = {
        "matrix": found.matrix.ravel().tolist(),
        "change": found.change,
        "triangles": found.triangles,
        "doubt": found.doubt,
    }
    with contextlib.suppress(OSError), replace_file(path) as part:
        part.write_text(json.dumps(table))

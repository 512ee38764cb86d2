"""Mesh files of a model: those that MuJoCo does not read, and those that changed since it did."""

import contextlib
import functools
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import MeshError, ModelError

FORMATS = ("dae", "glb", "gltf", "off", "ply")
"""Endings of mesh files that trimesh reads and MuJoCo does not; STL as text is one more."""
_MOST_FACES = 200_000
"""Most triangles of an STL file that MuJoCo reads."""
_FRESH = 2.0
"""Age [s] up to which MuJoCo may remember an older state of a file: it keeps whole seconds."""
_SEEN: dict[Path, tuple[int, int]] = {}
"""Time of change [ns] and size of each file when it was last read here."""


def read_mesh_files(spec: mujoco.MjSpec, path: Path) -> None:
    """Put the meshes that MuJoCo does not read into a spec: other formats, STL as text or large.

    Everything else that the model says of a mesh, such as its scale, stays.

    Args:
        spec: the model, not yet compiled.
        path: its file, for messages.

    Raises:
        ModelError: a file cannot be read, or what reads it is not installed.
    """
    meshes = list(_find_files(spec.meshes, spec, path))
    fields = _find_files(spec.hfields, spec, path)
    _forget_changed([file for _, file in (*meshes, *fields)])
    for asset, file in meshes:
        if _needs_trimesh(file):
            change = file.stat().st_mtime_ns
            try:
                vertices, faces = _read_triangles(file, change)
            except MeshError as error:
                raise ModelError(f"'{path}' asks for '{asset.file}': {error}") from error
            asset.uservert, asset.userface = vertices.ravel(), faces.ravel()
            asset.file = asset.content_type = ""


def _find_files(
    assets: Iterable[Any], spec: mujoco.MjSpec, path: Path
) -> Iterator[tuple[Any, Path]]:
    """Assets and their files; MuJoCo tells of those that do not exist."""
    folders = [Path(spec.modelfiledir or path.parent)]
    for asset in assets:
        place = Path(asset.compiler.meshdir) / asset.file
        if asset.file and not (folders[0] / place).is_file() and len(folders) == 1:
            folders += _list_model_folders(path)
        found = (folder / place for folder in folders if (folder / place).is_file())
        if asset.file and (file := next(found, None)):
            yield asset, file


def _list_model_folders(path: Path) -> Iterator[Path]:
    """Folders of the models that an MJCF file attaches, and those that these attach."""
    with contextlib.suppress(OSError, ElementTree.ParseError):
        for model in ElementTree.parse(path).getroot().iter("model"):
            if file := model.get("file"):
                yield (path.parent / file).parent
                yield from _list_model_folders(path.parent / file)


def _needs_trimesh(file: Path) -> bool:
    """Whether MuJoCo cannot read a mesh file, and trimesh can."""
    ending = file.suffix.lower().removeprefix(".")
    if ending != "stl":
        return ending in FORMATS

    # a binary STL has a header of 80 bytes, the number of triangles, and 50 bytes for each
    with file.open("rb") as stream:
        header = stream.read(84)
    count = int.from_bytes(header[80:], "little")
    return count > _MOST_FACES or file.stat().st_size != 84 + 50 * count


@functools.lru_cache(maxsize=64)
def _read_triangles(file: Path, _change: int) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """Vertices (n, 3) and faces (m, 3) of a file, in metres where the file states its unit.

    Parts of a scene stand where the scene has them. It is read once until it changes.

    Raises:
        MeshError: trimesh cannot read the file, or it has no triangle.
    """
    import trimesh

    try:
        scene = trimesh.load_scene(file)
        if file.suffix.lower() == ".dae":
            scene = scene.convert_units("meters")
        solid = scene.to_mesh()
    except ImportError as error:
        raise MeshError(
            "it needs pycollada, which is not installed: pip install 'buoyancy_mj[meshes]', "
            "or save the mesh as STL or OBJ"
        ) from error
    except Exception as error:
        # what trimesh raises at broken files is of any kind
        text = " ".join(str(error).split()) or type(error).__name__
        raise MeshError(
            f"trimesh cannot read it: {text}; save the mesh as binary STL or as OBJ"
        ) from error
    if not len(solid.faces):
        raise MeshError("it has no triangle; save the mesh as binary STL or as OBJ")
    solid.merge_vertices(merge_tex=True, merge_norm=True)
    return np.asarray(solid.vertices, np.float32), np.asarray(solid.faces, np.int32)


def _forget_changed(files: list[Path]) -> None:
    """Make MuJoCo read files anew that changed since they were last read.

    It remembers a mesh or height field by its path and the second in which the file was written, so
    that it takes a file written twice within a second for the first one.
    """
    changed = False
    for file in files:
        status = file.stat()
        stamp = status.st_mtime_ns, status.st_size
        fresh = abs(time.time() - status.st_mtime) < _FRESH
        changed |= fresh if file not in _SEEN else _SEEN[file] != stamp
        _SEEN[file] = stamp
    if changed:
        mujoco.mj_clearCache(mujoco.mj_getCache())

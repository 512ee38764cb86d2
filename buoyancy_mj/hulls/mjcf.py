"""Models written as MJCF: a spec in another folder, and a spec with repaired meshes."""

import os
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.files import replace_file, require_own
from buoyancy_mj.meshes.mesh import TriMesh

_OBJ_MARK = "https://github.com/mikedh/trimesh"
"""What trimesh writes at the head of a Wavefront file."""


def write_mjcf(spec: mujoco.MjSpec, path: Path) -> Path:
    """Write a spec as MJCF that still finds its meshes and textures; returns the path.

    Raises:
        ModelError: the file cannot be written, or MuJoCo refuses to write it.
    """
    folder = path.resolve().parent
    model_folder = Path(spec.modelfiledir or ".").resolve()
    try:
        root = ElementTree.fromstring(spec.to_xml())
        compiler = root.find("compiler")
        if compiler is None:
            compiler = ElementTree.Element("compiler")
            root.insert(0, compiler)

        # folders of assets, seen from the new place
        for name, directory in (("meshdir", spec.meshdir), ("texturedir", spec.texturedir)):
            compiler.set(name, os.path.relpath(model_folder / directory, folder))

        ElementTree.indent(root)
        with replace_file(path) as part:
            part.write_text(ElementTree.tostring(root, encoding="unicode") + "\n")
    except (OSError, ValueError, mujoco.FatalError) as error:
        raise ModelError(
            f"cannot write '{path}': {' '.join(str(error).split())}; choose another place"
        ) from error
    return path


def embed_meshes(
    spec: mujoco.MjSpec, model: mujoco.MjModel, meshes: Mapping[int, TriMesh], folder: Path
) -> mujoco.MjSpec:
    """A copy of a spec with some meshes replaced, each written as a Wavefront file.

    Args:
        spec: what `model` was compiled from.
        model: the same, compiled.
        meshes: new meshes by the index of their asset, in the frame in which MuJoCo keeps it.
        folder: where the files go.

    Raises:
        ModelError: a file cannot be written.
    """
    from scipy.spatial.transform import Rotation

    copy = spec.copy()
    assets = {asset.name: asset for asset in copy.meshes}
    asset_folder = Path(copy.modelfiledir or ".").resolve() / copy.meshdir
    for index, mesh in meshes.items():
        name = str(model.mesh(index).name)
        path = folder / f"{name.replace('/', '-')}.obj"

        # MuJoCo keeps a mesh about its centre and along its principal axes
        file_from_asset = Rotation.from_quat(model.mesh_quat[index], scalar_first=True)
        vertices, faces = mesh.compact
        _write_obj(file_from_asset.apply(vertices) + model.mesh_pos[index], faces, path)
        _refer_to_file(assets[name], os.path.relpath(path.resolve(), asset_folder))
    return copy


def _write_obj(vertices: NDArray[np.float64], faces: NDArray[np.int64], path: Path) -> None:
    """Write a mesh as a Wavefront file."""
    import trimesh

    solid = trimesh.Trimesh(vertices, faces, process=False)
    text = trimesh.exchange.obj.export_obj(solid, include_normals=False, digits=9)
    try:
        require_own(path, _OBJ_MARK)
        with replace_file(path) as part:
            part.write_text(text)
    except OSError as error:
        raise ModelError(
            f"cannot write '{path}': {error.strerror}; choose another place"
        ) from error


def _refer_to_file(asset: mujoco.MjsMesh, file: str) -> None:
    """Make a mesh asset that of a file, without any of its own data and transformations."""
    asset.file = file
    asset.content_type = ""
    asset.scale = [1.0, 1.0, 1.0]
    asset.refpos = [0.0, 0.0, 0.0]
    asset.refquat = [1.0, 0.0, 0.0, 0.0]
    for name in ("uservert", "usernormal", "usertexcoord"):
        setattr(asset, name, np.empty(0, np.float32))
    for name in ("userface", "userfacetexcoord"):
        setattr(asset, name, np.empty(0, np.int32))

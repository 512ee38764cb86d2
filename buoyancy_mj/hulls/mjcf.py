"""Models written as MJCF: a spec at another place, and its meshes as they were mended."""

import os
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import ModelError
from buoyancy_mj.meshes.mesh import TriMesh


def write_mjcf(spec: mujoco.MjSpec, path: Path) -> Path:
    """Write a spec as MJCF whose files are still found from there; where it lies.

    Raises:
        ModelError: the file cannot be written, or MuJoCo refuses to write it.
    """
    folder = path.resolve().parent
    own = Path(spec.modelfiledir or ".").resolve()
    try:
        root = ElementTree.fromstring(spec.to_xml())
        compiler = root.find("compiler")
        if compiler is None:
            compiler = ElementTree.Element("compiler")
            root.insert(0, compiler)
        for name, directory in (("meshdir", spec.meshdir), ("texturedir", spec.texturedir)):
            compiler.set(name, os.path.relpath(own / directory, folder))
        ElementTree.indent(root)
        folder.mkdir(parents=True, exist_ok=True)
        path.write_text(ElementTree.tostring(root, encoding="unicode") + "\n")
    except (OSError, ValueError, mujoco.FatalError) as error:
        raise ModelError(
            f"cannot write '{path}': {' '.join(str(error).split())}; choose another place"
        ) from error
    return path


def embed_meshes(
    spec: mujoco.MjSpec, model: mujoco.MjModel, mended: Mapping[int, TriMesh], folder: Path
) -> mujoco.MjSpec:
    """A copy of a spec with some meshes replaced, each written as a Wavefront file.

    Args:
        spec: what `model` was compiled from.
        model: the same, compiled.
        mended: hulls by the index of their mesh asset, in the frame in which MuJoCo keeps it.
        folder: where the files go.

    Raises:
        ModelError: a file cannot be written.
    """
    copy = spec.copy()
    assets = {asset.name: asset for asset in copy.meshes}
    for index, mesh in mended.items():
        name = str(model.mesh(index).name)
        # MuJoCo keeps a mesh about its centre and along its principal axes
        turn = Rotation.from_quat(model.mesh_quat[index], scalar_first=True)
        vertices, faces = mesh.compact
        place = folder / f"{name.replace('/', '-')}.obj"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            solid = trimesh.Trimesh(
                turn.apply(vertices) + model.mesh_pos[index], faces, process=False
            )
            place.write_text(
                trimesh.exchange.obj.export_obj(solid, include_normals=False, digits=9)
            )
        except OSError as error:
            raise ModelError(
                f"cannot write '{place}': {error.strerror}; choose another place"
            ) from error
        asset = assets[name]
        own = Path(copy.modelfiledir or ".").resolve() / copy.meshdir
        asset.file = os.path.relpath(place.resolve(), own)
        asset.content_type = ""
        asset.scale, asset.refpos, asset.refquat = [1.0] * 3, [0.0] * 3, [1.0, 0.0, 0.0, 0.0]
        asset.uservert, asset.userface = np.empty(0, np.float32), np.empty(0, np.int32)
        asset.usernormal, asset.usertexcoord = np.empty(0, np.float32), np.empty(0, np.float32)
        asset.userfacetexcoord = np.empty(0, np.int32)
    return copy

"""MJCF and URDF files, read and compiled; errors keep MuJoCo's message and say how to mend it."""

import os
from pathlib import Path

import mujoco

from buoyancy_mj.engine.c_functions import find_cause
from buoyancy_mj.errors import ModelError

_PACKAGE_SCHEMES = ("package://", "model://")
"""How URDF names the files of ROS packages, and of Gazebo's models."""
_MENDS = {
    "inertia": (
        "a body that floats needs mass and inertia: give it an <inertial>, or bound them by "
        "<compiler boundmass boundinertia>"
    ),
    "ASCII": "save the mesh as a binary STL or as OBJ",
}
"""What to do about a refusal, by a word in the compiler's message."""


def read_spec(path: Path) -> mujoco.MjSpec:
    """Read an MJCF or URDF file without compiling it, and find its files in ROS packages.

    Raises:
        ModelError: MuJoCo cannot read the file, with MuJoCo's own message; or a package is missing.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except Exception as error:
        raise ModelError(f"MuJoCo cannot read '{path}': {_one_line(error)}") from error
    for asset in spec.meshes:
        if asset.file.startswith(_PACKAGE_SCHEMES):
            asset.file = str(_find_in_package(asset.file, path))
    return spec


def compile_spec(spec: mujoco.MjSpec, path: Path) -> mujoco.MjModel:
    """Compile a spec; `path` names it in errors.

    Raises:
        ModelError: MuJoCo refuses it. Its own message is kept, with a mend where there is one.
        BuoyancyError: the water in the model refuses it.
        KeyboardInterrupt: Ctrl-C, while the water is made.
    """
    try:
        return spec.compile()
    except ValueError as error:
        # MuJoCo passes on what the water raises as a text; the error itself waits here
        cause = find_cause(error)
        if cause is not None:
            raise cause from None
        message = _one_line(error)
        mend = next((f"; {mend}" for word, mend in _MENDS.items() if word in message), "")
        raise ModelError(f"MuJoCo cannot compile '{path}': {message}{mend}") from error


def attach_spec(
    spec: mujoco.MjSpec, path: Path, other: mujoco.MjSpec, other_path: Path, prefix: str
) -> None:
    """Attach the spec `other` to the world of a spec, with `prefix` before all its names.

    Raises:
        ModelError: MuJoCo cannot join them; the paths name them in the message.
    """
    try:
        spec.attach(other, prefix=prefix, frame=spec.worldbody.add_frame())
    except ValueError as error:
        raise ModelError(
            f"MuJoCo cannot join '{other_path}' to '{path}': {_one_line(error)}"
        ) from error


def _one_line(error: Exception) -> str:
    """The message of an error on one line."""
    return " ".join(str(error).split())


def _find_in_package(uri: str, path: Path) -> Path:
    """The file that 'package://NAME/...' means, in a folder NAME.

    The folder is looked for above and beside the file at `path`, which names the uri, and then on
    ROS_PACKAGE_PATH.
    """
    package, _, rest = uri.split("://", 1)[1].partition("/")
    ros_path = os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)
    for root in (*path.resolve().parents, *map(Path, ros_path)):
        for folder in (root, root / package):
            if folder.name == package and (folder / rest).is_file():
                return folder / rest
    raise ModelError(
        f"'{path}' asks for '{uri}', and no folder '{package}' above it or on ROS_PACKAGE_PATH "
        "holds that file; put the package there"
    )

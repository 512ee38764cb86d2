"""MJCF and URDF files, read and compiled; errors keep MuJoCo's message and say how to mend it."""

import os
import urllib.parse
from collections.abc import Mapping
from pathlib import Path

import mujoco

from buoyancy_mj.engine.c_functions import find_cause
from buoyancy_mj.errors import ModelError
from buoyancy_mj.scenes.mesh_files import FORMATS, read_mesh_files
from buoyancy_mj.scenes.urdf import is_urdf, read_urdf

_PACKAGE_SCHEMES = ("package://", "model://")
"""How URDF names the files of ROS packages, and of Gazebo's models."""
_FILE_SCHEME = "file://"
"""How URDF names other files."""
_MENDS: Mapping[str, tuple[str, str]] = {
    "mass and inertia of moving bodies": (
        "a body that floats needs mass and inertia: give it an <inertial>, or bound them by ",
        'boundmass="0.001" boundinertia="1e-08"',
    ),
    "A + B >= C": (
        "no body has two moments of inertia that are together less than the third: correct them, "
        "or let MuJoCo level them by ",
        'balanceinertia="true"',
    ),
    "could not find decoder for resource": (
        "MuJoCo reads MJCF (.xml) and URDF (.urdf); a xacro is expanded by: xacro FILE > NAME.urdf",
        "",
    ),
    "no decoder found for mesh": (
        f"MuJoCo reads STL, OBJ and MSH, and {', '.join(FORMATS)} are read here: save it as STL",
        "",
    ),
}
"""What to do about a refusal, and the option of MuJoCo's compiler that does it, by words of its
message."""


def read_spec(path: Path) -> mujoco.MjSpec:
    """Read an MJCF or URDF file without compiling it, with meshes that MuJoCo does not read.

    Files of ROS packages are found. Meshes in the formats of `mesh_files.FORMATS`, and STL as text,
    are read here. Visual geoms are kept, whatever `discardvisual` says: they may displace water.

    Raises:
        ModelError: MuJoCo cannot read the file, with MuJoCo's own message; a package is missing; or
            a mesh cannot be read.
    """
    try:
        spec = read_urdf(path) if is_urdf(path) else mujoco.MjSpec.from_file(str(path))
    except Exception as error:
        message = _one_line(error)
        raise ModelError(
            f"MuJoCo cannot read '{path}': {message}{_find_mend(message, path)}"
        ) from error

    # a body without collision geometry displaces water by what is drawn of it
    spec.compiler.discardvisual = False

    for asset in spec.meshes:
        if asset.file.startswith(_PACKAGE_SCHEMES):
            asset.file = str(find_in_package(asset.file, path))
        elif asset.file.startswith(_FILE_SCHEME):
            asset.file = urllib.parse.unquote(asset.file.removeprefix(_FILE_SCHEME))
    read_mesh_files(spec, path)
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
        raise ModelError(
            f"MuJoCo cannot compile '{path}': {message}{_find_mend(message, path)}"
        ) from error


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


def _find_mend(message: str, path: Path) -> str:
    """What to do about a message of MuJoCo's compiler, in the words of the file; '' if unknown."""
    for words, (mend, option) in _MENDS.items():
        if words in message:
            compiler = f"<compiler {option}/>" if option else ""
            if option and is_urdf(path):
                compiler = f"<mujoco>{compiler}</mujoco> in the <robot>"
            return f"; {mend}{compiler}"
    return ""


def _one_line(error: Exception) -> str:
    """The message of an error on one line."""
    return " ".join(str(error).split())


def find_in_package(uri: str, path: Path) -> Path:
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

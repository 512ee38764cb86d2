"""The scenes and models that ship, by name."""

import os
from pathlib import Path

import mujoco

from buoyancy_mj.errors import BuoyancyError, ModelError, SceneError, choices

_PACKAGE = Path(__file__).resolve().parents[1]
_PACKAGES = ("package://", "model://")
"""How URDF names the files of ROS packages, and of Gazebo's models."""


def _shipped(kind: str) -> Path:
    """The folder of `kind`: inside an installed package, beside it in a checkout."""
    inside = _PACKAGE / "shipped" / kind
    return inside if inside.is_dir() else _PACKAGE.parent / kind


def scenes() -> dict[str, Path]:
    """Scene files by name."""
    return {path.stem: path for path in sorted(_shipped("scenes").glob("*.toml"))}


def models() -> dict[str, Path]:
    """Vehicle MJCF files by name: `models/NAME/NAME.xml`."""
    return {
        path.parent.name: path
        for path in sorted(_shipped("models").glob("*/*.xml"))
        if path.stem == path.parent.name
    }


def environments() -> dict[str, Path]:
    """Environment MJCF files by name: `scenes/NAME.xml`."""
    return {path.stem: path for path in sorted(_shipped("scenes").glob("*.xml"))}


def scene_path(name: str) -> Path:
    """The file of a scene, given by path or by the name of one that ships.

    Raises:
        SceneError: neither exists.
    """
    return _found(name, scenes(), Path(), "scene", SceneError)


def model_path(name: str, base: Path = Path()) -> Path:
    """The file of a vehicle, given by path (relative to `base`) or by the name of one that ships.

    Raises:
        ModelError: neither exists.
    """
    return _found(name, models(), base, "vehicle", ModelError)


def environment_path(name: str, base: Path = Path()) -> Path:
    """The file of an environment, given by path (relative to `base`) or by the name of one that ships.

    Raises:
        ModelError: neither exists.
    """
    return _found(name, environments(), base, "environment", ModelError)


def summary(model: Path) -> str:
    """The first line of text in a model's README."""
    readme = model.parent / "README.md"
    lines = readme.read_text().splitlines() if readme.is_file() else []
    return next((line for line in lines if line and not line.startswith("#")), "")


def _found(
    name: str, shipped: dict[str, Path], base: Path, kind: str, error: type[BuoyancyError]
) -> Path:
    if name in shipped:
        return shipped[name]
    try:
        path = base / Path(name).expanduser()
        is_file, is_dir = path.is_file(), path.is_dir()
    except (OSError, RuntimeError, ValueError):
        # a name that no file can have, or a home that nobody has
        is_file = is_dir = False
    if is_file:
        return path
    if is_dir:
        raise error(
            f"{kind} '{name}' is a folder; give a file, or the name of one that ships: {', '.join(shipped)}"
        )
    raise error(
        f"there is no {kind} '{name}', neither a file nor one that ships; {choices(name, shipped)}"
    )


def read_spec(path: Path) -> mujoco.MjSpec:
    """An MJCF or URDF file, not yet compiled; files of ROS packages are looked for.

    Raises:
        ModelError: MuJoCo cannot read it, its own message is kept; or a package is nowhere.
    """
    try:
        spec = mujoco.MjSpec.from_file(str(path))
    except Exception as error:
        raise ModelError(f"MuJoCo cannot read '{path}': {' '.join(str(error).split())}") from error
    for asset in spec.meshes:
        if asset.file.startswith(_PACKAGES):
            asset.file = str(_in_package(asset.file, path))
    return spec


def _in_package(uri: str, path: Path) -> Path:
    """The file of 'package://NAME/...', in a folder NAME above or beside what names it, or on ROS_PACKAGE_PATH."""
    package, _, rest = uri.split("://", 1)[1].partition("/")
    roots = [
        *path.resolve().parents,
        *map(Path, os.environ.get("ROS_PACKAGE_PATH", "").split(os.pathsep)),
    ]
    for root in roots:
        for folder in (root, root / package):
            if folder.name == package and (folder / rest).is_file():
                return folder / rest
    raise ModelError(
        f"'{path}' asks for '{uri}', and no folder '{package}' above it or on ROS_PACKAGE_PATH holds that file; put the "
        "package there"
    )

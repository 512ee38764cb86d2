"""The scenes, vehicles and environments that ship, by name."""

from collections.abc import Mapping
from pathlib import Path

from buoyancy_mj.errors import BuoyancyError, ModelError, SceneError, choices, describe

MODEL_ENDINGS = (".xml", ".mjcf", ".urdf")
"""How the names of models' files end."""
_PACKAGE = Path(__file__).resolve().parents[1]


def scenes() -> dict[str, Path]:
    """Scene files by name."""
    return {path.stem: path for path in sorted(shipped_folder("scenes").glob("*.toml"))}


def models() -> dict[str, Path]:
    """Vehicle MJCF files by name: `models/NAME/NAME.xml`."""
    return {
        path.parent.name: path
        for path in sorted(shipped_folder("models").glob("*/*.xml"))
        if path.stem == path.parent.name
    }


def environments() -> dict[str, Path]:
    """Environment MJCF files by name: `scenes/NAME.xml`."""
    return {path.stem: path for path in sorted(shipped_folder("scenes").glob("*.xml"))}


def scene_path(name: str) -> Path:
    """The file of a scene: a path, or the name of a scene that ships.

    Raises:
        SceneError: neither exists, or it is a model.
    """
    if Path(name).suffix in MODEL_ENDINGS:
        raise SceneError(
            f"{describe(name)} is a model, not a scene; put it into one, as in "
            f"'run auv_waves --vehicle {name}', or look at it alone: 'view {name}'"
        )
    return _find(name, scenes(), Path(), "scene", SceneError)


def model_path(name: str, base: Path = Path()) -> Path:
    """The file of a vehicle: a path (relative to `base`), or the name of one that ships.

    Raises:
        ModelError: neither exists.
    """
    return _find(name, models(), base, "vehicle", ModelError)


def environment_path(name: str, base: Path = Path()) -> Path:
    """The file of an environment: a path (relative to `base`), or the name of one that ships.

    Raises:
        ModelError: neither exists.
    """
    return _find(name, environments(), base, "environment", ModelError)


def summary(model: Path) -> str:
    """The first line of text in a model's README."""
    readme = model.parent / "README.md"
    lines = readme.read_text().splitlines() if readme.is_file() else []
    return next((line for line in lines if line and not line.startswith("#")), "")


def shipped_folder(kind: str) -> Path:
    """The folder of 'models' or 'scenes': in an installed package, or beside it in a checkout."""
    inside = _PACKAGE / "shipped" / kind
    return inside if inside.is_dir() else _PACKAGE.parent / kind


def _find(
    name: str, shipped: Mapping[str, Path], base: Path, kind: str, error: type[BuoyancyError]
) -> Path:
    """The file that a name stands for, first among those that ship, then as a path."""
    if name in shipped:
        return shipped[name]
    try:
        path = base / Path(name).expanduser()
        is_file = path.is_file()
        is_folder = path.is_dir()
    except (OSError, RuntimeError, ValueError):
        # a name that no file can have, or a home that nobody has
        is_file = is_folder = False
    if is_file:
        return path
    if is_folder:
        raise error(
            f"{kind} {describe(name)} is a folder; give a file, or the name of one that ships: "
            f"{', '.join(shipped)}"
        )
    raise error(
        f"there is no {kind} {describe(name)}, neither a file nor one that ships; "
        f"{choices(name, shipped)}"
    ) from FileNotFoundError(name)

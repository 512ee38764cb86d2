"""`Bundle`: a scene that varies, with its files, for machines that have none of them."""

import atexit
import dataclasses
import functools
import hashlib
import os
import re
import shutil
import socket
import tempfile
from importlib.metadata import version
from pathlib import Path
from typing import NamedTuple

from buoyancy_mj.errors import SweepError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene_files import list_scene_files
from buoyancy_mj.scenes.variations import Variations

_PACKAGE = Path(__file__).resolve().parents[1]
_KINDS = ("models", "scenes")
"""Folders of what ships."""
_LIBRARIES = ("mujoco", "numpy", "numba")
"""Libraries on whose versions the numbers of a run depend."""
_QUOTED = re.compile(r"""(["'])(file://)?([/~][^"'\n]*)\1""")
"""A path in quotes that does not start at the file in which it stands."""
_NAMING = (".toml", ".xml", ".urdf")
"""Endings of files that name other files."""


class Bundle(NamedTuple):
    """A scene that varies, with its files."""

    variations: Variations
    """The scene, as it is where the bundle was made."""
    scene: str | None
    """The scene's file as 'scenes/NAME.toml' if it ships."""
    files: tuple[tuple[Path, bytes], ...]
    """Absolute path and content of each file that does not ship."""
    shipped: tuple[tuple[str, str], ...]
    """Files that ship, as 'models/NAME/NAME.xml', and their checksums."""
    software: str
    """Versions of this package and of what its numbers depend on."""


def pack(variations: Variations) -> Bundle:
    """Put a scene and its files into a bundle.

    Raises:
        SceneError: the scene cannot be read.
        OSError: nor can another file.
    """
    files, shipped = [], []
    for path in list_scene_files(variations.path, variations.settings):
        name = _find_shipped(path)
        if name is None:
            files.append((path, path.read_bytes()))
        else:
            shipped.append((name, _checksum(path.read_bytes())))
    own = Path(os.path.abspath(variations.path))
    variations = dataclasses.replace(variations, path=own)
    scene = _find_shipped(own)
    return Bundle(variations, scene, tuple(files), tuple(shipped), describe_software())


def unpack(bundle: Bundle, folder: Path | None = None) -> Variations:
    """The scene of a bundle, on a machine that may be another.

    Where all files are as they were, as on a file system that the machines share, they are read
    where they are. Otherwise each is written below `folder`, under its whole path, and paths
    in it that lead to others of the bundle are changed.

    Args:
        bundle: the bundle.
        folder: an empty folder; None for one that goes when this process ends.

    Raises:
        SweepError: this machine has other software, or a file that ships differs.
    """
    if bundle.software != describe_software():
        raise SweepError(
            f"the machine {socket.gethostname()} has {describe_software()}, and the sweep was "
            f"started with {bundle.software}; install the same on all machines"
        )
    for name, checksum in bundle.shipped:
        own = _shipped_path(name)
        if not own.is_file() or _checksum(own.read_bytes()) != checksum:
            raise SweepError(
                f"the machine {socket.gethostname()} has another '{name}' than the one from which "
                "the sweep was started; install the same buoyancy_mj on all machines"
            )
    variations = bundle.variations
    if bundle.scene is not None:
        variations = dataclasses.replace(variations, path=_shipped_path(bundle.scene))
    if all(_is_there(path, content) for path, content in bundle.files):
        return variations

    # another machine: all paths go below the folder
    folder = _make_folder() if folder is None else folder
    paths = [str(path) for path, _ in bundle.files]
    for path, content in bundle.files:
        place = _below(folder, path)
        place.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix in _NAMING:
            text = _lead_below(folder, content.decode(errors="surrogateescape"), paths)
            content = text.encode(errors="surrogateescape")
        place.write_bytes(content)
    settings = tuple(_lead_below(folder, _quote(text), paths) for text in variations.settings)
    path = variations.path if bundle.scene is not None else _below(folder, variations.path)
    return dataclasses.replace(variations, path=path, settings=settings, folder=str(folder))


@functools.cache
def describe_software() -> str:
    """Versions of this package, by its sources too, and of what its numbers depend on."""
    sources = sorted(_PACKAGE.rglob("*.py"))
    content = b"".join(source.read_bytes() for source in sources)
    libraries = (f"{name} {version(name)}" for name in _LIBRARIES)
    return f"buoyancy_mj {version('buoyancy_mj')} ({_checksum(content)}), {', '.join(libraries)}"


def _make_folder() -> Path:
    """A folder that goes when this process ends."""
    folder = tempfile.mkdtemp(prefix="buoyancy_mj-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _find_shipped(path: Path) -> str | None:
    """The name of a file that ships, as 'models/NAME/NAME.xml'; None for any other."""
    for kind in _KINDS:
        folder = catalog.shipped_folder(kind)
        if path.is_relative_to(folder):
            return f"{kind}/{path.relative_to(folder).as_posix()}"
    return None


def _shipped_path(name: str) -> Path:
    """Where a file that ships is on this machine."""
    kind, _, rest = name.partition("/")
    return catalog.shipped_folder(kind) / rest


def _is_there(path: Path, content: bytes) -> bool:
    """Whether a file with this content is at its path."""
    try:
        return path.stat().st_size == len(content) and path.read_bytes() == content
    except OSError:
        return False


def _below(folder: Path, path: Path) -> Path:
    """The place of an absolute path below a folder."""
    return folder / path.relative_to(path.anchor)


def _lead_below(folder: Path, text: str, paths: list[str]) -> str:
    """A text whose paths in quotes that lead to some files lead to those below a folder."""

    def move(match: re.Match[str]) -> str:
        quote, scheme, named = match.groups(default="")
        whole = os.path.abspath(os.path.expanduser(named))
        if any(p == whole or p.startswith(f"{whole}/") or whole.startswith(f"{p}:") for p in paths):
            return f"{quote}{scheme}{folder}{whole}{quote}"
        return match.group()

    return _QUOTED.sub(move, text)


def _quote(setting: str) -> str:
    """A setting with quotes around a path that has none."""
    key, _, value = setting.partition("=")
    return f'{key}="{value.strip()}"' if value.strip().startswith(("/", "~")) else setting


def _checksum(content: bytes) -> str:
    """A short checksum."""
    return hashlib.blake2b(content, digest_size=4).hexdigest()

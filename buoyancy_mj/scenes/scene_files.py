"""The files of a scene: what a machine that has none of them needs to run it."""

import json
import os
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import mujoco

from buoyancy_mj.errors import ModelError
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.overrides import apply_setting
from buoyancy_mj.scenes.specs import find_in_package
from buoyancy_mj.scenes.urdf import is_urdf
from buoyancy_mj.settings.texts import parse_toml


def list_scene_files(path: Path, settings: Sequence[str] = ()) -> list[Path]:
    """Files that a scene reads: itself, and what it and its models name.

    A text in the scene that leads to a file names it. Beside a Python file stand those of its
    folder, which it may import. What else a Python file reads is not found.

    Args:
        path: the scene's file.
        settings: texts KEY=VALUE laid over it.

    Returns:
        Absolute paths, sorted, each once.

    Raises:
        SceneError: the scene or a setting cannot be read.
    """
    table = parse_toml(path.read_text(encoding="utf-8"), f"scene '{path}'")
    for setting in settings:
        apply_setting(table, setting)
    found = {path}
    for text in _list_texts(table):
        for named in (text, text.rpartition(":")[0]):
            file = _find(named, path.parent)
            if file is not None:
                found |= {file, *_list_needs(file)}
    return sorted({Path(os.path.abspath(file)) for file in found})


def _list_texts(value: Any) -> Iterator[str]:
    """All texts in a table of a scene, at any depth."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict | list):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _list_texts(inner)


def _find(text: str, folder: Path) -> Path | None:
    """The file that a text names: one that ships, or a path; None if there is none."""
    for shipped in (catalog.models(), catalog.environments()):
        if text in shipped:
            return shipped[text]
    with suppress(OSError, RuntimeError, ValueError):
        file = folder / Path(text).expanduser()
        if text and file.is_file():
            return file
    return None


def _list_needs(file: Path) -> Iterator[Path]:
    """Files that a file of a scene needs."""
    if file.suffix == ".py":
        yield from file.parent.glob("*.py")
    elif is_urdf(file):
        yield from _list_urdf_needs(file)
    elif file.suffix == ".xml":
        # what it lists wrongly, for a file that is included, is not there
        with suppress(mujoco.FatalError):
            for name in mujoco.mju_getXMLDependencies(str(file)):
                if Path(name).is_file():
                    yield from (Path(name), *_list_buffers(Path(name)))


def _list_urdf_needs(file: Path) -> Iterator[Path]:
    """Meshes and pictures of a URDF, wherever MuJoCo looks for them."""
    root = ElementTree.parse(file).getroot()
    compiler = root.find("mujoco/compiler")
    options = {} if compiler is None else compiler.attrib
    folders = [file.parent / options.get("meshdir", ""), file.parent]
    for element in root.iter():
        name = element.get("filename", "").removeprefix("file://")
        if name.startswith(("package://", "model://")):
            with suppress(ModelError):
                yield find_in_package(name, file)
        elif name:
            places = (folder / part for folder in folders for part in (name, Path(name).name))
            for place in places:
                if place.is_file():
                    yield from (place, *_list_buffers(place))


def _list_buffers(file: Path) -> Iterator[Path]:
    """Files in which a glTF file keeps its numbers."""
    if file.suffix == ".gltf":
        with suppress(OSError, ValueError, AttributeError):
            for buffer in json.loads(file.read_text()).get("buffers", ()):
                if (place := file.parent / buffer.get("uri", "")).is_file():
                    yield place

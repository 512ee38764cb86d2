"""The generated part of the documentation site: mkdocs calls the `on_` functions, in this order.

Pages written here: the first page, changes and contributing from the files at the top of the
repository; the reference of public names, one page for each room; the keys of a scene and of the
plugin, from the dataclasses that read them. A public name without a docstring ends the build.
"""

import dataclasses
import html
import math
import re
import types
import typing
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import griffe
from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

from buoyancy_mj._names import read_homes
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.loads.damping import VISCOUS, Damping
from buoyancy_mj.records import field_docs
from buoyancy_mj.scenes.controls import CONTROLS
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import Wave
from buoyancy_mj.settings.config import KEYS
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.toml import CURRENTS, WAVES
from buoyancy_mj.submersion.methods import METHODS, Method
from buoyancy_mj.vehicle.control.controller import Control

ROOT = Path(__file__).resolve().parent.parent
COPIES = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
}
"""Files at the top of the repository, and the pages that they become."""
UNWRITTEN = ("stem", "text", "folder", "viscous")
"""Fields that are no keys: a scene's reader fills in three, the kind of a damping is the fourth."""
WORDS = {bool: "true or false", int: "whole number", float: "number", str: "text", Path: "path"}
"""Types as a writer of TOML says them."""
CLASSES = {
    Wave: tuple(WAVES.values()),
    Method: tuple(METHODS.values()),
    Control: tuple(CONTROLS.values()),
}
"""Classes that stand behind a protocol, or behind one that they share."""
KINDS = {cls: kind for table in (WAVES, CURRENTS, METHODS, CONTROLS) for kind, cls in table.items()}
"""Kinds by the class that each becomes."""
HEAD = ["| key | value | default | meaning |", "| --- | --- | --- | --- |"]


class Table(NamedTuple):
    """A table that a scene may have."""

    path: str
    """Its key, from the top of the scene."""
    kind: str
    """Its kind; empty where it has only one."""
    classes: tuple[type, ...]
    """The dataclasses whose fields are its keys."""


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Put the reference into the navigation."""
    for entry in config.nav:
        if isinstance(entry, dict) and "Reference" in entry:
            entry["Reference"] = [*reference_pages()]
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the generated pages."""
    pages = {page: repository_page(ROOT / name) for name, page in COPIES.items()}
    for name, text in (pages | reference_pages()).items():
        files.append(File.generated(config, name, content=text))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Lead links to files at the top of the repository to the pages that they become."""
    up = "../" * page.file.src_uri.count("/")
    for name, copy in COPIES.items():
        markdown = markdown.replace(f"]({up}../{name}", f"]({up}{copy}")
    return markdown


def on_page_content(content: str, **_: Any) -> str:
    """Turn formulas into MathML, which browsers render by themselves."""

    def formula(found: re.Match[str]) -> str:
        display = "block" if found[1] == "div" else "inline"
        return convert(html.unescape(found[2]), display=display)

    pattern = r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>'
    return re.sub(pattern, formula, content, flags=re.DOTALL)


# pages from the top of the repository -------------------------------------------------------------


def repository_page(path: Path) -> str:
    """A file at the top of the repository as a page, with its links as they are from `docs`."""
    text = path.read_text().replace("](docs/", "](")
    for name, page in COPIES.items():
        text = text.replace(f"]({name}", f"]({page}")
    return text


# the reference ----------------------------------------------------------------------------------


def reference_pages() -> dict[str, str]:
    """All pages of the reference by name."""
    package = griffe.load("buoyancy_mj", search_paths=[str(ROOT)], resolve_aliases=True)
    rooms = public_names()
    names = [name for group in rooms.values() for name in group]
    silent = [path for name in names for path in undocumented(package[name])]
    if silent:
        raise PluginError(f"public names without a docstring: {', '.join(silent)}")
    pages = {"reference/index.md": _overview(package, rooms)}
    for room, group in rooms.items():
        blocks = [f"::: buoyancy_mj.{name}\n" for name in group]
        pages[f"reference/{room}.md"] = "\n".join(
            [f"# {room}\n\n{_first_paragraph(package[room].docstring.value)}\n", *blocks]
        )
    return pages | {"reference/scene.md": scene_page(), "reference/plugin.md": plugin_page()}


def public_names() -> dict[str, list[str]]:
    """The names that `from buoyancy_mj import` gives, by the room that they come from."""
    rooms: dict[str, list[str]] = {}
    for name, module in read_homes(str(ROOT / "buoyancy_mj" / "__init__.py")).items():
        rooms.setdefault(module.split(".")[1], []).append(name)
    return rooms


def undocumented(item: griffe.Object | griffe.Alias) -> Iterator[str]:
    """Paths of a public object and of its public members that have no docstring."""
    if not item.has_docstring:
        yield item.path
    if item.is_class:
        for name, member in item.all_members.items():
            if not name.startswith("_") and not member.has_docstring:
                yield f"{item.path}.{name}"


def _overview(package: griffe.Module, rooms: Mapping[str, list[str]]) -> str:
    """The first page of the reference: every public name with its first line."""
    lines = [
        "# Reference\n",
        "`from buoyancy_mj import ...` gives these names. Files have two pages: "
        "[keys of a scene](scene.md) and [keys of the plugin](plugin.md).\n",
        "| name | |",
        "| --- | --- |",
    ]
    for room, names in rooms.items():
        for name in names:
            said = _first_paragraph(package[name].docstring.value)
            lines.append(f"| [`{name}`]({room}.md#buoyancy_mj.{name}) | {said} |")
    return "\n".join(lines) + "\n"


def _first_paragraph(text: str) -> str:
    """The first paragraph of a docstring, on one line."""
    return " ".join(text.strip().split("\n\n")[0].split())


# keys -------------------------------------------------------------------------------------------


def scene_page() -> str:
    """Every key of a scene."""
    parts = [
        "# Keys of a scene\n",
        "A scene is a TOML file. This page lists every key that it may have, and `--set KEY=VALUE`",
        "reaches each. Units are SI, angles are radians.\n",
        "## At the top\n",
        *HEAD,
        *rows(Scene).values(),
        "",
    ]
    for path, kind, classes in tables(Scene):
        parts.append(f"## `{path}`, kind `{kind}`\n" if kind else f"## `{path}`\n")
        parts.append(f"{_first_paragraph(classes[0].__doc__ or '')}\n")
        parts += [*HEAD, *(row for cls in classes for row in rows(cls).values()), ""]
    return "\n".join(parts)


def plugin_page() -> str:
    """Every key of the plugin."""
    known = rows(Water) | rows(Settings)
    return "\n".join(
        [
            "# Keys of the plugin\n",
            "A key stands in `<config key=... value=.../>` of an instance of the plugin",
            "`buoyancy_mj.water`. This page lists all of them; each may be left out.\n",
            *HEAD,
            *(known[key] for key in KEYS),
            "",
            "A value is written as in TOML, without blanks inside. A wave, a current, a method and",
            "a damping are a kind and its fields, `regular amplitude=0.3 period=2`; a semicolon",
            "separates waves. A constant current is three numbers; `geoms`, `hull` and `fill` are",
            "patterns between blanks; quotes keep one with a blank together. `add_water` writes",
            "the key `instance` too, by which the water knows whether it was attached. The fields",
            "are those of the [tables of a scene](scene.md).\n",
        ]
    )


def tables(cls: type, path: str = "") -> Iterator[Table]:
    """The tables inside a table, and those inside them."""
    hints = typing.get_type_hints(cls)
    for field in _keys(cls):
        place = f"{path}{field.name}"
        for inner in _classes(hints.get(field.name)):
            if inner is Damping:
                for kind, viscous in VISCOUS.items():
                    yield Table(place, kind, (viscous, inner) if viscous else (inner,))
            else:
                yield Table(place, KINDS.get(inner, ""), (inner,))
                yield from tables(inner, f"{place}.")


def rows(cls: type) -> dict[str, str]:
    """The keys of a dataclass, each with its row of a page."""
    hints = typing.get_type_hints(cls) | typing.get_type_hints(Selection)
    docs = field_docs(cls) | field_docs(Selection)
    result = {}
    for field in _keys(cls):
        meaning = " ".join(docs[field.name].split())
        cells = (f"`{field.name}`", _value(hints[field.name]), _default(field), meaning)
        result[field.name] = f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"
    return result


def _keys(cls: type) -> Iterator[dataclasses.Field[Any]]:
    """The fields that are keys, those of the class itself first; a selection stands among them."""
    fields = {field.name: field for field in dataclasses.fields(cls)}
    for name in dict.fromkeys([*cls.__annotations__, *fields]):
        if name == "selection":
            yield from dataclasses.fields(Selection)
        elif name in fields and name not in UNWRITTEN:
            yield fields[name]


def _classes(hint: Any) -> Iterator[type]:
    """The dataclasses that a value of a type may be."""
    if hint in CLASSES:
        yield from CLASSES[hint]
    elif dataclasses.is_dataclass(hint):
        yield hint
    elif typing.get_origin(hint) in (typing.Union, types.UnionType, tuple):
        for part in typing.get_args(hint):
            yield from _classes(part)


def _value(hint: Any) -> str:
    """What may be written for a field."""
    origin, parts = typing.get_origin(hint), typing.get_args(hint)
    if hint in WORDS:
        return WORDS[hint]
    if origin in (typing.Union, types.UnionType):
        lists = [part for part in parts if typing.get_origin(part) is Sequence]
        parts = [part for part in parts if part is not type(None)]
        return " or ".join(dict.fromkeys(filter(None, map(_value, lists or parts))))
    if origin is Sequence or (origin is tuple and parts[-1] is Ellipsis):
        is_table = parts[0] in CLASSES or dataclasses.is_dataclass(parts[0])
        return f"list of {WORDS.get(parts[0], 'table' if is_table else 'list')}s"
    if origin is tuple:
        return f"list of {len(parts)} {WORDS[parts[0]]}s"
    if origin is Mapping:
        return ""
    return "kind or table" if hint in (Method, Damping) else "table"


def _default(field: dataclasses.Field[Any]) -> str:
    """What a field is if it is left out."""
    value = field.default
    if value is dataclasses.MISSING:
        return "**needed**"
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if dataclasses.is_dataclass(value):
        return f"`{KINDS[type(value)]}`" if type(value) in KINDS else ""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, tuple):
        return f"`{list(value)}`"
    return f'`"{value}"`' if isinstance(value, str) else f"`{value:g}`"

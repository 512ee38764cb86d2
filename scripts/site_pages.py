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
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import griffe
from latex2mathml.converter import convert
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File, Files

from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.sea.currents import Current
from buoyancy_mj.sea.water import Water
from buoyancy_mj.sea.waves import Wave
from buoyancy_mj.settings.settings import CURRENTS, KEYS, WAVES, Settings
from buoyancy_mj.submersion.methods import METHODS, Method

ROOT = Path(__file__).resolve().parent.parent
COPIES = {
    "README.md": "index.md",
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
}
"""Files at the top of the repository, and the pages that they become."""
UNWRITTEN = ("text", "folder")
"""Fields of a scene that its reader fills in."""
WORDS = {bool: "true or false", int: "whole number", float: "number", str: "text", Path: "path"}
"""Types as a writer of TOML says them."""
KINDS = {cls: kind for table in (WAVES, CURRENTS, METHODS) for kind, cls in table.items()}
"""Kinds by the class that each becomes."""
CHOICES = {Wave: tuple(WAVES.values()), Method: tuple(METHODS.values())}
"""Classes that stand behind a protocol."""


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
    rooms: dict[str, list[str]] = {}
    for name, member in package.members.items():
        if member.is_alias and not name.startswith("_"):
            rooms.setdefault(member.target_path.split(".")[1], []).append(name)
    silent = [
        path for names in rooms.values() for name in names for path in undocumented(package[name])
    ]
    if silent:
        raise PluginError(f"public names without a docstring: {', '.join(silent)}")
    pages = {"reference/index.md": _overview(package, rooms)}
    for room, names in rooms.items():
        blocks = [f"::: buoyancy_mj.{name}\n" for name in names]
        pages[f"reference/{room}.md"] = "\n".join(
            [f"# {room}\n\n{_said(package[room])}\n", *blocks]
        )
    return pages | {
        "reference/scene.md": scene_page(package),
        "reference/plugin.md": plugin_page(package),
    }


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
            lines.append(f"| [`{name}`]({room}.md#buoyancy_mj.{name}) | {_said(package[name])} |")
    return "\n".join(lines) + "\n"


def _said(item: griffe.Object | griffe.Alias) -> str:
    """The first paragraph of a docstring, on one line."""
    return " ".join(item.docstring.value.split("\n\n")[0].split())


# keys -------------------------------------------------------------------------------------------


def scene_page(package: griffe.Module) -> str:
    """Every key of a scene."""
    parts = [
        "# Keys of a scene\n",
        "A scene is a TOML file. This page lists every key that it may have; `--set KEY=VALUE` reaches each. "
        "Units are SI, angles radians.\n",
        "## At the top\n",
        _table(package, Scene),
    ]
    for path, cls in _tables(Scene):
        parts += [
            f"## {_heading(path, cls)}\n",
            _said(_definition(package, cls)) + "\n",
            _table(package, cls),
        ]
    return "\n".join(parts)


def plugin_page(package: griffe.Module) -> str:
    """Every key of the plugin."""
    rows = {}
    for owner in (Water, Settings, *_dataclasses(Settings)):
        rows |= {
            name: row for name, row in _rows(package, owner) if name in KEYS and name not in rows
        }
    missing = set(KEYS) - set(rows)
    if missing:
        raise PluginError(f"keys of the plugin that no dataclass has: {', '.join(sorted(missing))}")
    return "\n".join(
        [
            "# Keys of the plugin\n",
            "A key stands in `<config key=... value=.../>` of an instance of `buoyancy_mj.water`. "
            "This page lists all of them; each may be left out.\n",
            "| key | value | default | meaning |",
            "| --- | --- | --- | --- |",
            *(rows[key] for key in KEYS),
            "",
            "A value is written as in TOML, without blanks inside. A wave, a current, a method and a damping are a kind and "
            "its fields, `regular amplitude=0.3 period=2`, and a semicolon separates waves. A constant current is three "
            "numbers; `geoms`, `hull` and `fill` are patterns between blanks. The fields are those of the "
            "[tables of a scene](scene.md).\n",
        ]
    )


def _heading(path: str, cls: type) -> str:
    """How a table of a scene is headed, with its kind where it has one."""
    kind = KINDS.get(cls) or (
        cls.__name__.lower() if path.count(".") and cls not in (Water,) else ""
    )
    return f"`{path}`, kind `{kind}`" if kind else f"`{path}`"


def _tables(cls: type, path: str = "") -> Iterator[tuple[str, type]]:
    """The tables in a table, and theirs, with their paths."""
    for field in dataclasses.fields(cls):
        for inner in _classes(typing.get_type_hints(cls)[field.name]):
            place = f"{path}{field.name}"
            yield place, inner
            yield from _tables(inner, f"{place}.")


def _dataclasses(cls: type) -> Iterator[type]:
    """The dataclasses that the fields of a dataclass hold."""
    return (inner for _, inner in _tables(cls))


def _classes(hint: Any) -> Iterator[type]:
    """The dataclasses that a value of a type may be."""
    if hint in CHOICES:
        yield from CHOICES[hint]
    elif dataclasses.is_dataclass(hint):
        yield hint
    elif typing.get_origin(hint) in (typing.Union, types.UnionType):
        for part in typing.get_args(hint):
            yield from _classes(part)


def _table(package: griffe.Module, cls: type) -> str:
    """The keys of a dataclass as a table."""
    rows = [row for _, row in _rows(package, cls)]
    return "\n".join(
        ["| key | value | default | meaning |", "| --- | --- | --- | --- |", *rows, ""]
    )


def _rows(package: griffe.Module, cls: type) -> Iterator[tuple[str, str]]:
    """Each field of a dataclass, and its row."""
    documented = _definition(package, cls).all_members
    hints = typing.get_type_hints(cls)
    for field in dataclasses.fields(cls):
        if field.name in UNWRITTEN:
            continue
        meaning = " ".join(documented[field.name].docstring.value.split())
        cells = (f"`{field.name}`", _value(hints[field.name]), _default(field), meaning)
        yield field.name, f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _definition(package: griffe.Module, cls: type) -> griffe.Object | griffe.Alias:
    """A class as griffe read it."""
    return package[f"{cls.__module__.removeprefix('buoyancy_mj.')}.{cls.__name__}"]


def _value(hint: Any) -> str:
    """What may be written for a field."""
    if hint in WORDS:
        return WORDS[hint]
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        parts = [part for part in typing.get_args(hint) if part is not type(None)]
        if Wave in parts:
            return "list of tables"
        return " or ".join(dict.fromkeys(_value(part) for part in parts))
    if typing.get_origin(hint) is tuple:
        first, *others = typing.get_args(hint)
        if others and others[-1] is Ellipsis:
            return f"list of {WORDS.get(first, 'list')}s"
        return f"list of {len(others) + 1} {WORDS[first]}s"
    return "kind or table" if hint is Method or hint in KINDS else "table"


def _default(field: dataclasses.Field[Any]) -> str:
    """What a field is if it is left out."""
    value = field.default
    if value is dataclasses.MISSING:
        return "" if field.default_factory is not dataclasses.MISSING else "**needed**"
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    if dataclasses.is_dataclass(value):
        return f"`{KINDS[type(value)]}`" if type(value) in KINDS else ""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, tuple):
        return f"`{list(value)}`"
    return f'`"{value}"`' if isinstance(value, str) else f"`{value:g}`"

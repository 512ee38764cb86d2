"""Draw the house: the rooms of the package along the river, and list them on the page.

    .venv/bin/python scripts/draw_house.py

It reads the imports of every module and the docstring of every room. It writes
docs/architecture.png, and the table between two marks in docs/architecture.md. The same code gives
the same picture and the same table.
"""

import ast
import dataclasses
import itertools
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch, PathPatch
from matplotlib.path import Path as Curve

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "buoyancy_mj"
PAGE, PICTURE = ROOT / "docs" / "architecture.md", ROOT / "docs" / "architecture.png"
MARKS = ("<!-- written by scripts/draw_house.py -->\n", "<!-- end -->\n")
"""What stands before and after the table on the page."""
WIDTH, HEIGHT, GAP = 12.0, 1.1, 0.72
"""Width of the picture, height of a room and distance between floors."""
LEAST = 2.15
"""Width of a room without lines, at which its name and their number stand side by side."""
EVERYWHERE = {"displays", "errors", "files", "records", "values"}
"""Small rooms that serve any other, so that their streams would say nothing."""
INK, WATER, BANK = "#12343b", "#2a8ca8", "#e9f4f5"


@dataclasses.dataclass(frozen=True)
class Room:
    """A package, or a module that stands alone."""

    name: str
    """Its name inside the package."""
    floor: int
    """0 where it imports nothing, else one more than the floors of all that it imports."""
    lines: int
    """How many lines its files have."""
    idea: str
    """The first sentence of its docstring."""
    goes_in: str
    """What comes in, as its docstring says."""
    goes_out: str
    """What goes out, as its docstring says."""
    may_import: frozenset[str]
    """The rooms that its docstring lets it import."""
    imports: frozenset[str]
    """The rooms that it does import."""


# reading ------------------------------------------------------------------------------------------


def read_rooms() -> list[Room]:
    """All rooms, from the source to the mouth."""
    files = {
        path.stem: sorted(path.rglob("*.py")) or [path]
        for path in sorted((ROOT / PACKAGE).iterdir())
        if not path.name.startswith("_") and (path.suffix == ".py" or path.is_dir())
    }
    exports = {
        alias.asname: node.module.split(".")[1]
        for node in ast.parse((ROOT / PACKAGE / "__init__.py").read_text()).body
        if isinstance(node, ast.ImportFrom) and node.module.startswith(f"{PACKAGE}.")
        for alias in node.names
    }
    imports = {
        name: frozenset(room for file in group for room in _imports(file, exports))
        & (files.keys() - {name})
        for name, group in files.items()
    }
    rooms = [_read_room(name, files[name], imports) for name in files]
    return sorted(rooms, key=lambda room: (room.floor, room.name))


def _read_room(name: str, files: Sequence[Path], imports: Mapping[str, frozenset[str]]) -> Room:
    """One room, by its files and by what each room imports."""

    def floor(room: str) -> int:
        return max((1 + floor(source) for source in imports[room]), default=0)

    first = next((file for file in files if file.stem == "__init__"), files[0])
    said = ast.get_docstring(ast.parse(first.read_text())) or ""
    allowed = _entry(said, "May import")
    named = imports.keys() & {*re.findall(r"\w+", allowed)}
    return Room(
        name=name,
        floor=floor(name),
        lines=sum(file.read_text().count("\n") for file in files),
        idea=" ".join(said.split("\n\n")[0].split()),
        goes_in=_entry(said, "In"),
        goes_out=_entry(said, "Out"),
        may_import=frozenset(imports) if "every other room" in allowed else frozenset(named),
        imports=imports[name],
    )


def _entry(docstring: str, key: str) -> str:
    """What follows a key in a docstring, up to the next key or paragraph."""
    pattern = rf"^{key}: (.*?)(?=\n[A-Z][\w ]*: |\n\n|\Z)"
    found = re.search(pattern, docstring, re.DOTALL | re.MULTILINE)
    return " ".join(found[1].split()) if found else ""


def _imports(file: Path, exports: Mapping[str, str]) -> Iterator[str]:
    """The rooms that a file imports from."""
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module == PACKAGE:
            yield from (exports.get(alias.name, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom | ast.Import):
            module = getattr(node, "module", None)
            for path in [module] if module else [alias.name for alias in node.names]:
                package, _, rest = path.partition(".")
                if package == PACKAGE and rest:
                    yield rest.split(".")[0]


# writing ------------------------------------------------------------------------------------------


def table(rooms: Sequence[Room]) -> str:
    """The rooms and their imports as a table of Markdown."""
    order = [room.name for room in rooms]
    lines = ["| room | comes in | goes out | imports |", "| --- | --- | --- | --- |"]
    for room in rooms:
        imports = ", ".join(sorted(room.imports, key=order.index, reverse=True)) or "nothing"
        lines.append(f"| `{room.name}` | {room.goes_in} | {room.goes_out} | {imports} |")
    return "\n".join(lines) + "\n"


def write_table(rooms: Sequence[Room]) -> None:
    """Put the table onto the page, between its marks."""
    before, rest = PAGE.read_text().split(MARKS[0])
    _, after = rest.split(MARKS[1])
    PAGE.write_text(f"{before}{MARKS[0]}\n{table(rooms)}\n{MARKS[1]}{after}")


# drawing ------------------------------------------------------------------------------------------


class Box(NamedTuple):
    """Where a room stands on the picture."""

    x: float
    """Of its middle."""
    y: float
    """Of its top."""
    width: float
    """Broader with more lines."""


def draw(rooms: Sequence[Room]) -> Figure:
    """The picture: floors from top to bottom, a stream from each room to those that it feeds."""
    tall = 0.45 + (1 + rooms[-1].floor) * (HEIGHT + GAP)
    figure = Figure(figsize=(WIDTH, tall))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, WIDTH), ylim=(tall, 0.0))
    axes.axis("off")

    _draw_banks(axes, tall)
    sources = first_sources(rooms)
    boxes = _place(rooms, sources)
    for room in rooms:
        for source in sources[room.name]:
            _draw_stream(axes, boxes[source], boxes[room.name], boxes.values())
    for room in rooms:
        _draw_room(axes, room, boxes[room.name])
    return figure


def first_sources(rooms: Sequence[Room]) -> dict[str, list[str]]:
    """For each room those imports that no other of its imports has upstream."""
    upstream: dict[str, frozenset[str]] = {}
    for room in rooms:
        upstream[room.name] = room.imports.union(*(upstream[name] for name in room.imports))
    return {
        room.name: sorted(
            name
            for name in room.imports - EVERYWHERE
            if not any(name in upstream[other] for other in room.imports)
        )
        for room in rooms
    }


def _draw_banks(axes: Axes, tall: float) -> None:
    """The river behind everything, from a spring to a broad mouth."""
    y = np.linspace(0.0, tall, 300)
    middle = 0.5 * WIDTH + 0.2 * np.sin(1.1 * y)
    half = 4.3 + 1.5 * (1.0 - np.exp(-0.3 * y))
    axes.fill_betweenx(y, middle - half, middle + half, color=BANK, linewidth=0.0, zorder=0)


def _place(rooms: Sequence[Room], sources: Mapping[str, Sequence[str]]) -> dict[str, Box]:
    """A place for each room; on each floor in the order that makes the streams shortest."""
    boxes: dict[str, Box] = {}

    def drift(row: Mapping[str, Box]) -> float:
        return sum(
            abs(box.x - boxes[source].x) for name, box in row.items() for source in sources[name]
        )

    for floor, group in itertools.groupby(rooms, key=lambda room: room.floor):
        y = 0.45 + floor * (HEIGHT + GAP)
        rows = [_place_row(row, y) for row in itertools.permutations(group)]
        boxes |= min(rows, key=drift)
    return boxes


def _place_row(row: Sequence[Room], y: float) -> dict[str, Box]:
    """Rooms side by side, in the middle of the picture."""
    gap = 0.45 if len(row) < 4 else 0.2
    free = WIDTH - gap * (len(row) + 1)
    lines = [room.lines / 1800.0 for room in row]
    # a large room leaves its neighbours the width of their names
    share = min(1.0, (free - LEAST * len(row)) / sum(lines))
    least = min(2.75, (free - share * sum(lines)) / len(row))
    widths = [least + share * more for more in lines]
    x = 0.5 * (WIDTH - sum(widths) - gap * (len(row) - 1))
    boxes = {}
    for room, width in zip(row, widths, strict=True):
        boxes[room.name] = Box(x + 0.5 * width, y, width)
        x += width + gap
    return boxes


def _draw_stream(axes: Axes, source: Box, mouth: Box, boxes: Iterable[Box]) -> None:
    """A stream from the bottom of one room to the top of another, around the rooms between them."""
    between = [box for box in boxes if source.y < box.y < mouth.y]
    lane = _free_lane(0.5 * (source.x + mouth.x), between)

    # it leaves and enters on the side where its way lies
    first = lane if between else mouth.x
    last = lane if between else source.x
    x0 = source.x + 0.3 * source.width * np.tanh((first - source.x) / 2.0)
    x1 = mouth.x + 0.3 * mouth.width * np.tanh((last - mouth.x) / 2.0)
    y0 = source.y + HEIGHT
    y1 = mouth.y - 0.09

    # bends above and below the rooms between, and straight along them
    points = [(x0, y0), (x1, y1)]
    if between:
        top = min(box.y for box in between)
        bottom = max(box.y for box in between) + HEIGHT
        points[1:1] = [(lane, top), (lane, bottom)]
    vertices = [points[0]]
    for (xa, ya), (xb, yb) in itertools.pairwise(points):
        bend = 0.5 * (yb - ya)
        vertices += [(xa, ya + bend), (xb, yb - bend), (xb, yb)]
    curve = Curve(vertices, [Curve.MOVETO] + [Curve.CURVE4] * (len(vertices) - 1))
    axes.add_patch(PathPatch(curve, facecolor="none", edgecolor=WATER, linewidth=2.4, zorder=1))
    axes.plot(x1, y1, marker="v", color=WATER, markersize=8.0, zorder=2)


def _free_lane(x: float, between: Sequence[Box]) -> float:
    """The place nearest to x that passes beside all rooms between."""
    edges = [(box.x - 0.5 * box.width - 0.2, box.x + 0.5 * box.width + 0.2) for box in between]
    lanes = [
        lane
        for lane in (x, *itertools.chain(*edges))
        if not any(low < lane < high for low, high in edges)
    ]
    return min(lanes, key=lambda lane: abs(lane - x))


def _draw_room(axes: Axes, room: Room, box: Box) -> None:
    """A room with its name, its size and its idea."""
    left = box.x - 0.5 * box.width
    right = box.x + 0.5 * box.width
    frame = FancyBboxPatch(
        (left, box.y),
        box.width,
        HEIGHT,
        boxstyle="round,pad=0,rounding_size=0.14",
        facecolor="white",
        edgecolor=INK,
        linewidth=1.4,
        zorder=3,
    )
    axes.add_patch(frame)
    style = {"color": INK, "va": "center", "zorder": 4}
    axes.text(left + 0.16, box.y + 0.28, room.name, fontsize=17, weight="bold", **style)
    size = f"{round(room.lines, -2):,}"
    # where name and size have room beside each other
    if 0.155 * len(room.name) + 1.2 < box.width:
        size += " lines"
    axes.text(right - 0.16, box.y + 0.29, size, fontsize=11, ha="right", **style | {"color": WATER})
    idea = textwrap.fill(room.idea, int(9.7 * box.width), max_lines=2, placeholder=" ...")
    axes.text(left + 0.16, box.y + 0.76, idea, fontsize=12.5, linespacing=1.15, **style)


if __name__ == "__main__":
    HOUSE = read_rooms()
    write_table(HOUSE)
    draw(HOUSE).savefig(PICTURE, dpi=100, metadata={"Software": None})

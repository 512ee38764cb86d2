"""The summary of a run as tables in Markdown: in short beside the picture, and as a whole."""

from typing import NamedTuple

from buoyancy_mj.scenes.summary import Summary


class Text(NamedTuple):
    """A text in Markdown."""

    text: str
    """The text."""
    rows: int
    """Number of rows of its table."""


def write_numbers(summary: Summary) -> Text:
    """Write the numbers of a summary: two beside each other for one vehicle, or a column each."""
    rows = summary.numbers()
    # without the title of the scene, which takes much width and stands over the picture
    if len(summary.vehicles) > 1:
        return Text(_table(("", *summary.vehicles), rows), len(rows))
    half = -(-len(rows) // 2)
    beside = [(*left, *right) for left, right in zip(rows, [*rows[half:], ("", "")], strict=False)]
    return Text(_table(("", "", "", ""), beside[:half]), half)


def write_summary(summary: Summary) -> str:
    """Write a summary with each of its rows."""
    if len(summary.vehicles) > 1:
        head = ("", *summary.vehicles)
        return f"{_table(head, summary.rows())}\n{summary.caption}\n"
    return _table((summary.scene, ""), summary.rows())


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table under a head."""
    lines = [head, ("---",) * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)

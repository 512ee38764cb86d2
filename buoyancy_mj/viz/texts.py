"""`write_summary`: the summary of a run as a table in Markdown, no longer than it has to be."""

from typing import NamedTuple

from buoyancy_mj.scenes.summary import Summary


class Text(NamedTuple):
    """A text in Markdown."""

    text: str
    """The text."""
    rows: int
    """Number of rows of its table."""


def write_summary(summary: Summary) -> Text:
    """Write a summary as a table: two rows beside each other for one vehicle, or a column each."""
    rows = summary.rows()
    if len(summary.vehicles) > 1:
        # the title of the scene would take the width of a vehicle
        names = ("", *summary.vehicles)
        return Text(f"{_table(names, rows)}\n{summary.caption}\n", len(rows) + 1)
    half = -(-len(rows) // 2)
    blank = ("",) * len(rows[0])
    beside = [(*left, *right) for left, right in zip(rows, [*rows[half:], blank], strict=False)]
    head = (summary.scene, *[""] * (2 * len(blank) - 1))
    return Text(_table(head, beside[:half]), half)


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """A table under a head."""
    lines = [head, ("---",) * len(head), *rows]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)

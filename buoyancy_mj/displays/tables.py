"""`write_table`: names and values as a table of HTML."""

import html
from collections.abc import Sequence

_CELL = "text-align:left;padding:1px 12px 1px 0;vertical-align:top"


def write_table(
    title: str, rows: Sequence[Sequence[str]], header: Sequence[str] = (), below: str = ""
) -> str:
    """Write a table of HTML.

    Args:
        title: what stands over it.
        rows: texts of the cells, the name first.
        header: names of the columns; none for a table of names and values.
        below: HTML that stands under it, such as charts.
    """
    lines = [_write_row("th", header)] if header else []
    lines += [_write_row("td", row) for row in rows]
    caption = f'<div style="font-weight:600;margin-bottom:2px">{html.escape(title)}</div>'
    return f"<div>{caption}<table>{''.join(lines)}</table>{below}</div>"


def _write_row(kind: str, cells: Sequence[str]) -> str:
    """A row of cells of a kind, 'td' or 'th'."""
    written = (f'<{kind} style="{_CELL}">{html.escape(cell)}</{kind}>' for cell in cells)
    return f"<tr>{''.join(written)}</tr>"

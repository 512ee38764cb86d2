"""The tables of figures in README.md and docs/guide/performance.md, written from saved runs.

A page has a block for each table, between a line `<!-- written by scripts/bench.py: NAME -->` and a
line `<!-- end -->`; see `render` for the names.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from benchmarks import profile
from benchmarks.rows import Row
from benchmarks.runs import FOLDER, Run

ROOT = FOLDER.parents[1]
PAGES = (ROOT / "README.md", ROOT / "docs" / "guide" / "performance.md")
"""The pages with blocks."""
_BLOCK = re.compile(
    r"(<!-- written by scripts/bench\.py: (\w+) -->\n).*?(<!-- end -->\n)", re.DOTALL
)

Rows = Mapping[str, Callable[[Any], Iterable[Row]]]
"""What gives the rows of each benchmark, from its results."""


def write_pages(runs: Sequence[Run], rows: Rows) -> None:
    """Write all blocks of all pages anew."""
    for page in PAGES:
        page.write_text(render(page.read_text(), runs, rows))


def render(text: str, runs: Sequence[Run], rows: Rows) -> str:
    """The text of a page with its blocks written anew.

    Args:
        text: the page.
        runs: the runs that it shows, a column for each.
        rows: what gives the rows of each benchmark.

    Raises:
        KeyError: a block of an unknown name; known are 'first' and 'table', the rows of the first
            page and all rows; 'profile', where a step goes on the first machine that measured it;
            and 'machines', what each run was measured on.
    """
    blocks = {
        "first": lambda: _list_rows(runs, rows, only_first=True),
        "table": lambda: _list_rows(runs, rows, only_first=False),
        "profile": lambda: _list_profile(runs),
        "machines": lambda: _list_machines(runs),
    }

    def write(match: re.Match[str]) -> str:
        lines = "".join(f"{line}\n" for line in blocks[match[2]]())
        return f"{match[1]}\n{lines}\n{match[3]}"

    return _BLOCK.sub(write, text)


def _list_rows(runs: Sequence[Run], rows: Rows, *, only_first: bool) -> Iterator[str]:
    """The table of figures: a line for each row that any run has."""
    found: dict[tuple[str, str, str], dict[str, str]] = {}
    for name, give in rows.items():
        for run in runs:
            for row in give(run.results[name]) if name in run.results else ():
                if row.first or not only_first:
                    found.setdefault((name, *row.key), {})[run.label] = row.cell
    labels = [run.label for run in runs if any(run.label in cells for cells in found.values())]
    yield _line(["measured", *labels, "the factor is", "`--only`"])
    yield _line(["---", *["---:"] * len(labels), "---", "---"])
    for (name, what, relation), cells in found.items():
        yield _line([what, *(cells.get(label, "") for label in labels), relation, f"`{name}`"])


def _list_profile(runs: Sequence[Run]) -> Iterator[str]:
    """Where a step goes, in per cent, on the first machine on which that was measured."""
    results = next((run.results["profile"] for run in runs if "profile" in run.results), {})
    if not results:
        return
    columns = profile.list_columns(results)
    yield _line(["scene", "step", *columns, "together"])
    yield _line(["---", *["---:"] * (len(columns) + 2)])
    for name, cells in profile.list_shares(results):
        yield _line([name, *cells])


def _list_machines(runs: Sequence[Run]) -> Iterator[str]:
    """A line for each run."""
    for run in runs:
        told = {name: text for name, text in run.machine.items() if name not in _IN_LABEL}
        details = ", ".join(f"{name} {text}" for name, text in told.items())
        yield f"- {run.label}: {details}"


_IN_LABEL = ("processor", "vectors")


def _line(cells: Iterable[str]) -> str:
    """A line of a table."""
    return f"| {' | '.join(cells)} |"

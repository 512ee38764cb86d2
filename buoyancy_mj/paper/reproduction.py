"""The reproduction as a whole: run the studies, and write their tables, figures and page."""

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from buoyancy_mj.errors import BuoyancyError, choices
from buoyancy_mj.files import replace_file, require_own
from buoyancy_mj.paper.contents import STUDIES
from buoyancy_mj.paper.page import PAGE_TITLE, render_page
from buoyancy_mj.paper.study import Result, Study, Table

HEADER = ("claim", "the paper", "measured here", "holds?", "command")
"""Header of the table of claims."""


def reproduce(
    folder: Path,
    only: Sequence[str] = (),
    *,
    quick: bool = False,
    begin: Callable[[Study], None] = lambda _: None,
) -> list[tuple[str, ...]]:
    """Run the studies, and write what each measures as soon as it is done.

    Args:
        folder: where NAME.csv and NAME.png go; and, unless `only` some studies run, claims.csv and
            a README.md of all.
        only: names of studies; empty for all.
        quick: run coarsely and shortly, to see that everything works.
        begin: called with each study before it runs.

    Returns:
        The table of claims, rows as in `HEADER`.

    Raises:
        BuoyancyError: there is no such study, or the folder cannot be written to.
    """
    for name in only:
        if name not in STUDIES:
            raise BuoyancyError(f"there is no study '{name}'; {choices(name, STUDIES)}")

    rows: list[tuple[str, ...]] = []
    try:
        page = folder / "README.md"
        require_own(page, PAGE_TITLE)
        for name, study in STUDIES.items():
            if only and name not in only:
                continue
            begin(study)
            result = study.measure(quick)
            _write_result(folder, study, result)
            command = f"buoyancy-mj paper --only {name}"
            rows += [
                (claim.statement, claim.published, claim.measured, claim.verdict, command)
                for claim in result.claims
            ]
        if not only:
            _write_csv(folder / "claims.csv", HEADER, rows)
            with replace_file(page) as part:
                part.write_text(render_page(HEADER, rows, quick=quick))
    except OSError as error:
        raise BuoyancyError(f"cannot write the reproduction to '{folder}': {error}") from error
    return rows


def _write_result(folder: Path, study: Study, result: Result) -> None:
    """Write the tables and the figure of a study."""
    for name, table in result.tables.items():
        _write_csv(folder / f"{name}.csv", list(table), _format_rows(table))
    if study.draw is not None:
        from buoyancy_mj.plotting.style import save_figure, use_style  # needs Matplotlib

        with use_style():
            save_figure(study.draw(result), folder / f"{study.name}.png")


def _format_rows(table: Table) -> Iterable[tuple[str, ...]]:
    """Rows of a table as text, numbers with seven digits."""
    return zip(
        *([v if isinstance(v, str) else f"{v:.7g}" for v in column] for column in table.values()),
        strict=True,
    )


def _write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    """Write a table; one of the same columns that is there is replaced."""
    require_own(path, _format_csv([header]))
    with replace_file(path) as part:
        part.write_text(_format_csv([header, *rows]))


def _format_csv(rows: Iterable[Sequence[str]]) -> str:
    """Rows as comma-separated values."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()

"""The reproduction as a whole: run the studies, write tables and pictures, hold the claims against what was measured."""

import csv
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from buoyancy_mj.errors import BuoyancyError, choices
from buoyancy_mj.paper.page import page
from buoyancy_mj.paper.studies import STUDIES
from buoyancy_mj.paper.study import Result, Study, Table

HEADER = ("claim", "the paper", "measured here", "holds?", "command")
"""Of the table of claims."""
DPI = 110


def reproduce(
    folder: Path,
    only: Sequence[str] = (),
    *,
    quick: bool = False,
    begin: Callable[[Study], None] = lambda study: None,
) -> list[tuple[str, ...]]:
    """Run the studies; what each finds is written as soon as it is found.

    Args:
        folder: where NAME.csv and NAME.png go; and, unless `only` some run, claims.csv and a README.md of all.
        only: names of studies; none for all.
        quick: coarse and short, to see that it runs.
        begin: called with each study before it runs.

    Returns:
        The table of claims, rows as in `HEADER`.

    Raises:
        BuoyancyError: there is no such study, or the folder cannot be written to.
    """
    for name in only:
        if name not in STUDIES:
            raise BuoyancyError(f"there is no study '{name}'; {choices(name, STUDIES)}")
    chosen = [study for name, study in STUDIES.items() if not only or name in only]
    rows: list[tuple[str, ...]] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for study in chosen:
            begin(study)
            result = study.run(quick)
            _write(folder, study, result)
            command = f"buoyancy-mj paper --only {study.name}"
            rows += [(c.claim, c.paper, c.measured, c.holds, command) for c in result.claims]
        if not only:
            _write_csv(folder / "claims.csv", HEADER, rows)
            (folder / "README.md").write_text(page(HEADER, rows, quick=quick))
    except OSError as error:
        raise BuoyancyError(f"cannot write the reproduction to '{folder}': {error}") from error
    return rows


def _write(folder: Path, study: Study, result: Result) -> None:
    """The tables and the picture of a study."""
    for name, table in result.tables.items():
        _write_csv(folder / f"{name}.csv", list(table), _rows(table))
    if study.draw is not None:
        study.draw(result).savefig(
            folder / f"{study.name}.png", dpi=DPI, metadata={"Software": None}
        )


def _rows(table: Table) -> Iterable[tuple[str, ...]]:
    """Rows of a table as text, numbers with seven digits."""
    return zip(
        *([v if isinstance(v, str) else f"{v:.7g}" for v in column] for column in table.values()),
        strict=True,
    )


def _write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[str]]) -> None:
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)

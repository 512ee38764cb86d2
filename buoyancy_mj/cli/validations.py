"""`validate`: published experiments and closed forms beside what comes out here."""

import itertools
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from buoyancy_mj.cli.common import app, err, quote, report_errors
from buoyancy_mj.cli.common import out as console


@app.command()
@report_errors
def validate(
    only: Annotated[
        list[str] | None, typer.Option(help="Only these cases; a wrong name lists them.")
    ] = None,
    out: Annotated[
        Path, typer.Option(help="Where validation.md and its pictures go, if all cases run.")
    ] = Path("docs"),
) -> None:
    """Hold the physics against published experiments, benchmarks and closed forms."""
    from buoyancy_mj.validation import report  # needs matplotlib, which 'run' does not
    from buoyancy_mj.validation.case import Case

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as progress:
        task = progress.add_task("", total=len(set(only)) if only else len(report.CASES))

        def begin(case: Case) -> None:
            progress.update(task, description=case.title, completed=next(done))

        done = itertools.count()
        found = report.validate(out, only or (), begin)
    for name, rows in found.items():
        table = Table(title=report.CASES[name].title, title_justify="left")
        for column in report.HEADER:
            table.add_column(column, overflow="fold")
        for row in rows:
            table.add_row(*(cell.replace("**", "") for cell in report.format_row(row)))
        console.print(table)
    rows = [row for case in found.values() for row in case]
    console.print(f"{sum(row.holds for row in rows)} of {len(rows)} rows hold", highlight=False)
    if not only:
        console.print(f"page: {quote(out / 'validation.md')}", highlight=False, soft_wrap=True)

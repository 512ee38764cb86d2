"""`validate`: published experiments and closed forms beside what this package computes."""

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from buoyancy_mj.cli import console
from buoyancy_mj.cli.application import command
from buoyancy_mj.errors import BuoyancyError


@command(
    examples=(
        "validate",
        "validate --only small_sphere",
    ),
)
def validate(
    only: Annotated[
        list[str] | None, typer.Option(help="Run this case alone; a wrong name lists them all.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Write validation.md and its pictures into this folder, where all cases run; "
            "docs by default."
        ),
    ] = None,
) -> None:
    """Compare the physics with published results.

    These are experiments, benchmarks and closed forms.
    """
    from buoyancy_mj.validation import report  # needs matplotlib, which 'run' does not

    if only and out is not None:
        raise BuoyancyError(
            f"--out is '{out}', and its page holds all cases; leave out --only, or --out"
        )
    folder = out or Path("docs")

    with console.show_count(len(set(only)) if only else len(report.CASES)) as begin:
        results = report.validate(folder, only or (), lambda case: begin(case.title))
    for name, rows in results.items():
        table = Table(title=report.CASES[name].title, title_justify="left")
        for column in report.HEADER:
            table.add_column(column, overflow="fold")
        for row in rows:
            table.add_row(*(cell.replace("**", "") for cell in report.format_row(row)))
        console.out.print(table)

    verdicts = [row.holds for rows in results.values() for row in rows]
    console.print_line(console.out, f"{sum(verdicts)} of {len(verdicts)} rows hold")
    if not only:
        console.print_line(console.out, f"page: {console.quote_path(folder / 'validation.md')}")

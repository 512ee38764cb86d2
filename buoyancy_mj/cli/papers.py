"""`paper`: the source paper, reproduced."""

import itertools
from pathlib import Path
from typing import Annotated

import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from buoyancy_mj.cli.common import app, err, quote, report_errors
from buoyancy_mj.cli.common import out as console
from buoyancy_mj.paper.study import Study


@app.command()
@report_errors
def paper(
    only: Annotated[
        list[str] | None, typer.Option(help="Only these studies; a wrong name lists them.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Where tables and pictures go.")] = Path("docs/paper"),
    quick: Annotated[
        bool, typer.Option("--quick", help="Coarse and short, to see that it runs.")
    ] = False,
) -> None:
    """Reproduce the source paper: its figures, and what holds of its claims."""
    from buoyancy_mj.paper import contents, reproduction  # need matplotlib, which 'run' does not

    total = len(set(only)) if only else len(contents.STUDIES)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=err, transient=True, disable=not err.is_terminal) as progress:
        task = progress.add_task("", total=total)

        def begin(study: Study) -> None:
            progress.update(task, description=study.title, completed=next(done))

        done = itertools.count()
        rows = reproduction.reproduce(out, only or (), quick=quick, begin=begin)
    table = Table(title="The source paper's claims", title_justify="left", show_lines=True)
    for name in reproduction.HEADER:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console.print(table)
    console.print(f"tables and pictures: {quote(out)}", highlight=False, soft_wrap=True)

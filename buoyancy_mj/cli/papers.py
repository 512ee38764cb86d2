"""`paper`: the source paper, reproduced."""

from pathlib import Path
from typing import Annotated

import typer
from rich.table import Table

from buoyancy_mj.cli import console
from buoyancy_mj.cli.application import command


@command(
    examples=(
        "paper --quick",
        "paper --only volume --out figures",
    ),
)
def paper(
    only: Annotated[
        list[str] | None, typer.Option(help="Run this study alone; a wrong name lists them all.")
    ] = None,
    out: Annotated[Path, typer.Option(help="Write tables and pictures into this folder.")] = Path(
        "docs/paper"
    ),
    quick: Annotated[
        bool, typer.Option("--quick", help="Run coarse and short, to see that all works.")
    ] = False,
) -> None:
    """Reproduce the source paper, and judge its claims."""
    from buoyancy_mj.paper import contents, reproduction  # need matplotlib, which 'run' does not

    total = len(set(only)) if only else len(contents.STUDIES)
    with console.show_count(total) as begin:
        rows = reproduction.reproduce(
            out, only or (), quick=quick, begin=lambda study: begin(study.title)
        )
    table = Table(title="The source paper's claims", title_justify="left", show_lines=True)
    for name in reproduction.HEADER:
        table.add_column(name, overflow="fold")
    for row in rows:
        table.add_row(*row)
    console.out.print(table)
    console.print_line(console.out, f"tables and pictures: {console.quote_path(out)}")

"""The two consoles, and what several commands print on them."""

import functools
import itertools
import shlex
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
)

# names that users give may hold brackets, which are no markup, and colons, which are no pictures
out = Console(markup=False, highlight=False, emoji=False)
err = Console(markup=False, highlight=False, emoji=False, stderr=True)


def print_line(console: Console, text: str, style: str | None = None) -> None:
    """Print a text on one line, however narrow the terminal is."""
    console.print(text, style=style, soft_wrap=True)


def viewer_command(recording: Path) -> str:
    """The command that opens a recording in the Rerun viewer of this environment."""
    viewer = Path(sys.executable).with_name("rerun")
    name = quote_path(viewer) if viewer.exists() else "rerun"
    return f"{name} {quote_path(recording)}"


def quote_path(path: Path) -> str:
    """A path as a shell takes it, and no command takes it for an option."""
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)


@contextmanager
def show_progress(
    title: str, total: float, *columns: ProgressColumn
) -> Iterator[Callable[..., None]]:
    """Show a bar on the standard error, if that is a terminal.

    Args:
        title: what stands before the bar.
        total: amount of work at which the bar is full.
        columns: what stands behind the bar.

    Yields:
        rich's `Progress.update` for this bar: it takes `completed`, `advance`, `description`.
    """
    title_column = TextColumn("{task.description}", markup=False)
    progress = Progress(
        title_column, BarColumn(), *columns,
        console=err, transient=True, disable=not err.is_terminal,
    )  # fmt: skip
    with progress:
        yield functools.partial(progress.update, progress.add_task(title, total=total))


@contextmanager
def show_count(total: int) -> Iterator[Callable[[str], None]]:
    """Show a bar over parts of some work; yields a function to call with the title of each part."""
    with show_progress("", total, MofNCompleteColumn(), TimeElapsedColumn()) as update:
        number = itertools.count()
        yield lambda title: update(description=title, completed=next(number))

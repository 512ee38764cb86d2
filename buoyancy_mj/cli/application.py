"""The application: how its commands are registered, and how they report errors."""

import functools
import inspect
import io
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Annotated, Any, NoReturn

import mujoco
import typer

from buoyancy_mj import __version__
from buoyancy_mj.cli.console import err, print_line
from buoyancy_mj.cli.flags import check_texts, collect_flags, spread_flags
from buoyancy_mj.errors import BuoyancyError

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None)


def command(name: str | None = None) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Register a function as a command of the application.

    A parameter whose type is a dataclass of flags becomes one flag for each field, see
    `spread_flags`. Texts of several lines, or not in Unicode, are refused. An error of this package
    ends the command with one sentence and exit status 1.

    Args:
        name: name of the command; that of the function if None.
    """

    def register(function: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(function)
        spread = spread_flags(signature)

        @functools.wraps(function)
        def run(**values: Any) -> None:
            with _report_errors():
                check_texts(spread, values)
                function(**collect_flags(signature, values))

        run.__signature__ = spread  # type: ignore[attr-defined]
        run.__annotations__ = {p.name: p.annotation for p in spread.parameters.values()}
        return app.command(name)(run)

    return register


def _print_version(asked: bool) -> None:
    """Print the version of this package, and end."""
    if asked:
        typer.echo(f"buoyancy-mj {__version__}")
        raise typer.Exit


@app.callback()
def main(
    _version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Put water into MuJoCo."""


@contextmanager
def _report_errors() -> Iterator[None]:
    """Print errors of this package, and warnings as notes, as lines on the standard error.

    An error ends the command with exit status 1, an interrupt with 130, as shells have it.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = _print_note
        # MuJoCo's own warnings would go to a file in the working folder
        mujoco.set_mju_user_warning(_print_mujoco_warning)
        signal.signal(signal.SIGTERM, _interrupt)
        # what a terminal has no letters for is shown by its number
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")
        try:
            yield
        except BuoyancyError as error:
            print_line(err, f"error: {error}", style="red")
            raise typer.Exit(1) from error
        except OSError as error:
            # what is neither a file's nor the end of a pipe is the output's
            if error.filename is not None or isinstance(error, BrokenPipeError):
                raise
            print_line(err, f"error: the output cannot be written: {error.strerror}", style="red")
            raise typer.Exit(1) from error
        except KeyboardInterrupt:
            raise typer.Exit(130) from None


def _print_note(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning as a note."""
    print_line(err, f"note: {message}", style="yellow")


def _print_mujoco_warning(message: str) -> None:
    """Print a warning of MuJoCo as a note, unless an error will tell of the divergence."""
    if "Nan, Inf" not in message:
        _print_note(message)


def _interrupt(*_: Any) -> NoReturn:
    """End as Ctrl-C does."""
    raise KeyboardInterrupt

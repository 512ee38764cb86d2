"""How commands are registered with the application, and how they report errors."""

import errno
import functools
import inspect
import io
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn

import mujoco
import typer

from buoyancy_mj.cli.console import err, print_line
from buoyancy_mj.cli.flags import check_texts, collect_flags, spread_flags
from buoyancy_mj.cli.group import app
from buoyancy_mj.cli.signals import Stop, raise_later, raise_signals
from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.vehicle import plugins as plugins


def command(
    name: str | None = None, *, examples: Sequence[str] = ()
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Register a function as a command of the application.

    A parameter whose type is a dataclass of flags becomes one flag for each field, see
    `spread_flags`. Texts of several lines, or not in Unicode, are refused. An error of this package
    ends the command with one sentence and exit status 1.

    Args:
        name: name of the command; that of the function if None.
        examples: what may follow the name of the program, for the end of the help.
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
        lines = "".join(f"\n  buoyancy-mj {example}" for example in examples)
        # a backspace keeps the lines behind it as they are
        return app.command(name, epilog=f"\b\nExamples:{lines}")(run)

    return register


@contextmanager
def _report_errors() -> Iterator[None]:
    """Print errors of this package, and warnings as notes, as lines on the standard error.

    An error ends the command with exit status 1, a signal with 128 and its number: Ctrl-C with 130,
    SIGTERM with 143.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = _print_note
        # MuJoCo's own warnings would go to a file in the working folder
        mujoco.set_mju_user_warning(_print_mujoco_warning)
        # what a terminal has no letters for is shown by its number
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")
        try:
            with raise_signals(), raise_causes():
                yield
        except BuoyancyError as error:
            _fail(str(error), error)
        except MemoryError as error:
            _fail("the memory ran out; ask for less at once, or for a shorter run", error)
        except OSError as error:
            # a reader that has gone wants no more, and typer knows that
            if error.errno == errno.EPIPE:
                raise
            what = "the output" if error.filename is None else f"'{error.filename}'"
            _fail(f"{what} cannot be read or written: {error.strerror or error}", error)
        except Stop as stop:
            raise typer.Exit(stop.status) from None
        except KeyboardInterrupt:
            raise typer.Exit(130) from None


def _fail(message: str, error: Exception) -> NoReturn:
    """Print an error and end with exit status 1."""
    print_line(err, f"error: {message}", style="red")
    raise typer.Exit(1) from error


def _print_note(message: Warning | str, *_: Any, **__: Any) -> None:
    """Print a warning as a note."""
    print_line(err, f"note: {message}", style="yellow")


def _print_mujoco_warning(message: str) -> None:
    """Print a warning of MuJoCo as a note, unless an error will tell of the divergence."""
    try:
        if "Nan, Inf" not in message:
            _print_note(message)
    except Stop as stop:
        # MuJoCo would end the process on the spot
        raise_later(stop)
    except OSError:
        # nobody reads the standard error
        pass

"""The application: its commands, whose modules are imported when one of them is asked for."""

import ast
import importlib
import inspect
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command_from_info

MODULES = {
    "run": "runs",
    "list": "runs",
    "view": "views",
    "inspect": "inspections",
    "ballast": "ballasts",
    "respond": "responses",
    "decay": "decays",
    "sitl": "autopilots",
    "sweep": "sweeps",
    "paper": "papers",
    "validate": "validations",
}
"""Modules of this room by the commands that they add, in the order of the help."""


class _Commands(TyperGroup):
    """All commands: their names, until one is asked for."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._made: set[str] = set()
        self.commands = {name: TyperCommand(name) for name in MODULES}

    def get_command(self, _: Any, cmd_name: str) -> Any:
        """A command of a name, with its flags; None if there is none."""
        if cmd_name in MODULES and cmd_name not in self._made:
            importlib.import_module(f"{__package__}.{MODULES[cmd_name]}")
            for info in app.registered_commands:
                command = get_command_from_info(
                    info,
                    pretty_exceptions_short=app.pretty_exceptions_short,
                    rich_markup_mode=self.rich_markup_mode,
                )
                self.add_command(command)
                self._made.add(str(command.name))
        return self.commands.get(cmd_name)

    def format_commands(self, _: Any, formatter: Any) -> None:
        """Write what each command does into the help, for which no module is imported."""
        limit = formatter.width - 6 - max(map(len, MODULES))
        rows = [
            (name, TyperCommand(name, help=_read_docstring(name)).get_short_help_str(limit))
            for name in MODULES
        ]
        with formatter.section("Commands"):
            formatter.write_dl(rows)


def _read_docstring(name: str) -> str:
    """The docstring of a command, as its module has it."""
    source = Path(__file__).with_name(f"{MODULES[name]}.py").read_text(encoding="utf-8")
    for node in ast.parse(source).body:
        # a command that is called as a word of Python has an underscore behind it
        if isinstance(node, ast.FunctionDef) and node.name in (name, f"{name}_"):
            return inspect.cleandoc(ast.get_docstring(node) or "")
    return ""


app = typer.Typer(cls=_Commands, no_args_is_help=True, rich_markup_mode=None)


def _print_version(asked: bool) -> None:
    """Print the version of this package, and end."""
    if asked:
        from buoyancy_mj import __version__

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

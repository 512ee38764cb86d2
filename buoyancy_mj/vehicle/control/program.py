"""`Program`: a controller of the user's own, from a Python file."""

import contextlib
import dataclasses
import sys
import types
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import ControlError, choices, describe
from buoyancy_mj.values import read_text
from buoyancy_mj.vehicle.control.controller import Control, Controller, Outset


@dataclasses.dataclass(frozen=True, kw_only=True)
class Program(Control):
    """A function `update(model, data)` in a Python file, which writes `data.ctrl`.

    Starting it runs the file. A scene does so only for who trusts it: `--trust` on the command
    line, `Simulation(scene, trust=True)` in Python.

    Raises:
        ControlError: the text does not say which function of which file.
    """

    file: str
    """File and function, as 'my_controller.py:update'; a relative path starts at the scene."""

    def __post_init__(self) -> None:
        super().__post_init__()
        read_text(ControlError, "file", self.file)
        path, _, function = self.file.rpartition(":")
        if not path.endswith(".py") or not function.isidentifier():
            raise ControlError(
                f"file is {describe(self.file)}; it must be a Python file and a function in it, "
                "as 'my_controller.py:update'"
            )

    @property
    def title(self) -> str:
        """What messages call it."""
        return f"'{self.file}'"

    def list_files(self, folder: Path) -> tuple[Path, ...]:
        """The Python file."""
        name, _, _ = self.file.rpartition(":")
        return (folder / Path(name).expanduser(),)

    def start(self, outset: Outset) -> Controller:
        """Run the file, and take the function."""
        _, _, function = self.file.rpartition(":")
        (path,) = self.list_files(outset.folder)
        if not path.is_file():
            raise ControlError(f"there is no controller '{path}'; a path starts at the scene")
        module = _run_file(path)
        found = module.get(function)
        if not callable(found):
            functions = [key for key, value in module.items() if _is_own(value, module)]
            raise ControlError(
                f"'{path}' has no function '{function}'; {choices(function, functions)}"
            )
        update: Controller = found
        return update


def _run_file(path: Path) -> dict[str, Any]:
    """Run a Python file as a module of its own; its names.

    What it imports from its folder, it imports when it is run.
    """
    module = types.ModuleType(f"controller {path.stem}")
    module.__file__ = str(path)
    # dataclasses look their module up
    sys.modules[module.__name__] = module
    # and files import their neighbours, as those that Python is started with
    folder = str(path.parent.resolve())
    sys.path.insert(0, folder)
    try:
        exec(compile(path.read_bytes(), str(path), "exec"), vars(module))
    except Exception as error:
        raise ControlError(
            f"the controller '{path}' cannot be run: {type(error).__name__}: {error}"
        ) from error
    finally:
        with contextlib.suppress(ValueError):
            sys.path.remove(folder)
    return vars(module)


def _is_own(value: Any, module: dict[str, Any]) -> bool:
    """Whether a value is a function that the file itself defines."""
    return callable(value) and getattr(value, "__module__", "") == module["__name__"]

"""What the commands share: the application, its consoles and flags, and how errors are told."""

import json
import signal
import sys
import warnings
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Annotated, Any

import mujoco
import typer
from rich.console import Console

from buoyancy_mj import __version__
from buoyancy_mj.errors import BuoyancyError
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.records import field_docs
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import Scene, read_scene

app = typer.Typer(no_args_is_help=True, rich_markup_mode=None)
# what users name may hold brackets
out, err = Console(markup=False), Console(stderr=True, markup=False)

SCENE = Annotated[
    str, typer.Argument(help="A scene file (.toml), or the name of one that ships; see 'list'.")
]
VEHICLE = Annotated[
    str | None,
    typer.Option(help="Put this vehicle into the scene: MJCF, URDF, or the name of a model."),
]
SET = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Any field, as water.waves.0.amplitude=0.1."),
]
_SELECTION = field_docs(Selection)
GEOMS = Annotated[
    list[str] | None,
    typer.Option(help=_SELECTION["geoms"]),
]
HULL = Annotated[
    list[str] | None,
    typer.Option(help=_SELECTION["hull"]),
]
FILL = Annotated[list[str] | None, typer.Option(help=_SELECTION["fill"])]
METHOD = Annotated[
    str | None,
    typer.Option(help="How the submersion is found: exact (the default), convex_hull or sections."),
]
TIMESTEP = Annotated[float | None, typer.Option(help="MuJoCo's timestep [s].")]


def print_version(wanted: bool) -> None:
    """Print the version of this package, and end."""
    if wanted:
        typer.echo(f"buoyancy-mj {__version__}")
        raise typer.Exit


@app.callback()
def main(
    _version: Annotated[
        bool,
        typer.Option("--version", callback=print_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Put water into MuJoCo."""


def report_errors(command: Callable[..., None]) -> Callable[..., None]:
    """Errors of ours as one sentence and exit status 1; notices as lines on the standard error."""

    @wraps(command)
    def wrapped(*args: Any, **kwargs: Any) -> None:
        def show(message: Warning | str, *_: Any, **__: Any) -> None:
            err.print(f"note: {message}", style="yellow", highlight=False, soft_wrap=True)

        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.showwarning = show
            # MuJoCo's own, which would else go to a file in the working folder; what diverged is told as an error
            mujoco.set_mju_user_warning(lambda text: None if "Nan, Inf" in text else show(text))
            signal.signal(signal.SIGTERM, _interrupt)
            try:
                command(*args, **kwargs)
            except BuoyancyError as error:
                err.print(f"error: {error}", style="red", highlight=False, soft_wrap=True)
                raise typer.Exit(1) from error

    return wrapped


def _interrupt(*_: Any) -> None:
    """End as by Ctrl-C."""
    raise KeyboardInterrupt


def read_scene_with_flags(
    path: Path,
    vehicle: str | None,
    duration: float | None,
    timestep: float | None,
    given: list[str] | None,
    method: str | None,
    **words: list[str] | None,
) -> Scene:
    """The scene with the flags laid over it."""
    return read_scene(path, flags_as_settings(vehicle, duration, timestep, given, method, **words))


def flags_as_settings(
    vehicle: str | None,
    duration: float | None,
    timestep: float | None,
    given: list[str] | None,
    method: str | None,
    **words: list[str] | None,
) -> list[str]:
    """The flags as settings."""
    # first, so that settings may reach the method's options
    over = (
        [f"method={{kind={json.dumps(method, ensure_ascii=False)}}}"] if method is not None else []
    )
    over += given or []
    if vehicle is not None:
        # relative to where the user stands, not to the scene
        own = vehicle if vehicle in catalog.models() else str(catalog.model_path(vehicle).resolve())
        over.append(f"vehicle={json.dumps(own, ensure_ascii=False)}")
    if duration is not None:
        over.append(f"duration={duration}")
    if timestep is not None:
        over.append(f"timestep={timestep}")
    return over + [
        f"{name}={json.dumps(chosen, ensure_ascii=False)}"
        for name, chosen in words.items()
        if chosen
    ]


def viewer_command() -> str:
    """The viewer's command, from the same environment."""
    beside = Path(sys.executable).with_name("rerun")
    return quote(beside) if beside.exists() else "rerun"


def quote(path: Path) -> str:
    """A path as a shell takes it."""
    text = str(path)
    return f"'{text}'" if " " in text else text

"""Flags that several commands share, as dataclasses whose fields become flags."""

import dataclasses
import errno
import inspect
import json
import typing
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from buoyancy_mj.errors import SceneError, choices, describe
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.records import field_docs
from buoyancy_mj.scenes import catalog
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.scenes.series_file import ENDS
from buoyancy_mj.sea.water import Water
from buoyancy_mj.settings.texts import parse_toml
from buoyancy_mj.settings.toml import water_from_table
from buoyancy_mj.values import read_text

SceneArgument = Annotated[
    str, typer.Argument(help="A scene file (.toml), or the name of a scene that ships; see 'list'.")
]
ModelArgument = Annotated[
    str, typer.Argument(help="An MJCF or URDF file, or the name of a model that ships.")
]
Json = Annotated[
    bool, typer.Option("--json", help="Print JSON on the standard output, and nothing else there.")
]
WaterOption = Annotated[
    list[str] | None,
    typer.Option(
        metavar="KEY=VALUE", help="Describe the still water: density=1025 [kg/m^3], level=0.2 [m]."
    ),
]


STILL = ("density", "level")
"""Keys of still water."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class SceneFlags:
    """Changes to a scene."""

    vehicle: str | None = None
    """Put this vehicle into the scene: an MJCF or URDF file, or the name of a model that ships."""
    timestep: float | None = None
    method: str | None = None
    """Find the submersion by this method: exact (the default), convex_hull or sections."""
    settings: Annotated[list[str] | None, typer.Option("--set", metavar="KEY=VALUE")] = None
    """Set any field of the scene, as in water.waves.0.amplitude=0.1; may be repeated."""
    trust: Annotated[bool, typer.Option("--trust")] = False
    """Run the Python file that the scene names as its controller; read it before."""

    def overrides(self) -> Iterator[str]:
        """The flags as texts KEY=VALUE for `read_scene`."""
        # first, so that --set may reach the method's options
        if self.method is not None:
            yield f"method={{kind={_quote(self.method)}}}"
        yield from self.settings or ()
        if self.vehicle is not None:
            # a path starts where the user stands, not at the scene
            is_name = self.vehicle in catalog.models()
            path = self.vehicle if is_name else str(catalog.model_path(self.vehicle).resolve())
            yield f"vehicle={_quote(path)}"
        if self.timestep is not None:
            yield f"timestep={self.timestep}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class RunFlags(SceneFlags):
    """Changes to a scene that runs to its end."""

    duration: float | None = None

    def overrides(self) -> Iterator[str]:
        """The flags as texts KEY=VALUE for `read_scene`."""
        yield from super().overrides()
        if self.duration is not None:
            yield f"duration={self.duration}"


@dataclasses.dataclass(frozen=True, kw_only=True)
class SelectionFlags:
    """Which geoms displace water, and as what."""

    geoms: list[str] | None = None
    hull: list[str] | None = None
    fill: list[str] | None = None

    @property
    def selection(self) -> Selection:
        """The flags as a selection."""
        return Selection(geoms=self.geoms, hull=self.hull, fill=self.fill)

    def overrides(self) -> Iterator[str]:
        """The flags as texts KEY=VALUE for `read_scene`."""
        for field in dataclasses.fields(self):
            patterns = getattr(self, field.name)
            if patterns:
                yield f"{field.name}={_quote(patterns)}"


def check_recording_name(path: Path | None) -> None:
    """Check that the name of a recording, if there is one, ends in .rrd.

    Raises:
        SceneError: it does not.
    """
    if path is not None and path.suffix != ".rrd":
        raise SceneError(f"--record is '{path}'; a recording's name ends in .rrd")


def check_table_name(path: Path | None) -> None:
    """Check that the name of a series, if there is one, says what kind of table it is.

    Raises:
        SceneError: it does not.
    """
    if path is not None and path.suffix not in ENDS:
        raise SceneError(f"--series is '{path}'; a series' name ends in {' or '.join(ENDS)}")


def parse_still_water(settings: list[str] | None) -> Water:
    """The still water that texts KEY=VALUE describe.

    Raises:
        SceneError: a text makes no sense, or describes what still water does not have.
    """
    words = settings or []
    what = f"--water {describe(' '.join(words))}"
    try:
        table = parse_toml("\n".join(words), what)
    except SceneError as error:
        raise SceneError(f"{error}; write KEY=VALUE, as in density=1025") from error
    if len(table) < len(words):
        raise SceneError(f"{what} says nothing; write KEY=VALUE, as in density=1025")
    for key in table:
        if key not in STILL:
            raise SceneError(f"--water: unknown key {describe(key)}; {choices(key, STILL)}")
    return water_from_table(table, "--water")


def check_texts(signature: inspect.Signature, values: Mapping[str, Any]) -> None:
    """Check texts among the values of spread flags: one line of Unicode, and names of files short.

    Raises:
        SceneError: one is not; the message names the flag.
    """
    for parameter in signature.parameters.values():
        value = values.get(parameter.name)
        for text in value if isinstance(value, list) else [value]:
            if isinstance(text, str | Path):
                read_text(SceneError, flag_of(parameter), str(text))
            if isinstance(text, Path):
                _check_length(flag_of(parameter), text)


def _check_length(flag: str, path: Path) -> None:
    """Refuse a path that no file can have here."""
    try:
        path.lstat()
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            raise SceneError(
                f"{flag} is {describe(str(path))}; it is too long for the name of a file"
            ) from error


def spread_flags(signature: inspect.Signature) -> inspect.Signature:
    """A signature with one flag for each field in place of each dataclass.

    The help of a flag is the docstring under its field. A field without one means what the field of
    that name means in `Scene` or `Selection`.
    """
    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if _is_flags(parameter.annotation):
            parameters += _flags(parameter.annotation)
        else:
            parameters.append(parameter.replace(kind=inspect.Parameter.KEYWORD_ONLY))
    return signature.replace(parameters=parameters)


def collect_flags(signature: inspect.Signature, values: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments for a signature, with its dataclasses, from the values of its spread flags."""
    rest = dict(values)
    arguments: dict[str, Any] = {}
    for parameter in signature.parameters.values():
        cls = parameter.annotation
        if _is_flags(cls):
            fields = {field.name: rest.pop(field.name) for field in dataclasses.fields(cls)}
            arguments[parameter.name] = cls(**fields)
    return rest | arguments


def flag_of(parameter: inspect.Parameter) -> str:
    """How users call a spread flag: '--set', or 'SCENE' for an argument."""
    (option,) = parameter.annotation.__metadata__
    if isinstance(option, typer.models.ArgumentInfo):
        return parameter.name.upper()
    # within Annotated, Typer takes the first name for a default
    names = (option.default, *(option.param_decls or ()), f"--{parameter.name.replace('_', '-')}")
    return next(name for name in names if isinstance(name, str) and name.startswith("--"))


def _is_flags(annotation: Any) -> bool:
    """Whether a parameter of this type is spread."""
    return dataclasses.is_dataclass(annotation)


def _flags(cls: Any) -> Iterator[inspect.Parameter]:
    """A parameter for each field of a dataclass."""
    docs = field_docs(Scene) | field_docs(Selection) | field_docs(cls)
    types = typing.get_type_hints(cls)
    hints = typing.get_type_hints(cls, include_extras=True)
    for field in dataclasses.fields(cls):
        (option,) = getattr(hints[field.name], "__metadata__", (typer.Option(),))
        option.help = " ".join(docs.get(field.name, "").split())
        yield inspect.Parameter(
            field.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=field.default,
            annotation=Annotated[types[field.name], option],
        )


def _quote(value: str | list[str]) -> str:
    """A text, or a list of texts, as TOML writes them."""
    return json.dumps(value, ensure_ascii=False)

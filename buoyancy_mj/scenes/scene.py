"""`Scene`: what one run needs, read from TOML and validated."""

import dataclasses
import math
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco

from buoyancy_mj.errors import SceneError, choices
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.settings.config import SELECTION
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.texts import parse_value
from buoyancy_mj.settings.toml import (
    damping_from_table,
    method_from_table,
    selection_from_table,
    table_of,
    water_from_table,
)

_VECTORS = (
    "cog_shift",
    "water.current",
    "start.position",
    "start.velocity",
    "start.angular_velocity",
)
"""Fields whose numbers may be set one by one, though all are missing."""
EQUILIBRIUM = "equilibrium"
"""Value of `Start.at`."""
INTEGRATORS = {
    name.lower(): value
    for name, value in (
        (key.removeprefix("mjINT_"), item) for key, item in mujoco.mjtIntegrator.__members__.items()
    )
}
"""MuJoCo's integrators by lower-case name."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Start:
    """Where and how fast the vehicle starts.

    Raises:
        SceneError: a value that is not finite.
    """

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Of the vehicle's root body (3,) [m], world frame."""
    roll: float = 0.0
    """About its x axis [rad]."""
    pitch: float = 0.0
    """About its y axis, bow down [rad]."""
    yaw: float = 0.0
    """About the vertical [rad]; turned first, then pitch, then roll."""
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Of the root body (3,) [m/s], world frame."""
    angular_velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Of the root body (3,) [rad/s], its own frame."""
    keyframe: str | None = None
    """A keyframe of the vehicle, for its joints and controls; position and attitude come from here."""
    at: str | None = None
    """'equilibrium' to start at rest on still water, downhill from the attitude here; place and yaw stay."""

    def __post_init__(self) -> None:
        if self.at not in (None, EQUILIBRIUM):
            raise SceneError(f"start.at is '{self.at}'; possible: {EQUILIBRIUM}, or leave it out")
        numbers = (
            *self.position,
            self.roll,
            self.pitch,
            self.yaw,
            *self.velocity,
            *self.angular_velocity,
        )
        if not all(math.isfinite(number) for number in numbers):
            raise SceneError(f"start holds {numbers}; every number must be finite")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Scene(Settings):
    """A vehicle, its start and how long to look, beside the settings of its water.

    Raises:
        SceneError: a value out of its range.
    """

    title: str
    """One line."""
    vehicle: str
    """MJCF or URDF file, or the name of a model that ships."""
    environment: str | None = None
    """MJCF file of what stands around, or the name of one that ships."""
    duration: float = 5.0
    """Simulated time [s]."""
    timestep: float = 0.01
    """MuJoCo's timestep [s]."""
    integrator: str = "implicitfast"
    """MuJoCo's integrator."""
    record_rate: float = 60.0
    """Frames recorded per simulated second [Hz]."""
    start: Start = Start()
    """Pose and velocity at time 0."""
    coefficients: CoefficientsFile | None = None
    """A potential-flow code's dataset of added mass and radiation damping, for bodies that state none themselves."""
    mass: float | None = None
    """Mass of the whole vehicle [kg], the masses and inertias of its bodies scaled alike; None for its own."""
    cog_shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """How far the centre of gravity of the vehicle's root body is moved, in its frame (3,) [m]."""
    text: str = ""
    """The scene as TOML text, for the record."""
    folder: Path = Path()
    """What relative paths in it start from."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, least, most in (
            ("duration", 1e-6, 1e6),
            ("timestep", 1e-7, 1.0),
            ("record_rate", 1e-6, 1e5),
        ):
            value = getattr(self, name)
            if not least <= value <= most:
                raise SceneError(
                    f"{name} is {value:g}; it must be at least {least:g} and at most {most:g}"
                )
        if self.mass is not None and not 0.0 < self.mass < math.inf:
            raise SceneError(f"mass is {self.mass:g} kg; it must be positive")
        if not all(math.isfinite(shift) for shift in self.cog_shift):
            raise SceneError(f"cog_shift is {self.cog_shift}; every number must be finite")
        if self.integrator.lower() not in INTEGRATORS:
            raise SceneError(
                f"unknown integrator '{self.integrator}'; {choices(self.integrator.lower(), INTEGRATORS)}"
            )


KEYS = (
    *(f.name for f in dataclasses.fields(Scene) if f.name not in ("text", "folder", "selection")),
    *SELECTION,
)
"""Keys of a scene's file."""


def read_scene(path: Path, settings: Sequence[str] = ()) -> Scene:
    """The scene in a TOML file, with `settings` such as 'water.waves.0.amplitude=0.1' laid over it.

    Raises:
        SceneError: the file or a setting cannot be read, or says something that makes no sense.
    """
    try:
        table = tomllib.loads(path.read_text())
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"cannot read scene '{path}': {error}") from error
    except tomllib.TOMLDecodeError as error:
        raise SceneError(f"scene '{path}' is no valid TOML: {error}") from error
    for setting in settings:
        _set(table, setting)
    told = "".join(f"# with {setting}\n" for setting in settings)
    return scene_from_table(
        table, where=f"scene '{path.stem}'", text=told + path.read_text(), folder=path.parent
    )


def scene_from_table(
    table: Mapping[str, Any], where: str = "scene", text: str = "", folder: Path = Path()
) -> Scene:
    """The scene that a table of plain values describes, see `read_scene`."""
    plain = dict(table)
    given: dict[str, Any] = {"text": text, "folder": folder}
    given["water"] = water_from_table(plain.pop("water", {}), f"{where}: water", folder)
    given["start"] = build(
        Start, table_of(plain.pop("start", {}), f"{where}: start"), f"{where}: start"
    )
    given["damping"] = damping_from_table(plain.pop("damping", True), f"{where}: damping")
    if "coefficients" in plain:
        place = f"{where}: coefficients"
        given["coefficients"] = build(
            CoefficientsFile, table_of(plain.pop("coefficients"), place), place
        )
    given["method"] = method_from_table(plain.pop("method", "exact"), f"{where}: method")
    patterns = {key: plain.pop(key) for key in SELECTION if key in plain}
    given["selection"] = selection_from_table(patterns, where)
    # keys of the scene that are tables of their own are still its keys
    for key in plain:
        if key not in KEYS:
            raise SceneError(f"{where}: unknown key '{key}'; {choices(key, KEYS)}")
    return build(Scene, plain, where, **given)


def _set(table: dict[str, Any], setting: str) -> None:
    """Lay one KEY=VALUE over a table; VALUE is TOML, or a bare word."""
    key, equals, text = setting.partition("=")
    if not equals or not key.strip():
        raise SceneError(
            f"'{setting}' is no setting; write KEY=VALUE, for example duration=3 or water.level=0.2"
        )
    value = parse_value(text)
    place: Any = table
    *path, last = key.strip().split(".")
    if ".".join(path) in _VECTORS:
        # one number of a vector that the file does not give
        owner = table.setdefault(path[0], {}) if len(path) > 1 else table
        if isinstance(owner, dict):
            owner.setdefault(path[-1], [0.0, 0.0, 0.0])
    for depth, part in enumerate(path):
        place = _entry(place, part, ".".join(path[: depth + 1]), make=True)
    if isinstance(place, list):
        _entry(place, last, key, make=False)
        place[int(last)] = value
    elif isinstance(place, dict):
        place[last] = value
    else:
        raise SceneError(f"cannot set '{key}': '{'.'.join(path)}' is {place!r}, no table")


def _entry(place: Any, part: str, key: str, *, make: bool) -> Any:
    """One step into a table or a list."""
    if isinstance(place, list):
        if not (part.isascii() and part.isdigit()) or int(part) >= len(place):
            raise SceneError(
                f"cannot set '{key}': the list has {len(place)} entries, counted from 0"
            )
        return place[int(part)]
    if not isinstance(place, dict):
        raise SceneError(f"cannot set '{key}': it lies in {place!r}, no table")
    return place.setdefault(part, {}) if make else place[part]

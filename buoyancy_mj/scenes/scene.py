"""`Scene`: all that one run needs, read from TOML and validated."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco

from buoyancy_mj.errors import SceneError, SceneTypeError, choices, describe
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.scenes.overrides import apply_setting
from buoyancy_mj.settings.config import SELECTION
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.texts import parse_toml
from buoyancy_mj.settings.toml import (
    damping_from_table,
    method_from_table,
    selection_from_table,
    table_of,
    water_from_table,
)
from buoyancy_mj.values import read_array, set_number

EQUILIBRIUM = "equilibrium"
"""Value of `Start.at`."""
INTEGRATORS = {
    name.removeprefix("mjINT_").lower(): integrator
    for name, integrator in mujoco.mjtIntegrator.__members__.items()
}
"""MuJoCo's integrators by lower-case name."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Start:
    """Pose and velocity of the vehicle at the start.

    Raises:
        SceneError: a value that is no finite number, or a vector that is not of three.
    """

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Position of the vehicle's root body (3,) [m], world frame."""
    roll: float = 0.0
    """Angle about the root body's x axis [rad]."""
    pitch: float = 0.0
    """Angle about the root body's y axis, bow down [rad]."""
    yaw: float = 0.0
    """Angle about the vertical [rad]; the vehicle turns by yaw first, then pitch, then roll."""
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Velocity of the root body (3,) [m/s], world frame."""
    angular_velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Angular velocity of the root body (3,) [rad/s], in its own frame."""
    keyframe: str | None = None
    """Keyframe of the vehicle for its joints and controls; the pose stays that of the start."""
    at: str | None = None
    """'equilibrium' starts at rest on still water, which is sought downhill from the attitude here;
    horizontal position and yaw stay."""

    def __post_init__(self) -> None:
        if self.at not in (None, EQUILIBRIUM):
            raise SceneError(
                f"start.at is {describe(self.at)}; possible: {EQUILIBRIUM}, or leave it out"
            )
        for name in ("roll", "pitch", "yaw"):
            set_number(self, SceneError, name)
        for name in ("position", "velocity", "angular_velocity"):
            vector = read_array(SceneError, name, getattr(self, name), (3,))
            object.__setattr__(self, name, tuple(vector.tolist()))


@dataclasses.dataclass(frozen=True, kw_only=True)
class Scene(Settings):
    """A vehicle, its start and its duration, beside the settings of its water.

    Raises:
        SceneError: a value out of its range.
    """

    title: str
    """Title of the scene, one line."""
    vehicle: str
    """MJCF or URDF file of the vehicle, or the name of a model that ships."""
    environment: str | None = None
    """MJCF file of the surroundings, or the name of an environment that ships."""
    duration: float = 5.0
    """Simulated time [s]."""
    timestep: float = 0.01
    """MuJoCo's timestep [s]."""
    integrator: str = "implicitfast"
    """MuJoCo's integrator."""
    record_rate: float = 60.0
    """Number of frames recorded per simulated second [Hz]."""
    start: Start = Start()
    """Pose and velocity at time 0."""
    coefficients: CoefficientsFile | None = None
    """A potential-flow code's dataset of added mass and radiation damping, for bodies whose file
    states none."""
    mass: float | None = None
    """Mass of the whole vehicle [kg], reached by one factor on the masses and inertias of all its
    bodies; None keeps the masses of its file."""
    cog_shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Shift of the centre of gravity of the vehicle's root body, in its frame (3,) [m]."""
    text: str = ""
    """The scene as TOML text, for the record."""
    folder: Path = Path()
    """Folder from which relative paths in the scene start."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for name, least, most in (
            ("duration", 1e-6, 1e6),
            ("timestep", 1e-7, 1.0),
            ("record_rate", 1e-6, 1e5),
        ):
            set_number(self, SceneError, name, least=least, most=most)
        if self.mass is not None:
            set_number(self, SceneError, "mass", above=0.0)
        shift = read_array(SceneError, "cog_shift", self.cog_shift, (3,))
        object.__setattr__(self, "cog_shift", tuple(shift.tolist()))
        if self.integrator.lower() not in INTEGRATORS:
            raise SceneError(
                f"unknown integrator '{self.integrator}'; "
                f"{choices(self.integrator.lower(), INTEGRATORS)}"
            )


KEYS = (
    *(f.name for f in dataclasses.fields(Scene) if f.name not in ("text", "folder", "selection")),
    *SELECTION,
)
"""Keys of a scene's file."""
_RENAMED = {"drag": "damping"}
"""Keys that have another name now."""


def read_scene(path: Path, settings: Sequence[str] = ()) -> Scene:
    """Read the scene in a TOML file, with settings laid over it.

    Args:
        path: the file.
        settings: texts KEY=VALUE such as 'water.waves.0.amplitude=0.1'.

    Raises:
        SceneError: the file or a setting cannot be read, or says something that makes no sense.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise SceneError(f"cannot read scene '{path}': {error}") from error
    table = parse_toml(text, f"scene '{path}'")
    for setting in settings:
        apply_setting(table, setting)
    header = "".join(f"# with {setting}\n" for setting in settings)
    where = f"scene '{path.stem}'"
    return scene_from_table(table, where=where, text=header + text, folder=path.parent)


def scene_from_table(
    table: Mapping[str, Any], where: str = "scene", text: str = "", folder: Path = Path()
) -> Scene:
    """Make the scene that a table of plain values describes, as TOML has them.

    Args:
        table: the keys of a scene's file, `KEYS`, and their values.
        where: what errors call the table.
        text: the table as TOML text, for the record.
        folder: where relative paths in the table start.

    Raises:
        SceneError: an unknown key, a missing one, or a value that makes no sense.
    """
    plain = dict(table)
    fields: dict[str, Any] = {"text": text, "folder": folder}

    # tables in the table
    fields["water"] = water_from_table(plain.pop("water", {}), f"{where}: water", folder)
    start = table_of(plain.pop("start", {}), f"{where}: start")
    fields["start"] = build(Start, start, f"{where}: start")
    fields["damping"] = damping_from_table(plain.pop("damping", True), f"{where}: damping")
    fields["method"] = method_from_table(plain.pop("method", "exact"), f"{where}: method")
    if "coefficients" in plain:
        place = f"{where}: coefficients"
        fields["coefficients"] = build(
            CoefficientsFile, table_of(plain.pop("coefficients"), place), place
        )

    # the fields of the selection stand among those of the scene
    patterns = {key: plain.pop(key) for key in SELECTION if key in plain}
    fields["selection"] = selection_from_table(patterns, where)

    # the error for an unknown key lists all keys of a file, those of inner tables too
    for key in plain:
        if key not in KEYS:
            hint = f"it is '{_RENAMED[key]}' now; " if key in _RENAMED else ""
            raise SceneTypeError(
                f"{where}: unknown key {describe(key)}; {hint}{choices(key, KEYS)}"
            )
    return build(Scene, plain, where, **fields)

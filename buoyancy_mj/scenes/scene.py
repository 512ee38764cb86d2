"""`Scene`: all that one run needs, read from TOML and validated."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import mujoco

from buoyancy_mj.environments.missions import MISSIONS
from buoyancy_mj.environments.sauvc.layout import read_seed
from buoyancy_mj.errors import SceneError, SceneTypeError, choices, describe
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.scenes.controls import check_controls, controls_from_tables
from buoyancy_mj.scenes.overrides import apply_setting
from buoyancy_mj.scenes.scene_vehicle import (
    SceneVehicle,
    Start,
    check_masses,
    name_from_file,
    name_vehicles,
    read_inner_tables,
    vehicles_from_tables,
)
from buoyancy_mj.settings.config import SELECTION
from buoyancy_mj.settings.settings import Settings
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.texts import parse_toml
from buoyancy_mj.settings.toml import (
    damping_from_table,
    method_from_table,
    selection_from_table,
    water_from_table,
)
from buoyancy_mj.values import set_number
from buoyancy_mj.vehicle.control.controller import Control

INTEGRATORS = {
    name.removeprefix("mjINT_").lower(): integrator
    for name, integrator in mujoco.mjtIntegrator.__members__.items()
}
"""MuJoCo's integrators by lower-case name."""
_FILLED_IN = ("stem", "text", "folder")
"""Fields of a scene that its reader fills in; they are no keys."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Scene(Settings):
    """A vehicle or several, their start and a duration, beside the settings of their water.

    Raises:
        SceneError: a value out of its range, no vehicle, or names of vehicles that make no sense.
    """

    title: str
    """Title of the scene, one line."""
    vehicle: str | None = None
    """MJCF or URDF file of the vehicle, or the name of a model that ships."""
    vehicles: tuple[SceneVehicle, ...] = ()
    """Several vehicles instead of the one, each with its own start and masses."""
    environment: str | None = None
    """MJCF file of the surroundings, or the name of an environment that ships."""
    layout: int | None = None
    """Seed that draws where the props of such an environment stand, within the rules; the
    environment is sauvc_qualification or sauvc_course. None for the layout that ships."""
    mission: str | None = None
    """What a referee watches the vehicle do in the environment: sauvc_qualification or
    sauvc_course."""
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
    control: tuple[Control, ...] = ()
    """What steers the vehicles, one controller for each; a table, or several tables
    [[control]]."""
    coefficients: CoefficientsFile | None = None
    """A potential-flow code's dataset of added mass and radiation damping, for bodies whose file
    states none."""
    mass: float | None = None
    """Mass of the whole vehicle [kg], reached by one factor on the masses and inertias of all its
    bodies; None keeps the masses of its file."""
    cog_shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Shift of the centre of gravity of the vehicle's root body, in its frame (3,) [m]."""
    stem: str = ""
    """Name of the scene's file, or of the vehicle that a setting put into it, for recordings."""
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
        check_masses(self)
        controls = (self.control,) if isinstance(self.control, Control) else tuple(self.control)
        object.__setattr__(self, "control", controls)
        check_controls(controls)
        self._check_vehicles()
        self._check_mission()
        object.__setattr__(self, "vehicles", name_vehicles(self.vehicles))
        if self.integrator.lower() not in INTEGRATORS:
            raise SceneError(
                f"unknown integrator '{self.integrator}'; "
                f"{choices(self.integrator.lower(), INTEGRATORS)}"
            )

    @property
    def entries(self) -> tuple[SceneVehicle, ...]:
        """The vehicles, one or several, each with its start and its masses."""
        if self.vehicle is None:
            return self.vehicles
        alone = SceneVehicle(
            model=self.vehicle, name=name_from_file(self.vehicle), **self._values_of_the_one()
        )
        return (alone,)

    def _check_vehicles(self) -> None:
        """Refuse no vehicle, two ways to give them, and values of the one beside several."""
        if self.vehicle is None and not self.vehicles:
            raise SceneError(
                "'vehicle' is missing; needed is a text in quotes, or several tables [[vehicles]]"
            )
        if self.vehicle is not None and self.vehicles:
            raise SceneError(
                f"vehicle is '{self.vehicle}' beside [[vehicles]] "
                f"({', '.join(vehicle.model for vehicle in self.vehicles)}); leave one of the two "
                "out, or put another model in the place of one, as vehicles.0.model"
            )
        if self.vehicles:
            defaults = {field.name: field.default for field in dataclasses.fields(Scene)}
            for key, value in self._values_of_the_one().items():
                if value != defaults[key]:
                    raise SceneError(
                        f"{key} is given beside [[vehicles]]; give it to one of them, "
                        f"as vehicles.0.{key}"
                    )

    def _check_mission(self) -> None:
        """Refuse a mission that nobody knows, or of which it is open who takes part or where."""
        if self.layout is not None:
            if self.environment not in MISSIONS:
                raise SceneError(
                    f"layout is {describe(self.layout)}, and the environment is "
                    f"{describe(self.environment)}, of which there is one layout; leave layout "
                    f"out, or take another environment; {choices(self.environment, MISSIONS)}"
                )
            read_seed(self.layout, "layout")
        if self.mission is None:
            return
        if self.mission not in MISSIONS:
            raise SceneError(
                f"unknown mission {describe(self.mission)}; {choices(self.mission, MISSIONS)}"
            )
        if len(self.entries) > 1:
            raise SceneError(
                f"mission is '{self.mission}' beside {len(self.entries)} vehicles, and a referee "
                "watches one; leave one vehicle, or watch it in a loop of your own"
            )

    def _values_of_the_one(self) -> dict[str, Any]:
        """What the scene says of its one vehicle, by key."""
        return {
            field.name: getattr(self, field.name)
            for field in dataclasses.fields(SceneVehicle)
            if field.name not in ("model", "name")
        }


KEYS = (
    *(f.name for f in dataclasses.fields(Scene) if f.name not in (*_FILLED_IN, "selection")),
    *SELECTION,
)
"""Keys of a scene's file."""
_RENAMED = {"drag": "damping"}
"""Keys that have another name now."""


def read_scene(path: str | Path, settings: Sequence[str] = ()) -> Scene:
    """Read the scene in a TOML file, with settings laid over it.

    Args:
        path: the file.
        settings: texts KEY=VALUE such as 'water.waves.0.amplitude=0.1'.

    Raises:
        SceneError: the file or a setting cannot be read, or says something that makes no sense.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, ValueError) as error:
        raise SceneError(f"cannot read scene '{path}': {error}") from error
    table = parse_toml(text, f"scene '{path}'")
    stem = path.stem
    vehicle, title = table.get("vehicle"), table.get("title")
    for setting in settings:
        apply_setting(table, setting)

    # another vehicle calls itself, and its recordings, by its own name
    if isinstance(table.get("vehicle"), str) and table["vehicle"] != vehicle:
        stem = name_from_file(table["vehicle"])
        if table.get("title") == title:
            table["title"] = f"{stem} in the scene {path.stem}"
    header = "".join(f"# with {setting}\n" for setting in settings)
    where = f"scene '{path.stem}'"
    return scene_from_table(table, where=where, stem=stem, text=header + text, folder=path.parent)


def scene_from_table(
    table: Mapping[str, Any],
    where: str = "scene",
    stem: str = "",
    text: str = "",
    folder: Path = Path(),
) -> Scene:
    """Make the scene that a table of plain values describes, as TOML has them.

    Args:
        table: the keys of a scene's file, `KEYS`, and their values.
        where: what errors call the table.
        stem: name of the scene's file.
        text: the table as TOML text, for the record.
        folder: where relative paths in the table start.

    Raises:
        SceneError: an unknown key, a missing one, or a value that makes no sense.
    """
    plain = dict(table)
    fields: dict[str, Any] = {"stem": stem, "text": text, "folder": folder}

    # tables in the table
    fields["water"] = water_from_table(plain.pop("water", {}), f"{where}: water", folder)
    fields |= read_inner_tables(plain, where)
    fields["vehicles"] = vehicles_from_tables(plain.pop("vehicles", []), where)
    if "control" in plain:
        fields["control"] = controls_from_tables(plain.pop("control"), where)
    fields["damping"] = damping_from_table(plain.pop("damping", True), f"{where}: damping")
    fields["method"] = method_from_table(plain.pop("method", "exact"), f"{where}: method")

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

"""What a scene says of each of its vehicles: `Start` and `SceneVehicle`."""

import dataclasses
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from buoyancy_mj.errors import SceneError, SceneTypeError, choices, describe
from buoyancy_mj.loads.coefficients import CoefficientsFile
from buoyancy_mj.settings.tables import build
from buoyancy_mj.settings.toml import table_of
from buoyancy_mj.values import read_array, set_number

EQUILIBRIUM = "equilibrium"
"""Value of `Start.at`."""
ENVIRONMENT = "environment"
"""What the names of the surroundings begin with in a joined model, 'environment/'."""


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
class SceneVehicle:
    """One of several vehicles of a scene.

    Raises:
        SceneError: a value out of its range, or a name that no vehicle can have.
    """

    model: str
    """MJCF or URDF file of the vehicle, or the name of a model that ships."""
    name: str | None = None
    """Name of the vehicle, before all names of its file as 'NAME/'. By default it is that of the
    file, numbered from 1 where several vehicles have the same."""
    start: Start = Start()
    """Pose and velocity at time 0."""
    mass: float | None = None
    """Mass of the whole vehicle [kg], reached by one factor on the masses and inertias of all its
    bodies; None keeps the masses of its file."""
    cog_shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Shift of the centre of gravity of the vehicle's root body, in its frame (3,) [m]."""
    coefficients: CoefficientsFile | None = None
    """A potential-flow code's dataset of added mass and radiation damping, for bodies whose file
    states none."""

    def __post_init__(self) -> None:
        check_masses(self)
        if self.name is not None and not re.fullmatch(r"[\w-]+", self.name):
            raise SceneError(
                f"name is '{self.name}'; it must be of letters, digits, '_' and '-', and not empty"
            )


VEHICLE_KEYS = tuple(field.name for field in dataclasses.fields(SceneVehicle))
"""Keys of each of the tables [[vehicles]]."""


def name_vehicles(vehicles: Sequence[SceneVehicle]) -> tuple[SceneVehicle, ...]:
    """The same vehicles, each with a name of its own.

    A vehicle without a name takes that of its file, numbered from 1 where several have the same.

    Raises:
        SceneError: two vehicles have one name, or one has that of the surroundings; or one is no
            `SceneVehicle`.
    """
    for vehicle in vehicles:
        if not isinstance(vehicle, SceneVehicle):
            raise SceneError(
                f"vehicles holds {describe(vehicle)}; each must be a SceneVehicle, as "
                "SceneVehicle(model='sauvc_auv')"
            )

    # names by file
    stems = [None if vehicle.name else name_from_file(vehicle.model) for vehicle in vehicles]
    named = []
    for i, vehicle in enumerate(vehicles):
        stem = stems[i]
        if stem is not None:
            number = f"_{stems[: i + 1].count(stem)}" if stems.count(stem) > 1 else ""
            vehicle = dataclasses.replace(vehicle, name=stem + number)
        named.append(vehicle)

    # names that are taken
    names = [vehicle.name for vehicle in named]
    for name in names:
        if names.count(name) > 1:
            raise SceneError(f"two vehicles are called '{name}'; give one of them another name")
        if name == ENVIRONMENT:
            raise SceneError(
                f"a vehicle is called '{name}', as the surroundings are; give it another name"
            )
    return tuple(named)


def vehicles_from_tables(tables: Any, where: str) -> tuple[SceneVehicle, ...]:
    """The vehicles of a list of tables; `where` is what errors call the scene."""
    if not isinstance(tables, list):
        raise SceneTypeError(
            f"{where}: vehicles is {describe(tables)}; needed is a list of tables [[vehicles]]"
        )
    vehicles = []
    for i, table in enumerate(tables):
        place = f"{where}: vehicles.{i}"
        plain = dict(table_of(table, place))
        fields = read_inner_tables(plain, place)

        # the error for an unknown key lists those of inner tables too
        for key in plain:
            if key not in VEHICLE_KEYS:
                raise SceneTypeError(
                    f"{place}: unknown key {describe(key)}; {choices(key, VEHICLE_KEYS)}"
                )
        vehicles.append(build(SceneVehicle, plain, place, **fields))
    return tuple(vehicles)


def read_inner_tables(plain: dict[str, Any], where: str) -> dict[str, Any]:
    """What the inner tables of a vehicle describe, its start and coefficients, taken out of it."""
    fields: dict[str, Any] = {}
    for key, cls in (("start", Start), ("coefficients", CoefficientsFile)):
        if key in plain:
            place = f"{where}: {key}"
            fields[key] = build(cls, table_of(plain.pop(key), place), place)
    return fields


def check_masses(owner: Any) -> None:
    """Check and convert the fields `mass` and `cog_shift` of a frozen dataclass.

    Raises:
        SceneError: a mass that is not positive, or a shift that is not of three finite numbers.
    """
    if owner.mass is not None:
        set_number(owner, SceneError, "mass", above=0.0)
    shift = read_array(SceneError, "cog_shift", owner.cog_shift, (3,))
    object.__setattr__(owner, "cog_shift", tuple(shift.tolist()))


def name_from_file(model: str) -> str:
    """The name of a vehicle by its file, of letters that names may have."""
    return re.sub(r"[^\w-]+", "_", Path(model).stem) or "vehicle"

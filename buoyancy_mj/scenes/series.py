"""`Series`: a run as a table, a row for each frame and a column for each number."""

from collections.abc import Iterator
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import Frame
from buoyancy_mj.scenes.run import Run
from buoyancy_mj.scenes.series_file import Column, SeriesFile
from buoyancy_mj.vehicle.instruments.instruments import Instruments

_AXES = ("x", "y", "z")
_ANGLES = ("roll", "pitch", "yaw")
_STATE = (
    *((f"position.{axis}", "m") for axis in _AXES),
    *((f"attitude.{angle}", "rad") for angle in _ANGLES),
    *((f"velocity.{axis}", "m/s") for axis in _AXES),
    *((f"angular_velocity.{axis}", "rad/s") for axis in _AXES),
    ("draft", "m"),
    ("elevation", "m"),
    ("volume", "m^3"),
    ("energy.kinetic", "J"),
    ("energy.potential", "J"),
    ("energy.buoyancy", "J"),
)
"""Numbers of each vehicle, and their units: those of its `VehicleFrame`, and how it moves."""
_WRENCH = (
    *((f"force.{axis}", "N") for axis in _AXES),
    *((f"torque.{axis}", "N m") for axis in _AXES),
)
"""Numbers of each load on a vehicle."""


class Series:
    """The frames of a run in a file of CSV or parquet.

    The columns are the time; of each vehicle its centre of gravity, attitude, velocities, draft and
    energy, and the force and torque of each load about that centre, world frame; then each number
    of each sensor, the controls, the forces and the activations of actuators.

    Args:
        run: the run.
        path: the file, whose name ends in .csv or .parquet.

    Raises:
        RecordingError: the name ends otherwise, or the file cannot be written.
    """

    def __init__(self, run: Run, path: Path) -> None:
        self._run = run
        self._instruments = Instruments(run.model)
        self.columns = tuple(_list_columns(run, self._instruments))
        """The columns, in their order."""
        self._file = SeriesFile(path, self.columns)

    @property
    def closed(self) -> bool:
        """Whether the file has its name already."""
        return self._file.closed

    def add(self, frame: Frame) -> None:
        """Add a row.

        Raises:
            RecordingError: the disk is full or the file was taken away; what was written stays.
        """
        parts = [np.array([frame.time])]
        for vehicle in self._run.vehicles.values():
            parts += [_read_state(vehicle, frame), *_read_wrenches(self._run, vehicle, frame)]
        parts.append(self._instruments.read(frame.data))
        self._file.add(np.concatenate(parts))

    def close(self, *, complete: bool = True) -> Path:
        """Give the file its name, and say where it is.

        Args:
            complete: whether the run came to its end. An incomplete table does not replace a file
                that is there.

        Raises:
            RecordingError: the file could not be written to its end.
        """
        return self._file.close(complete=complete)

    def discard(self) -> None:
        """Remove the file of a run that never began."""
        self._file.discard()


def _list_columns(run: Run, instruments: Instruments) -> Iterator[Column]:
    """The columns of a run; one whose name is taken gets a number."""
    taken: dict[tuple[str, str], int] = {}
    for name, unit in _list_names(run, instruments):
        count = taken[name, unit] = taken.get((name, unit), 0) + 1
        yield Column(f"{name} ({count})" if count > 1 else name, unit)


def _list_names(run: Run, instruments: Instruments) -> Iterator[tuple[str, str]]:
    """Name and unit of each number, in the order of `Series.add`."""
    yield "time", "s"
    for vehicle in run.vehicles:
        yield from ((f"{vehicle}.{name}", unit) for name, unit in _STATE)
        for cause in run.buoyancy.causes:
            yield from ((f"{vehicle}.{cause}.{name}", unit) for name, unit in _WRENCH)
    for channel in instruments.channels:
        yield channel.name, channel.unit


def _read_state(vehicle: Vehicle, frame: Frame) -> NDArray[np.float64]:
    """The numbers of `_STATE` of a vehicle."""
    seen = frame.vehicles[vehicle.name]
    energy = seen.energy
    rest = [seen.draft, seen.elevation, seen.volume]
    energies = [energy.kinetic, energy.potential, energy.buoyancy]
    spin = frame.data.cvel[vehicle.root, :3]
    velocity = find_velocity(vehicle, frame.data)
    return np.concatenate([seen.centre_of_mass, seen.attitude, velocity, spin, rest, energies])


def find_velocity(vehicle: Vehicle, data: mujoco.MjData) -> NDArray[np.float64]:
    """Velocity (3,) [m/s] of the centre of mass of a vehicle, world frame."""
    bodies = vehicle.bodies
    # MuJoCo has velocities of bodies at the centre of mass of their tree
    arms = data.xipos[bodies] - data.subtree_com[data.model.body_rootid[bodies]]
    velocities = data.cvel[bodies, 3:] + np.cross(data.cvel[bodies, :3], arms)
    velocity: NDArray[np.float64] = vehicle.masses @ velocities / vehicle.mass
    return velocity


def _read_wrenches(run: Run, vehicle: Vehicle, frame: Frame) -> Iterator[NDArray[np.float64]]:
    """Force and torque (6,) of each load on a vehicle, about its centre of mass."""
    bodies = vehicle.bodies
    arms = frame.data.xipos[bodies] - frame.vehicles[vehicle.name].centre_of_mass
    for cause in run.buoyancy.causes:
        forces, torques = np.split(frame.loads.by_cause[cause][bodies], 2, axis=1)
        torque = (torques + np.cross(arms, forces)).sum(axis=0)
        yield np.concatenate([forces.sum(axis=0), torque])

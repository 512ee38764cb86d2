"""`Meters`: all that is measured in a run, of every vehicle and of sensors."""

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.kernels.drafts import Corners
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.kinematics import Kinematics, leaves_poses
from buoyancy_mj.scenes.meter import Meter
from buoyancy_mj.scenes.sea_state import find_sea_state
from buoyancy_mj.scenes.seakeeping import Seakeeping
from buoyancy_mj.scenes.sensor_measures import SensorMeasure, SensorMeter
from buoyancy_mj.scenes.tape import LENGTH, Tape
from buoyancy_mj.scenes.trajectory import Poses, Trajectory
from buoyancy_mj.scenes.windows import find_beat
from buoyancy_mj.sea.water import Water


class Meters:
    """Measures the vehicles and the sensors of a run.

    Args:
        model: the model.
        start: its poses at the start.
        data: the data that are stepped.
        vehicles: each vehicle by its name, with the corners of its hulls.
        water: the sea.
        duration: how long the run is to last [s].
        sensors: names of the sensors to measure.

    Raises:
        SceneError: there is no such sensor.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        start: mujoco.MjData,
        data: mujoco.MjData,
        vehicles: Mapping[str, tuple[Vehicle, Corners]],
        water: Water,
        duration: float,
        sensors: Sequence[str],
    ) -> None:
        self.sea = find_sea_state(water)
        """How high and long the waves are."""
        beat = find_beat(self.sea, duration)
        self._meters = {
            name: Meter(model, start, vehicle, corners, water, beat)
            for name, (vehicle, corners) in vehicles.items()
        }
        self._sensors = SensorMeter(model, sensors, beat) if sensors else None
        self._timestep = float(model.opt.timestep)
        self._start = data.qpos.copy()
        self._kinematics = None if leaves_poses(model) else Kinematics(model, data)
        self.tape = Tape(
            model, data, self._add, kinematics=self._kinematics, with_sensors=bool(sensors)
        )
        """Keeps what each step leaves."""

    @property
    def heights(self) -> dict[str, float]:
        """Height of each vehicle's hulls [m], by its name."""
        return {name: meter.height for name, meter in self._meters.items()}

    @property
    def with_sensors(self) -> bool:
        """Whether sensors are measured."""
        return self._sensors is not None

    def add_trajectory(self, trajectory: Trajectory) -> None:
        """Add all steps of a run that was stepped elsewhere, from 0 s on."""
        times = self._timestep * np.arange(len(trajectory.qpos), dtype=np.float64)
        for start in range(0, len(times), LENGTH):
            chunk = slice(start, start + LENGTH)
            if self._kinematics is None:
                arrays = trajectory.xpos, trajectory.xmat, trajectory.xipos
                poses = Poses(*(array[chunk] for array in arrays))
            else:
                first = trajectory.qpos[start - 1] if start else self._start
                before = np.vstack([first, trajectory.qpos[chunk][:-1]])
                poses = self._kinematics.find_poses(before)
            self._add(times[chunk], poses, trajectory.sensordata[chunk])

    def measure(self, now: float, poses: Poses | None) -> dict[str, Seakeeping]:
        """How each vehicle has moved so far, by its name; NaN if no step was taken.

        Args:
            now: the present [s].
            poses: poses of the bodies at the present, if they are known.
        """
        self.tape.flush()
        return {name: meter.measure(now, poses) for name, meter in self._meters.items()}

    def measure_sensors(self, now: float) -> dict[str, SensorMeasure]:
        """What the sensors measured so far, by the names of their numbers."""
        self.tape.flush()
        return {} if self._sensors is None else self._sensors.measure(now)

    def _add(self, times: NDArray[np.float64], poses: Poses, sensors: NDArray[np.float64]) -> None:
        """Add what steps that begin at times (n,) [s] have left."""
        for meter in self._meters.values():
            meter.add(times, poses)
        if self._sensors is not None:
            self._sensors.add(times, sensors)

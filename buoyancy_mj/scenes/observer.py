"""`Observer`: what a frame says of one vehicle."""

import functools
import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.loads.loads import Loads
from buoyancy_mj.scenes.energy import EnergyMeter
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import VehicleFrame
from buoyancy_mj.scenes.monitor import Monitor
from buoyancy_mj.sea.water import Water


class Observer:
    """Sees one vehicle in the frames of a run.

    Args:
        model: the model in which the vehicle moves.
        vehicle: the vehicle.
        monitor: keeps the vehicle's draft.
        water: the sea.
    """

    def __init__(
        self, model: mujoco.MjModel, vehicle: Vehicle, monitor: Monitor, water: Water
    ) -> None:
        self._model = model
        self._vehicle = vehicle
        self._monitor = monitor
        self._water = water

    def observe(self, data: mujoco.MjData, loads: Loads) -> VehicleFrame:
        """The vehicle at the poses and velocities of data, as mj_forward left them.

        Args:
            data: of the model; the monitor has its poses already.
            loads: what the water does there.
        """
        vehicle = self._vehicle
        centre = vehicle.centre_of_mass(data)
        volumes = loads.hull.volume[vehicle.rows]
        wet = volumes > 0.0
        centroids = loads.hull.centroid[vehicle.rows][wet]
        return VehicleFrame(
            centre_of_mass=centre,
            attitude=_roll_pitch_yaw(data.xmat[vehicle.root]),
            draft=self._monitor.draft,
            elevation=float(self._water.elevation(centre[0], centre[1], float(data.time))),
            energy=self._energy_meter.measure(data, loads, self._water),
            volume=float(volumes.sum()),
            centre_of_buoyancy=(
                volumes[wet] @ centroids / volumes.sum() if wet.any() else np.full(3, np.nan)
            ),
            forces={
                cause: rows[vehicle.bodies, :3].sum(axis=0)
                for cause, rows in loads.by_cause.items()
            },
        )

    @functools.cached_property
    def _energy_meter(self) -> EnergyMeter:
        """Made for the first frame: sweeps have none."""
        return EnergyMeter(self._model, self._vehicle)


def _roll_pitch_yaw(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (3,) [rad] of a rotation (9,): first yaw about z, then pitch about y, then roll."""
    r = rotation.reshape(3, 3)
    return np.array(
        [
            math.atan2(r[2, 1], r[2, 2]),
            -math.asin(max(-1.0, min(1.0, r[2, 0]))),
            math.atan2(r[1, 0], r[0, 0]),
        ]
    )

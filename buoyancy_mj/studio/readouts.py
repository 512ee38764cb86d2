"""What the panel shows of a basin: plain numbers, taken from a frame."""

import dataclasses
from collections.abc import Mapping

import numpy as np

from buoyancy_mj.scenes.energy import Energy
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.frames import VehicleFrame
from buoyancy_mj.studio.basin import Basin
from buoyancy_mj.vehicle.instruments.instruments import Channel, Instruments


@dataclasses.dataclass(frozen=True)
class VehicleReadout:
    """One vehicle at one instant."""

    root: int
    """Index of its root body."""
    draft: float
    """Depth of its lowest point under the surface [m]."""
    heel: float
    """Roll [rad], port up."""
    trim: float
    """Pitch [rad], bow down."""
    volume: float
    """Volume of it that is under water [m^3]."""
    displacement: float
    """Mass of the water that it displaces [kg]."""
    mass: float
    """Its own mass [kg]."""
    forces: Mapping[str, tuple[float, float, float]]
    """Force of the water on it by cause (3,) [N], world frame."""
    energy: Energy
    """Its mechanical energy."""


@dataclasses.dataclass(frozen=True)
class Readout:
    """All that the panel shows of one instant."""

    time: float
    """Simulated time [s]."""
    vehicles: Mapping[str, VehicleReadout]
    """Each vehicle by its name."""
    channels: tuple[tuple[Channel, float], ...]
    """Each number that sensors measure and actuators give."""


class Reader:
    """Takes readouts of a basin.

    Args:
        basin: the scene.
    """

    def __init__(self, basin: Basin) -> None:
        self._basin = basin
        self._instruments = Instruments(basin.model)

    def read(self) -> Readout:
        """The present."""
        frame = self._basin.frame()
        numbers = self._instruments.read(frame.data).tolist()
        return Readout(
            time=frame.time,
            vehicles={
                name: _read_vehicle(self._basin.vehicles[name], seen, self._basin.water.density)
                for name, seen in frame.vehicles.items()
            },
            channels=tuple(zip(self._instruments.channels, numbers, strict=True)),
        )


def _read_vehicle(vehicle: Vehicle, seen: VehicleFrame, density: float) -> VehicleReadout:
    """What a frame says of a vehicle."""
    roll, pitch, _ = seen.attitude.tolist()
    return VehicleReadout(
        root=vehicle.root,
        draft=float(seen.draft),
        heel=roll,
        trim=pitch,
        volume=seen.volume,
        displacement=density * seen.volume,
        mass=vehicle.mass,
        forces={
            cause: tuple(np.asarray(force, float).tolist()) for cause, force in seen.forces.items()
        },
        energy=seen.energy,
    )

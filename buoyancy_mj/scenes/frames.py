"""`Frame`: one instant of a run, with each of its vehicles."""

import dataclasses
from collections.abc import Mapping
from typing import TypeVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import SceneError
from buoyancy_mj.loads.loads import Loads
from buoyancy_mj.scenes.energy import Energy

T = TypeVar("T")


@dataclasses.dataclass(frozen=True)
class VehicleFrame:
    """One vehicle at one instant."""

    centre_of_mass: NDArray[np.float64]
    """Its centre of mass (3,) [m], world frame."""
    attitude: NDArray[np.float64]
    """Roll, pitch and yaw (3,) [rad] of its root body."""
    draft: float
    """Depth of the lowest point of its hulls under the surface [m]; negative above it."""
    elevation: float
    """Height of the surface at its centre of mass [m], world frame."""
    energy: Energy
    """Its mechanical energy."""
    volume: float
    """Volume of it that is under water [m^3]."""
    centre_of_buoyancy: NDArray[np.float64]
    """Centroid of that volume (3,) [m], world frame; NaN where all is dry."""
    forces: Mapping[str, NDArray[np.float64]]
    """Force of the water on it by cause, each (3,) [N], world frame."""


@dataclasses.dataclass(frozen=True)
class Frame:
    """One instant of a run.

    What the frame says of its only vehicle, it says itself: `frame.draft` is
    `frame.vehicles[NAME].draft`. Where there are several, that is an error which names them.
    """

    time: float
    """Simulated time [s]."""
    data: mujoco.MjData
    """Poses and velocities at exactly this time; the next frame overwrites them."""
    loads: Loads
    """Forces and torques of the water on everything in it."""
    vehicles: Mapping[str, VehicleFrame]
    """Each vehicle by its name."""

    @property
    def centre_of_mass(self) -> NDArray[np.float64]:
        """Centre of mass of the only vehicle (3,) [m], world frame."""
        return take_only(self.vehicles).centre_of_mass

    @property
    def attitude(self) -> NDArray[np.float64]:
        """Roll, pitch and yaw (3,) [rad] of the root body of the only vehicle."""
        return take_only(self.vehicles).attitude

    @property
    def draft(self) -> float:
        """Depth of the lowest point of the only vehicle's hulls [m]; negative above the surface."""
        return take_only(self.vehicles).draft

    @property
    def elevation(self) -> float:
        """Height of the surface at the centre of mass of the only vehicle [m], world frame."""
        return take_only(self.vehicles).elevation

    @property
    def energy(self) -> Energy:
        """Mechanical energy of the only vehicle."""
        return take_only(self.vehicles).energy


def take_only(vehicles: Mapping[str, T]) -> T:
    """What belongs to the only vehicle, of something by the names of vehicles.

    Raises:
        SceneError: there are several; the message names them.
    """
    if len(vehicles) > 1:
        names = ", ".join(vehicles)
        raise SceneError(
            f"this scene has {len(vehicles)} vehicles ({names}); say which, as in "
            f"vehicles['{next(iter(vehicles))}']"
        )
    (one,) = vehicles.values()
    return one

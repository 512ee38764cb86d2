"""The mechanical energy of one vehicle among others."""

import copy
import dataclasses

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.placed_ballasts import find_ballasts
from buoyancy_mj.loads.loads import Loads
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.sea.water import Water

_STIFFNESSES = ("stiffness", "stiffnesspoly")
"""What makes springs of joints and of tendons."""


@dataclasses.dataclass(frozen=True)
class Energy:
    """Mechanical energy [J] of a vehicle and of the water that it displaces.

    The total is constant without drag on still water.
    """

    kinetic: float
    """Kinetic energy of the bodies [J], with that of their added mass and of water in tanks."""
    potential: float
    """Potential energy of the bodies in gravity (and in springs) [J], zero at z = 0. A spring
    between two vehicles counts with neither. What gravity compensation carries has none. The water
    in tanks counts."""
    buoyancy: float
    """Energy [J] that lifted the displaced water from its centroid to the surface:
    rho g V (elevation - z). A bladder counts as wholly wet."""

    @property
    def total(self) -> float:
        """The sum [J]."""
        return self.kinetic + self.potential + self.buoyancy


class EnergyMeter:
    """Finds the energy of one vehicle of a model.

    Args:
        model: the model.
        vehicle: the vehicle.
    """

    def __init__(self, model: mujoco.MjModel, vehicle: Vehicle) -> None:
        self._model = model
        self._vehicle = vehicle
        self._dofs = np.isin(model.dof_bodyid, vehicle.bodies)
        self._springs = _model_of_springs(model, vehicle)
        self._moments = np.zeros(model.nv)
        placed = find_ballasts(model)
        self._ballast = [one for one in placed if one.body in vehicle.bodies]

    def measure(self, data: mujoco.MjData, loads: Loads, water: Water) -> Energy:
        """The energy at the poses and velocities of data, as mj_forward left them.

        Args:
            data: of the model; its own energy stays.
            loads: what the water does there.
            water: the sea.
        """
        # the mass matrix couples no trees, so each vehicle has its own part of v M v
        mujoco.mj_mulM(self._model, data, self._moments, data.qvel)
        kinetic = 0.5 * float(data.qvel[self._dofs] @ self._moments[self._dofs])

        # the displaced water
        rows = self._vehicle.rows
        lifted = water.depth(loads.hull.centroid[rows], float(data.time))
        buoyancy = float(np.nansum(loads.hull.force[rows, 2] * lifted))
        lowered, blown = self._measure_ballast(data, water)
        return Energy(kinetic, self._potential(data) + lowered, buoyancy + blown)

    def _measure_ballast(self, data: mujoco.MjData, water: Water) -> tuple[float, float]:
        """Potential energy of the water in tanks [J], and that of what bladders displace."""
        lowered = blown = 0.0
        for one in self._ballast:
            volume = float(np.clip(data.act[one.state], 0.0, one.capacity))
            if not volume > 0.0:
                continue
            weight = water.density * self._vehicle.gravity * volume
            turn = data.geom_xmat[one.geom].reshape(3, 3)
            at = one.find_centroid(volume, turn, data.geom_xpos[one.geom])
            if one.holds_water:
                lowered += weight * float(at[2])
            else:
                blown += weight * float(water.depth(at, float(data.time)))
        return lowered, blown

    def _potential(self, data: mujoco.MjData) -> float:
        """Potential energy of the vehicle in gravity and in its springs [J]."""
        bodies = self._vehicle.bodies
        weights = self._vehicle.weighing_masses * self._vehicle.gravity
        return float(weights @ data.xipos[bodies, 2]) + self._spring_energy(data)

    def _spring_energy(self, data: mujoco.MjData) -> float:
        """Energy in the springs of the vehicle [J], by MuJoCo's own sum."""
        if self._springs is None:
            return 0.0
        before: NDArray[np.float64] = data.energy.copy()
        mujoco.mj_energyPos(self._springs, data)
        energy = float(data.energy[0])
        data.energy[:] = before
        return energy


def _model_of_springs(model: mujoco.MjModel, vehicle: Vehicle) -> mujoco.MjModel | None:
    """A copy of the model with the vehicle's springs and without weight; None if it has none."""
    own_joints = np.isin(model.jnt_bodyid, vehicle.bodies)
    own_tendons = _find_own_tendons(model, vehicle)
    if not (model.jnt_stiffness[own_joints].any() or own_tendons.any()):
        return None
    springs = copy.copy(model)
    springs.body_mass[:] = 0.0
    for name in _STIFFNESSES:
        getattr(springs, f"jnt_{name}")[~own_joints] = 0.0
        getattr(springs, f"tendon_{name}")[~own_tendons] = 0.0
    return springs


def _find_own_tendons(model: mujoco.MjModel, vehicle: Vehicle) -> NDArray[np.bool_]:
    """Whether each tendon (ntendon,) runs over bodies of the vehicle, and of no other."""
    own = np.append(np.unique(model.body_treeid[vehicle.bodies]), -1)
    trees = model.tendon_treeid
    return np.asarray((trees[:, 0] >= 0) & np.isin(trees, own).all(axis=1))

"""`Monitor`: what the summary of a run keeps of its steps."""

import math

import mujoco
import numpy as np

from buoyancy_mj.hulls.bodies import find_moving_bodies
from buoyancy_mj.kernels.drafts import Corners
from buoyancy_mj.kernels.entries.steps import add_instant, add_trajectory
from buoyancy_mj.kernels.entries.views import Table
from buoyancy_mj.kernels.watching import FIXED, OWN, Watched
from buoyancy_mj.scenes.corners import gather_corners
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.scenes.seakeeping import Seakeeping
from buoyancy_mj.scenes.summary import VehicleSummary
from buoyancy_mj.scenes.trajectory import Poses, Trajectory
from buoyancy_mj.sea.water import Water

_ROOM = 256
"""Room for so many poses at first."""


class Monitor:
    """The draft of a vehicle and its contacts, over a run.

    Compiled code keeps them step by step, see `kernels.entries.steps`.

    Args:
        model: the model in which the vehicle moves.
        vehicle: the vehicle.
        water: the sea.
    """

    def __init__(self, model: mujoco.MjModel, vehicle: Vehicle, water: Water) -> None:
        self.draft = math.nan
        """Depth of the lowest point of the hulls in the last instant [m]; negative above water."""
        self._vehicle = vehicle
        corners = gather_corners(vehicle, water)
        owners = np.zeros(model.ngeom, np.int64)
        owners[~find_moving_bodies(model)[model.geom_bodyid]] = FIXED
        owners[np.isin(model.geom_bodyid, vehicle.bodies)] = OWN
        self._table = Table(
            Watched(
                corners=corners,
                bodies=vehicle.bodies,
                masses=vehicle.masses,
                mass=vehicle.mass,
                owners=owners,
                seen=np.zeros(1, np.int64),
                times=np.zeros(_ROOM),
                heights=np.zeros(_ROOM),
                peak=np.full(1, -math.inf),
                contact_steps=np.zeros(1, np.int64),
                first_contact=np.full(1, math.nan),
            )
        )

    @property
    def peak_draft(self) -> float:
        """Greatest draft so far [m]."""
        return float(self._table.arrays.peak[0])

    @property
    def contact_steps(self) -> int:
        """Steps so far in which the vehicle touched something fixed."""
        return int(self._table.arrays.contact_steps[0])

    @property
    def first_contact(self) -> float | None:
        """Time of the first of them [s]; None for none."""
        first = float(self._table.arrays.first_contact[0])
        return None if math.isnan(first) else first

    @property
    def corners(self) -> Corners:
        """The corners of the vehicle that can be deepest."""
        return self._table.arrays.corners

    def reserve(self, count: int) -> int:
        """Make room for the heights of as many more poses; the address of the `Watched` has it."""
        arrays = self._table.arrays
        # the heights of before are of no use any more
        arrays.seen[0] = 0
        if count > len(arrays.times):
            self._table = Table(arrays._replace(times=np.zeros(count), heights=np.zeros(count)))
        return self._table.address

    def add_poses(self, poses: Poses, time: float) -> None:
        """Keep the draft in poses at a time [s]."""
        self.draft = add_instant(self.reserve(1), *poses, time)

    def add_trajectory(self, trajectory: Trajectory, timestep: float) -> None:
        """Keep those of the poses at the beginning of all steps of a run.

        Args:
            trajectory: what the run left, from 0 s on.
            timestep: from one step to the next [s].
        """
        poses = trajectory.xpos, trajectory.xmat, trajectory.xipos
        add_trajectory(self.reserve(len(trajectory.qpos)), *poses, timestep)

    def add_contacts(self, data: mujoco.MjData, time: float) -> None:
        """Count the step that ended at a time [s] if the vehicle touched something fixed in it."""
        known, geoms = self._table.arrays, data.contact.geom
        pairs = known.owners[geoms[(geoms >= 0).all(axis=1)]]
        if (np.sort(pairs, axis=1) == sorted((OWN, FIXED))).all(axis=1).any():
            known.contact_steps[0] += 1
            if math.isnan(known.first_contact[0]):
                known.first_contact[0] = time

    def summary(
        self, height: float, seakeeping: Seakeeping, updates_at_limits: int | None = None
    ) -> VehicleSummary:
        """The run so far.

        Args:
            height: height of the vehicle's hulls [m].
            seakeeping: how the vehicle moved.
            updates_at_limits: what the controller knows, see `VehicleSummary`.
        """
        vehicle = self._vehicle
        return VehicleSummary(
            mass=vehicle.mass,
            displacement=vehicle.displacement,
            net_weight=vehicle.weight - vehicle.displacement * vehicle.gravity,
            height=height,
            peak_draft=self.peak_draft,
            final_draft=self.draft,
            seakeeping=seakeeping,
            contact_steps=self.contact_steps,
            first_contact=self.first_contact,
            updates_at_limits=updates_at_limits,
        )

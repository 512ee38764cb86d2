"""Poses of the bodies of a model, at one instant and over a whole run."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray


class Poses(NamedTuple):
    """Where the bodies of a model are at one instant, named as in `MjData`."""

    xpos: NDArray[np.float64]
    """Origins of the bodies (nbody, 3) [m]."""
    xmat: NDArray[np.float64]
    """Their rotations world_from_body (nbody, 9)."""
    xipos: NDArray[np.float64]
    """Their centres of mass (nbody, 3) [m]."""


def poses_of(data: mujoco.MjData) -> Poses:
    """The poses that data hold, as views."""
    return Poses(data.xpos, data.xmat, data.xipos)


class Trajectory(NamedTuple):
    """What is left of a run, step by step, named as in `MjData`."""

    xpos: NDArray[np.float64]
    """Origins of all bodies at the beginning of each step (steps, nbody, 3) [m]."""
    xmat: NDArray[np.float64]
    """Their rotations world_from_body at the beginning of each step (steps, nbody, 9)."""
    xipos: NDArray[np.float64]
    """Their centres of mass at the beginning of each step (steps, nbody, 3) [m]."""
    qpos: NDArray[np.float64]
    """Coordinates at the end of each step (steps, nq)."""
    ncon: NDArray[np.int32]
    """Number of contacts in each step (steps,)."""
    sensordata: NDArray[np.float64]
    """What sensors measured in each step (steps, nsensordata); (steps, 0) where none is asked."""

    def poses(self, step: int) -> Poses:
        """The poses at the beginning of a step."""
        return Poses(self.xpos[step], self.xmat[step], self.xipos[step])

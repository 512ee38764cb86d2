"""Gains of a PID along the six axes of a vehicle, from its mass and a bandwidth."""

from typing import TYPE_CHECKING, NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.vehicle.allocation import AXES
from buoyancy_mj.vehicle.control.controller import Outset
from buoyancy_mj.vehicle.control.motion import find_free_joint
from buoyancy_mj.vehicle.crafts import find_centre

if TYPE_CHECKING:
    from buoyancy_mj.vehicle.control.hold import Hold

SLOWNESS = 5.0
"""How much slower than the bandwidth the integral is."""
_KEYS = ("position", "position", "depth", "roll", "pitch", "heading")
"""What is held along each axis."""


class Gains(NamedTuple):
    """Gains along surge, sway and heave, roll, pitch and yaw."""

    proportional: NDArray[np.float64]
    """(6,) [N/m, N m/rad]."""
    integral: NDArray[np.float64]
    """(6,) [N/(m s), N m/(rad s)]."""
    derivative: NDArray[np.float64]
    """(6,) [N s/m, N m s/rad]."""


def choose_gains(hold: "Hold", outset: Outset) -> Gains:
    """The gains of a hold: m w^2, m w^3 / 5 and 2 m w for a bandwidth w, where none are given.

    A mass m with these has a damping ratio of 1, as a spring and a damper would give it. T. I.
    Fossen, Handbook of Marine Craft Hydrodynamics and Motion Control (2011), section 12.2.
    """
    masses, w = find_apparent_masses(outset), hold.bandwidth
    gains = np.array([masses * w**2, masses * w**3 / SLOWNESS, 2.0 * masses * w])
    for i, key in zip(range(len(AXES)), _KEYS, strict=True):
        given = getattr(hold, f"{key}_gains")
        if given is not None:
            gains[:, i] = given
    return Gains(*gains)


def find_apparent_masses(outset: Outset) -> NDArray[np.float64]:
    """Mass and inertia about the centre of gravity with the added mass that acts (6,) [kg, kg m^2].

    It is the diagonal of the engine's mass matrix, joints of the vehicle held still.
    """
    model, data = outset.model, outset.data
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    dof = find_free_joint(model, outset.craft).dof
    own = matrix[dof : dof + 6, dof : dof + 6]

    # the joint's velocity is that of the origin in the world, and its spin that of the body
    turn = data.xmat[outset.craft.root].reshape(3, 3)
    x, y, z = turn.T @ (find_centre(model, data, outset.craft) - data.xpos[outset.craft.root])
    arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    origin_from_centre = np.block([[turn, turn @ arm], [np.zeros((3, 3)), np.eye(3)]])
    return np.diag(origin_from_centre.T @ own @ origin_from_centre)

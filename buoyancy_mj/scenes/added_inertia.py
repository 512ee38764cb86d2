"""`measure_added_mass`: what the water adds to the inertia of a vessel, as MuJoCo has it."""

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.statics.heading_axes import rotate_to_heading
from buoyancy_mj.statics.hydrostatics import Hydrostatics
from buoyancy_mj.statics.vessel import Vessel


def measure_added_mass(
    model: mujoco.MjModel,
    vessel: Vessel,
    at: Hydrostatics,
    qpos: ArrayLike,
    act: ArrayLike | None = None,
) -> NDArray[np.float64]:
    """Measure the added mass of a vessel about its centre of gravity.

    It is what the water adds to MuJoCo's inertia of the root's six freedoms, the other joints held.

    Args:
        model: a model whose water is a part of it.
        vessel: the vessel.
        at: its hydrostatics in the attitude of `qpos`, whose axes the result has.
        qpos: coordinates of the model (nq,).
        act: its activations (na,); those of new data if None.

    Returns:
        Added mass (6, 6) [kg, kg m, kg m^2]; zero for what is not one kinematic tree on a free
        joint, and where the water enters in another way.
    """
    if vessel.tether is not None or len(vessel.trees) > 1:
        return np.zeros((6, 6))
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    if act is not None:
        data.act[:] = act
    whole = np.zeros((model.nv, model.nv))
    with raise_causes():
        mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, whole)
    first = int(model.body_dofadr[vessel.root])
    inertia = whole[first : first + 6, first : first + 6]

    # from velocities of the centre along the heading to those of MuJoCo's free joint: the origin's
    # in the world's axes, and the turning in the body's
    turn = rotate_to_heading(at.heading).T
    body = data.xmat[vessel.root].reshape(3, 3)
    arm = body @ vessel.centre_of_gravity
    free = np.zeros((6, 6))
    free[:3, :3] = turn
    free[:3, 3:] = np.cross(arm, turn.T).T
    free[3:, 3:] = body.T @ turn
    return np.asarray(free.T @ inertia @ free - at.mass_matrix, float)

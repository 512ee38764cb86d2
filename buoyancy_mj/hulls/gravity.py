"""The gravity of a model, which water needs along -z, and the masses on which it pulls."""

import math

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.multibody import downward_gravity

_NEGLIGIBLE = 1e-12
"""Part of the mass of a body below which what is left of it by gravity compensation is rounding."""


def read_gravity(model: mujoco.MjModel, *, required: bool = False) -> float:
    """The downward acceleration of a model [m/s^2]; 0 where its flags disable gravity.

    Args:
        model: any model.
        required: whether a model without gravity is refused.

    Raises:
        ModelError: gravity is not along -z; or it is zero or disabled, and required.
    """
    disabled = bool(model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_GRAVITY)
    if required and disabled:
        raise ModelError(
            "gravity is disabled, and nothing floats without it: remove <flag gravity='disable'/>"
        )
    gravity = float(downward_gravity(model.opt.gravity, model.opt.disableflags))
    if math.isnan(gravity) or (required and gravity == 0.0):
        x, y, z = model.opt.gravity
        raise ModelError(
            f"gravity is {x:g} {y:g} {z:g}; water needs it along -z: "
            "set <option gravity='0 0 -9.81'/>"
        )
    return gravity


def find_weighing_masses(model: mujoco.MjModel) -> NDArray[np.float64]:
    """The mass of each body that weighs (nbody,) [kg]: what gravity compensation carries is off.

    MuJoCo lifts a body by `gravcomp` times its weight, at its centre of mass. It does so with the
    passive forces, or with those of the actuators where the joint of the body says
    `actuatorgravcomp`. A floating body feels what the free joint of its tree lets through.
    Negative is a body that is lifted by more than it weighs.
    """
    acts = np.array([_acts_on_tree(model, int(tree)) for tree in range(model.ntree)], bool)
    compensated = np.zeros(model.nbody)
    moving = model.body_treeid >= 0
    compensated[moving] = model.body_gravcomp[moving] * acts[model.body_treeid[moving]]
    left = 1.0 - compensated
    left[np.abs(left) <= _NEGLIGIBLE] = 0.0
    return np.asarray(model.body_mass * left, float)


def _acts_on_tree(model: mujoco.MjModel, tree: int) -> bool:
    """Whether gravity compensation acts through the first joint of a kinematic tree."""
    if not model.ngravcomp:
        return False
    flags = model.opt.disableflags
    passive = int(mujoco.mjtDisableBit.mjDSBL_SPRING) | int(mujoco.mjtDisableBit.mjDSBL_DAMPER)
    joint = model.dof_jntid[model.tree_dofadr[tree]]
    if model.jnt_actgravcomp[joint]:
        return bool(model.nu) and not flags & mujoco.mjtDisableBit.mjDSBL_ACTUATION
    return bool(flags & passive != passive)

"""The gravity of a model, which water needs along -z."""

import math

import mujoco

from buoyancy_mj.errors import ModelError
from buoyancy_mj.kernels.multibody import downward_gravity


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

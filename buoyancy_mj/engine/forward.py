"""One pass over data as mj_forward makes it, without the control callback."""

import mujoco

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import raise_causes


def forward_without_control(data: mujoco.MjData, buoyancy: Buoyancy) -> None:
    """Do what mj_forward does, with the water at work and without the control callback.

    The water acts whether or not it is installed. Controls and applied forces are those that the
    data hold. Nobody's controller is called, which may keep a state of its own.

    Args:
        data: of the water's model.
        buoyancy: the water.

    Raises:
        ModelError: the data are of another model; and all that the water raises.
    """
    model = data.model
    has_energy = bool(model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY)
    with raise_causes():
        mujoco.mj_fwdPosition(model, data)
        mujoco.mj_sensorPos(model, data)
        if has_energy:
            mujoco.mj_energyPos(model, data)
        mujoco.mj_fwdVelocity(model, data)
        mujoco.mj_sensorVel(model, data)
        if has_energy:
            mujoco.mj_energyVel(model, data)
        buoyancy.act_late(data)
        mujoco.mj_fwdActuation(model, data)
        mujoco.mj_fwdAcceleration(model, data)
        mujoco.mj_fwdConstraint(model, data)
        mujoco.mj_sensorAcc(model, data)

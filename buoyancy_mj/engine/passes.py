"""One pass of the water by Python, over the kernels that compiled code calls."""

import mujoco

from buoyancy_mj.engine.load_model import LoadModel
from buoyancy_mj.kernels import passes
from buoyancy_mj.kernels.arrays import gather
from buoyancy_mj.kernels.multibody import Engine
from buoyancy_mj.kernels.passes import Record


def evaluate(
    load_model: LoadModel,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    gravity: float,
    run: int,
    record: Record,
) -> None:
    """Evaluate the submersion, each load and their sum.

    Args:
        load_model: what acts.
        model: the model.
        data: its data, as mj_forward left them.
        gravity: downward acceleration [m/s^2].
        run: a number for what the method of submersion carries from step to step.
        record: written.
    """
    record.wet[:] = load_model.packed.submerge(data.geom_xpos, data.geom_xmat, data.time, run)
    engine = _read_engine(model, data)
    passes.add_up(load_model.arrays, engine, gravity, load_model.scratch, record)


def apply(
    load_model: LoadModel, model: mujoco.MjModel, data: mujoco.MjData, record: Record
) -> None:
    """Add what `evaluate` found to the passive forces, and the added mass to the mass matrix."""
    done = passes.apply(load_model.arrays, _read_engine(model, data), record)
    if done != passes.UNCHANGED:
        mujoco.mj_factorM(model, data)
    if done == passes.AUGMENT_DUAL:
        mujoco.mj_projectConstraint(model, data)


def _read_engine(model: mujoco.MjModel, data: mujoco.MjData) -> Engine:
    """What kernels read of a model and its data, and write to."""
    return gather(Engine, {"mjModel.opt": model.opt, "mjModel": model, "mjData": data})

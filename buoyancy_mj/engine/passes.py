"""One pass of the water by Python, over the kernels that compiled code calls."""

import collections
import dataclasses
from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.load_model import LoadModel
from buoyancy_mj.kernels import delivery, passes
from buoyancy_mj.kernels.arrays import gather
from buoyancy_mj.kernels.multibody import Engine
from buoyancy_mj.kernels.passes import DATA, PassArrays, Record

MOST_RECENT = 64
"""Data whose last passes by Python stay readable."""


@dataclasses.dataclass
class Pass:
    """The last pass over some data."""

    record: Record
    """What it left."""
    before: NDArray[np.float64]
    """The passive forces (nv,) without the water."""
    after: NDArray[np.float64]
    """The same with the water; NaN where it did not act on them."""


class RecentPasses:
    """The last passes over each of the data that were stepped last."""

    def __init__(self, new_record: Callable[[], Record], forces: int) -> None:
        self._new_record, self._forces = new_record, forces
        self._passes: collections.OrderedDict[int, Pass] = collections.OrderedDict()

    def take(self, data: int) -> Pass:
        """The pass over the data at an address, to be written anew."""
        found = self._passes.pop(data, None)
        if found is None:
            found = Pass(self._new_record(), *np.full((2, self._forces), np.nan))
            if len(self._passes) >= MOST_RECENT:
                self._passes.popitem(last=False)
        self._passes[data] = found
        return found

    def find(self, data: int) -> Record | None:
        """What the last pass over the data at an address left; None if it is not among the last."""
        found = self._passes.get(data)
        return found.record if found is not None and found.record.ids[DATA] else None


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
    loads, scratch = load_model.arrays, load_model.scratch
    passes.begin(loads, record)
    for load in load_model.acting:
        items = passes.count_items(load, loads)
        load(PassArrays(loads, engine, gravity, scratch, record, 0, items))
    passes.end(engine, record)


def apply(load_model: LoadModel, model: mujoco.MjModel, data: mujoco.MjData, last: Pass) -> None:
    """Add what `evaluate` found to the passive forces, and the added mass to the mass matrix."""
    passive = data.qfrc_passive
    # finite differences call a control callback again without computing qfrc_passive anew
    if np.array_equal(passive, last.after):
        passive[:] = last.before
    last.before[:] = passive
    delivery.deliver(load_model.arrays, _read_engine(model, data), last.record)
    last.after[:] = passive
    _augment(load_model, model, data, last.record)


def augment(load_model: LoadModel, model: mujoco.MjModel, data: mujoco.MjData, last: Pass) -> None:
    """Add the added mass of what `evaluate` found to the mass matrix."""
    last.after[:] = np.nan
    _augment(load_model, model, data, last.record)


def _augment(
    load_model: LoadModel, model: mujoco.MjModel, data: mujoco.MjData, record: Record
) -> None:
    """Add added mass and tanks to the mass matrix, and let MuJoCo take up what was changed."""
    if not load_model.augments:
        return
    done = delivery.augment(load_model.arrays, _read_engine(model, data), record)
    if done != delivery.UNCHANGED:
        mujoco.mj_factorM(model, data)
        # a control callback comes after the kinetic energy
        if model.opt.enableflags & mujoco.mjtEnableBit.mjENBL_ENERGY:
            mujoco.mj_energyVel(model, data)
    if done == delivery.AUGMENT_DUAL:
        mujoco.mj_projectConstraint(model, data)


def _read_engine(model: mujoco.MjModel, data: mujoco.MjData) -> Engine:
    """What kernels read of a model and its data, and write to."""
    return gather(Engine, {"mjModel.opt": model.opt, "mjModel": model, "mjData": data})

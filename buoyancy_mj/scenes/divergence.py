"""Simulations that leave the finite numbers, by MuJoCo's counters of bad values."""

import mujoco
import numpy as np

from buoyancy_mj.errors import DivergenceError
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.scenes.scene import Scene

QUANTITIES = {
    mujoco.mjtWarning.mjWARN_BADQPOS: "position",
    mujoco.mjtWarning.mjWARN_BADQVEL: "velocity",
    mujoco.mjtWarning.mjWARN_BADQACC: "acceleration",
}
"""The quantity that is bad, by the warning that MuJoCo counts."""


def check_finite(scene: Scene, model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Check that MuJoCo has met no bad value so far.

    Raises:
        DivergenceError: it has; the error names the body and the quantity.
    """
    for warning, quantity in QUANTITIES.items():
        counter = data.warning[warning]
        if counter.number:
            body = _body_of(model, warning, counter.lastinfo)
            subject = f"the {quantity} of body '{body_name(model, body)}'"
            raise DivergenceError(describe_divergence(scene, float(data.time), subject))


def describe_divergence(
    scene: Scene, time: float, subject: str = "a position, velocity or acceleration"
) -> str:
    """The sentence that tells of a run that diverged at a time [s]."""
    return (
        f"the simulation diverged at {time:.4g} s: {subject} is not a finite, sensible number; "
        f"try a smaller timestep (now {scene.timestep:g} s) or another integrator "
        f"(now {scene.integrator})"
    )


def _body_of(model: mujoco.MjModel, warning: mujoco.mjtWarning, index: int) -> int:
    """The body whose coordinate, or degree of freedom, has the index that a warning holds."""
    if warning != mujoco.mjtWarning.mjWARN_BADQPOS:
        return int(model.dof_bodyid[index])
    joint = int(np.searchsorted(model.jnt_qposadr, index, side="right")) - 1
    return int(model.jnt_bodyid[joint])

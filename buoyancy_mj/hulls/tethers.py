"""What keeps bodies that float together from floating freely: joints, welds, connects."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.hulls.bodies import Bond, list_bonds
from buoyancy_mj.hulls.names import body_name


def list_roots(model: mujoco.MjModel, bodies: NDArray[np.int64]) -> list[int]:
    """Root bodies of the kinematic trees to which bodies belong, in the order of the model."""
    return [int(model.tree_bodyadr[tree]) for tree in np.unique(model.body_treeid[bodies])]


def has_free_joint(model: mujoco.MjModel, body: int) -> bool:
    """Whether the first joint of a body is a free joint."""
    joint = int(model.body_jntadr[body])
    return joint >= 0 and int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_FREE)


def find_tether(model: mujoco.MjModel, bodies: NDArray[np.int64]) -> str:
    """Say what keeps bodies from floating freely, and the mend; '' if nothing does.

    Args:
        model: their model.
        bodies: indices of the bodies of a vessel.
    """
    for bond in list_bonds(model):
        fixed = [body for body in bond.bodies if model.body_treeid[body] < 0]
        held = [body for body in bond.bodies if body in bodies]
        if fixed and held:
            to = "the world" if fixed[0] == 0 else f"'{body_name(model, fixed[0])}'"
            return (
                f"{describe_bond(model, bond)} holds body '{body_name(model, held[0])}' to {to}, "
                "and it is not free to float; set its active='false', or leave it out"
            )
    for root in list_roots(model, bodies):
        if not has_free_joint(model, root):
            return (
                f"body '{body_name(model, root)}' hangs on joints and is not free to float; "
                "give it a <freejoint/>"
            )
    return ""


def describe_bond(model: mujoco.MjModel, bond: Bond) -> str:
    """A weld or a connect by its kind and its name, or by its bodies."""
    kind = "weld" if model.eq_type[bond.equality] == mujoco.mjtEq.mjEQ_WELD else "connect"
    name = str(model.equality(bond.equality).name)
    if name:
        return f"{kind} '{name}'"
    one, other = (body_name(model, body) for body in bond.bodies)
    return f"the {kind} of '{one}' and '{other}'"

"""Which bodies of a model can move, and which of them float together."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.meshes.components import label_components

_JOINING = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))
"""Equality constraints that hold two bodies together."""
_SWITCHES = int(mujoco.mjtDisableBit.mjDSBL_CONSTRAINT) | int(mujoco.mjtDisableBit.mjDSBL_EQUALITY)
"""Flags under which no equality constraint acts."""


class Bond(NamedTuple):
    """A weld or a connect that acts."""

    equality: int
    """Index of the equality constraint."""
    bodies: tuple[int, int]
    """Indices of the bodies that it holds together; 0 is the world."""


def find_moving_bodies(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Whether each body can move (nbody,): it, or what carries it, has a joint.

    Static bodies and mocap bodies cannot: they are surroundings, wherever they stand in the file.
    """
    return np.asarray(model.body_treeid >= 0)


def find_mocap_bodies(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Whether each body (nbody,) is a mocap body, or fixed to one."""
    return np.asarray(model.body_mocapid[model.body_weldid] >= 0)


def group_floating_bodies(model: mujoco.MjModel) -> tuple[NDArray[np.int64], ...]:
    """The bodies that float together, as indices, in the order of the model.

    A group is a kinematic tree, or several that active welds and connects hold together. Static
    bodies and mocap bodies belong to none.
    """
    labels = np.arange(model.ntree)
    edges = _find_joined_trees(model)
    if edges:
        labels = label_components(np.array(edges, np.int64), model.ntree)
    return tuple(
        np.flatnonzero(np.isin(model.body_treeid, np.flatnonzero(labels == label)))
        for label in dict.fromkeys(labels.tolist())
    )


def list_bonds(model: mujoco.MjModel) -> tuple[Bond, ...]:
    """The welds and connects that are active and not disabled by a flag, in the model's order."""
    if model.opt.disableflags & _SWITCHES:
        return ()
    return tuple(
        Bond(i, _find_ends(model, i))
        for i in range(model.neq)
        if model.eq_type[i] in _JOINING and model.eq_active0[i]
    )


def _find_ends(model: mujoco.MjModel, equality: int) -> tuple[int, int]:
    """Bodies of a weld or a connect, which may name sites on them."""
    one, other = int(model.eq_obj1id[equality]), int(model.eq_obj2id[equality])
    if model.eq_objtype[equality] == mujoco.mjtObj.mjOBJ_SITE:
        return int(model.site_bodyid[one]), int(model.site_bodyid[other])
    return one, other


def _find_joined_trees(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Pairs of kinematic trees that an active weld or connect holds together."""
    pairs = [
        tuple(int(model.body_treeid[body]) for body in bond.bodies) for bond in list_bonds(model)
    ]
    return [(one, two) for one, two in pairs if one >= 0 and two >= 0]

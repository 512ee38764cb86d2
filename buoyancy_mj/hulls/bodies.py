"""Which bodies of a model can move, and which of them float together."""

import mujoco
import numpy as np
import trimesh
from numpy.typing import NDArray

_JOINING = (int(mujoco.mjtEq.mjEQ_CONNECT), int(mujoco.mjtEq.mjEQ_WELD))
"""Equality constraints that hold two bodies together."""


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
    edges = np.array(_find_joined_trees(model), np.int64).reshape(-1, 2)
    labels = trimesh.graph.connected_component_labels(edges, model.ntree)
    return tuple(
        np.flatnonzero(np.isin(model.body_treeid, np.flatnonzero(labels == label)))
        for label in dict.fromkeys(labels.tolist())
    )


def _find_joined_trees(model: mujoco.MjModel) -> list[tuple[int, int]]:
    """Pairs of kinematic trees that an active weld or connect holds together."""
    pairs = []
    for i in range(model.neq):
        if model.eq_type[i] in _JOINING and model.eq_active0[i]:
            ends = [int(model.eq_obj1id[i]), int(model.eq_obj2id[i])]
            if model.eq_objtype[i] == mujoco.mjtObj.mjOBJ_SITE:
                ends = [int(model.site_bodyid[site]) for site in ends]
            one, two = (int(model.body_treeid[body]) for body in ends)
            if one >= 0 and two >= 0:
                pairs.append((one, two))
    return pairs

"""The kinematic trees of one vessel, and the shape in which welds and connects hold them."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.bodies import Bond, list_bonds
from buoyancy_mj.hulls.tethers import describe_bond, list_roots

_FITS = 1e-3
"""Gap of a weld or a connect, over the size of the vessel, below which it counts as closed.

MJCF rounds the poses of welds to six digits."""
_LONGEST_STEP = 0.5
"""Largest turn of a tree in one step of the search for the shape [rad]."""
_MOST_STEPS = 100
"""Steps after which that search ends."""


class JoinedTree(NamedTuple):
    """A kinematic tree of a vessel, by the pose of its root."""

    root: int
    """Index of its root body."""
    position: NDArray[np.float64]
    """Origin of its root in the frame of the vessel's root body (3,) [m]."""
    rotation: NDArray[np.float64]
    """Rotation of its root to that frame (3, 3)."""


class Joining(NamedTuple):
    """What bringing trees into one shape led to."""

    freedoms: int
    """Number of ways in which the trees still move against each other."""
    moved: float
    """How far the root of a tree moved at most against the vessel's root [m]."""
    moved_tree: int
    """Root of the tree that did."""


def join_trees(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64], root: int
) -> Joining:
    """Bring the trees of a vessel into the shape that its welds and connects demand.

    Gauss-Newton steps on MuJoCo's own constraints, the least that close them, move the free joints
    of all trees but the root's. Other joints are held. Where connects leave a freedom, the shape is
    the one nearest to that of `data`.

    Args:
        model: the model.
        data: its coordinates, which receive the shape.
        bodies: indices of the bodies of the vessel, whose trees all have free joints.
        root: the root body that stays where it is.

    Raises:
        ModelError: no shape closes all of them.
    """
    bonds = [
        bond
        for bond in list_bonds(model)
        if np.isin(bond.bodies, bodies).all() and len(set(model.body_treeid[list(bond.bodies)])) > 1
    ]
    roots = [other for other in list_roots(model, bodies) if other != root]
    if not roots:
        return Joining(0, 0.0, root)
    dofs = np.concatenate([model.body_dofadr[other] + np.arange(6) for other in roots])
    before = _locate(model, data, root, roots)

    # close the gaps, by short turns where they are wide
    for _ in range(_MOST_STEPS):
        gaps, jacobian = _linearize(model, data, bonds, dofs)
        step = np.linalg.lstsq(jacobian, -gaps, rcond=1e-9)[0]
        turn = np.abs(step.reshape(-1, 6)[:, 3:]).max()
        step *= min(1.0, _LONGEST_STEP / turn) if turn > 0.0 else 1.0
        velocity = np.zeros(model.nv)
        velocity[dofs] = step
        mujoco.mj_integratePos(model, data.qpos, velocity, 1.0)
        if np.abs(step).max() < 1e-13:
            break
    gaps, jacobian = _linearize(model, data, bonds, dofs)
    _check_gaps(model, data, bonds, gaps, bodies)

    # what it took
    moved = np.linalg.norm(_locate(model, data, root, roots) - before, axis=1)
    freedoms = len(dofs) - int(np.linalg.matrix_rank(jacobian, tol=1e-9))
    return Joining(freedoms, float(moved.max()), roots[int(moved.argmax())])


def locate_trees(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64], root: int
) -> tuple[JoinedTree, ...]:
    """The trees of a vessel, from the poses of `data`, in the frame of its root body."""
    root_from_world = data.xmat[root].reshape(3, 3).T
    return tuple(
        JoinedTree(
            other,
            root_from_world @ (data.xpos[other] - data.xpos[root]),
            root_from_world @ data.xmat[other].reshape(3, 3),
        )
        for other in list_roots(model, bodies)
    )


def _locate(
    model: mujoco.MjModel, data: mujoco.MjData, root: int, others: Sequence[int]
) -> NDArray[np.float64]:
    """Origins of bodies in the frame of the root body (n, 3) [m]."""
    mujoco.mj_kinematics(model, data)
    return np.asarray((data.xpos[others] - data.xpos[root]) @ data.xmat[root].reshape(3, 3), float)


def _linearize(
    model: mujoco.MjModel, data: mujoco.MjData, bonds: Sequence[Bond], dofs: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Gaps of bonds (m,) as MuJoCo measures them, and their slopes along some velocities (m, d)."""
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    mujoco.mj_makeConstraint(model, data)
    rows = np.flatnonzero(
        (data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY)
        & np.isin(data.efc_id, [bond.equality for bond in bonds])
    )
    if mujoco.mj_isSparse(model):
        dense = np.zeros((data.nefc, model.nv))
        mujoco.mju_sparse2dense(
            dense, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind
        )
    else:
        dense = data.efc_J.reshape(data.nefc, model.nv)
    return data.efc_pos[rows].copy(), dense[np.ix_(rows, dofs)]


def _check_gaps(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    bonds: Sequence[Bond],
    gaps: NDArray[np.float64],
    bodies: NDArray[np.int64],
) -> None:
    """Refuse welds and connects that no shape closes."""
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, bodies))
    centre = data.geom_xpos[geoms].mean(axis=0)
    size = np.linalg.norm(data.geom_xpos[geoms] - centre, axis=1) + model.geom_rbound[geoms]
    worst = float(np.abs(gaps).max(initial=0.0))
    if worst > _FITS * float(size.max()):
        names = " and ".join(dict.fromkeys(describe_bond(model, bond) for bond in bonds))
        raise ModelError(
            f"{names} contradict each other or the pose from which they start: {worst:.3g} m or "
            "rad are left between the bodies; correct relpose or anchor, or draw the bodies where "
            "they belong"
        )

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
_SHORTEST_STEP = 1e-13
"""Step at which the shape is found [m, rad]."""
_INDEPENDENT = 1e-9
"""Slope of a gap, over the steepest, below which no motion of the trees changes it."""
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


class Move(NamedTuple):
    """How far a tree moved."""

    root: int
    """Index of its root body."""
    distance: float
    """How far its origin went [m]."""
    angle: float
    """How far it turned [rad]."""


class Joining(NamedTuple):
    """What bringing trees into one shape led to."""

    freedoms: int
    """Number of ways in which the trees still move against each other."""
    moves: tuple[Move, ...]
    """How each tree moved against the vessel's root."""


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
    bonds = _list_bonds_among(model, bodies, across=True)
    roots = [other for other in list_roots(model, bodies) if other != root]
    if not roots:
        return Joining(0, ())
    dofs = np.concatenate([model.body_dofadr[other] + np.arange(6) for other in roots])
    mujoco.mj_kinematics(model, data)
    before = locate_trees(model, data, bodies, root)

    # the shape, unless there is none
    _close_gaps(model, data, bonds, dofs)
    gaps, jacobian = _linearize(model, data, bonds, dofs)
    worst = float(np.abs(gaps).max(initial=0.0))
    if worst > _FITS * _measure_size(model, data, bodies):
        names = " and ".join(dict.fromkeys(describe_bond(model, bond) for bond in bonds))
        raise ModelError(
            f"no place of the bodies fits {names}: {worst:.3g} m or rad are left between them; "
            "correct relpose or anchor, or draw the bodies nearer to where they belong"
        )

    # what it took
    after = locate_trees(model, data, bodies, root)
    freedoms = len(dofs) - int(np.linalg.matrix_rank(jacobian, rtol=_INDEPENDENT))
    return Joining(freedoms, tuple(_compare(*pair) for pair in zip(before, after, strict=True)))


def find_open_bond(
    model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64]
) -> tuple[Bond, float] | None:
    """A weld or a connect within a kinematic tree that is open at its joint angles, and its gap.

    Statics hold the joints as they are, and so do not close it.

    Args:
        model: the model.
        data: its coordinates.
        bodies: indices of the bodies of the vessel.
    """
    for bond in _list_bonds_among(model, bodies, across=False):
        gaps, _ = _linearize(model, data, [bond], np.empty(0, np.int64))
        gap = float(np.abs(gaps).max(initial=0.0))
        if gap > _FITS * _measure_size(model, data, bodies):
            return bond, gap
    return None


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


def _close_gaps(
    model: mujoco.MjModel, data: mujoco.MjData, bonds: Sequence[Bond], dofs: NDArray[np.int64]
) -> None:
    """Move free joints, by short turns where gaps are wide, until bonds gain no more by it."""
    for _ in range(_MOST_STEPS):
        gaps, jacobian = _linearize(model, data, bonds, dofs)
        step = np.linalg.lstsq(jacobian, -gaps, rcond=_INDEPENDENT)[0]
        turn = float(np.abs(step.reshape(-1, 6)[:, 3:]).max())
        step *= _LONGEST_STEP / max(turn, _LONGEST_STEP)

        velocity = np.zeros(model.nv)
        velocity[dofs] = step
        mujoco.mj_integratePos(model, data.qpos, velocity, 1.0)
        if np.abs(step).max() < _SHORTEST_STEP:
            return


def _compare(before: JoinedTree, after: JoinedTree) -> Move:
    """How far a tree moved against the vessel's root."""
    from scipy.spatial.transform import Rotation

    distance = float(np.linalg.norm(after.position - before.position))
    turn = Rotation.from_matrix(after.rotation @ before.rotation.T)
    return Move(after.root, distance, float(turn.magnitude()))


def _list_bonds_among(
    model: mujoco.MjModel, bodies: NDArray[np.int64], *, across: bool
) -> list[Bond]:
    """Welds and connects among bodies: those between different trees, or those within one."""
    among = [bond for bond in list_bonds(model) if np.isin(bond.bodies, bodies).all()]
    trees = [set(model.body_treeid[list(bond.bodies)].tolist()) for bond in among]
    return [bond for bond, of in zip(among, trees, strict=True) if (len(of) > 1) == across]


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


def _measure_size(model: mujoco.MjModel, data: mujoco.MjData, bodies: NDArray[np.int64]) -> float:
    """Distance of the farthest point of the geoms of bodies from the middle of all [m]."""
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, bodies))
    arms = data.geom_xpos[geoms] - data.geom_xpos[geoms].mean(axis=0)
    return float((np.linalg.norm(arms, axis=1) + model.geom_rbound[geoms]).max())

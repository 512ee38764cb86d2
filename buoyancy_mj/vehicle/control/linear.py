"""`linearise`: how a vehicle moves about its rest, step by step, as the engine has it."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError
from buoyancy_mj.vehicle.allocation import allocate_craft
from buoyancy_mj.vehicle.control.controller import Outset, copy_data

EPSILON = 1e-6
"""Step of the finite differences, in coordinates [m, rad] and velocities [m/s, rad/s]."""
SHARE = 1e-3
"""Greatest part of the weight that may be missing for rest."""
_SETTLING = 2000
"""Most steps in which the states of actuators settle."""
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class LinearMotion(NamedTuple):
    """x' = A x + B f over one timestep, about a rest."""

    a: NDArray[np.float64]
    """Matrix A (2n, 2n), of coordinates in the tangent space, then velocities, n of each."""
    b: NDArray[np.float64]
    """Matrix B (2n, m), of thrusts [N]."""
    thrusts: NDArray[np.float64]
    """Thrusts at rest (m,) [N]."""
    qpos: NDArray[np.float64]
    """Coordinates of the whole model at rest (nq,)."""
    dofs: NDArray[np.int64]
    """Degrees of freedom of the vehicle (n,)."""


def linearise(outset: Outset) -> LinearMotion:
    """Linearise the motion of a vehicle about rest where its data put it.

    A is that of MuJoCo's `mjd_transitionFD`, in whose steps the water acts with its added mass. B
    goes by thrust, and not by control: thrusters by throttle have no slope at 0. What rotors add
    as states of their own is left out.

    Args:
        outset: the vehicle; its data say where, and are changed.

    Raises:
        ControlError: the integrator is RK4, which MuJoCo does not differentiate; or the thrusters
            cannot hold the vehicle there.
    """
    model, data = outset.model, outset.data
    if model.opt.integrator == mujoco.mjtIntegrator.mjINT_RK4:
        raise ControlError(
            "the integrator is rk4, which MuJoCo does not differentiate; an lqr needs another, as "
            "implicitfast"
        )
    data.qvel[:] = 0.0
    dofs = np.flatnonzero(np.isin(model.dof_bodyid, outset.craft.bodies))
    thrusts = _balance(outset, dofs)

    # the engine's own derivative, of the vehicle alone
    size = 2 * model.nv + model.na
    matrix = np.zeros((size, size))
    mujoco.mjd_transitionFD(model, data, EPSILON, True, matrix, None, None, None)
    rows = np.concatenate([dofs, model.nv + dofs])
    return LinearMotion(
        a=matrix[np.ix_(rows, rows)],
        b=_differentiate_thrusts(outset, dofs),
        thrusts=thrusts,
        qpos=data.qpos.copy(),
        dofs=dofs,
    )


def _balance(outset: Outset, dofs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Find the thrusts (m,) [N] that hold a vehicle at rest, and set them."""
    model, data, craft = outset.model, outset.data, outset.craft
    data.ctrl[[drive.control for drive in craft.drives]] = 0.0
    states = _find_states(outset)
    data.act[states] = 0.0
    mujoco.mj_forward(model, data)

    # what pulls, as generalized force, by least squares over the thrusts
    pull = data.qfrc_bias - data.qfrc_passive - data.qfrc_actuator
    pushes = _find_pushes(outset)
    allocation = allocate_craft(model, craft, data.qpos)
    thrusts = np.linalg.pinv(pushes, rcond=1e-9) @ pull[dofs]
    missing = np.abs(pushes @ thrusts - pull[dofs]).max(initial=0.0)
    weight = float(model.body_mass[craft.bodies].sum() * np.linalg.norm(model.opt.gravity))
    if missing > SHARE * weight:
        raise ControlError(
            f"the thrusters of '{craft.name}' cannot hold it where it starts: a force or torque of "
            f"{missing:.3g} N or N m is left, so there is no rest; choose another depth or attitude"
        )
    if (thrusts < allocation.least).any() or (thrusts > allocation.most).any():
        i = int(np.argmax(np.maximum(allocation.least - thrusts, thrusts - allocation.most)))
        raise ControlError(
            f"the thrusters of '{craft.name}' cannot hold it where it starts: "
            f"'{allocation.names[i]}' would have to push with {thrusts[i]:.3g} N, and has "
            f"{allocation.least[i]:.3g} to {allocation.most[i]:.3g} N"
        )
    allocation.write(data, thrusts)
    _settle(model, data, states)
    return np.asarray(thrusts)


def _find_states(outset: Outset) -> NDArray[np.int64]:
    """Indices of the states of the drives in `data.act`; tanks keep what they hold."""
    model = outset.model
    ranges = [
        np.arange(model.actuator_actnum[drive.actuator]) + model.actuator_actadr[drive.actuator]
        for drive in outset.craft.drives
    ]
    return np.concatenate([np.zeros(0, np.int64), *ranges]).astype(np.int64)


def _settle(model: mujoco.MjModel, data: mujoco.MjData, states: NDArray[np.int64]) -> None:
    """Let states of actuators come to rest under their controls, the vehicle held."""
    for _ in range(_SETTLING if len(states) else 1):
        mujoco.mj_forward(model, data)
        change = model.opt.timestep * data.act_dot[states]
        data.act[states] += change
        if np.abs(change).max(initial=0.0) < 1e-9:
            break


def _find_pushes(outset: Outset) -> NDArray[np.float64]:
    """Generalized force (n, m) on the vehicle per newton of each thrust."""
    model, data = outset.model, outset.data
    dofs = np.flatnonzero(np.isin(model.dof_bodyid, outset.craft.bodies))
    pushes = []
    for drive in outset.craft.drives:
        moving, turning = np.zeros((2, 3, model.nv))
        mujoco.mj_jacSite(model, data, moving, turning, drive.site)
        site = data.site_xmat[drive.site].reshape(3, 3)
        force, torque = site @ drive.wrench[:3], site @ drive.wrench[3:]
        pushes.append((moving.T @ force + turning.T @ torque)[dofs])
    return np.array(pushes).reshape(-1, len(dofs)).T


def _differentiate_thrusts(outset: Outset, dofs: NDArray[np.int64]) -> NDArray[np.float64]:
    """Change of the state (2n, m) in one step per newton of each thrust, by steps of the engine."""
    model, data = outset.model, outset.data
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    stepped = copy_data(model, data)
    columns = []
    for push in _find_pushes(outset).T:
        ends = []
        for sign in (1.0, -1.0):
            mujoco.mj_setState(model, stepped, state, _STATE)
            stepped.qfrc_applied[dofs] += sign * push
            mujoco.mj_step(model, stepped)
            ends.append((stepped.qpos.copy(), stepped.qvel.copy()))
        (ahead, faster), (behind, slower) = ends
        moved = np.zeros(model.nv)
        mujoco.mj_differentiatePos(model, moved, 2.0, behind, ahead)
        columns.append(np.concatenate([moved[dofs], 0.5 * (faster - slower)[dofs]]))
    return np.array(columns).reshape(-1, 2 * len(dofs)).T

"""`Lqr`: linear feedback of the whole state, the best for weights of errors and thrusts."""

import dataclasses
import math
from typing import ClassVar

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ControlError, choices, describe
from buoyancy_mj.values import read_array, set_number
from buoyancy_mj.vehicle.allocation import allocate_craft
from buoyancy_mj.vehicle.control.controller import Control, Outset, count_steps
from buoyancy_mj.vehicle.control.linear import LinearMotion, linearise
from buoyancy_mj.vehicle.control.motion import FreeJoint, find_free_joint
from buoyancy_mj.vehicle.control.regulator import (
    add_lags,
    find_unreached,
    hold_inputs,
    solve_regulator,
)

FREE = {"position": (0, 1), "depth": (2,), "heading": (5,)}
"""What may be left free, and the degrees of freedom of a free joint that go with it."""
STIFF = 1e-6
"""Change of velocity in a step per metre or radian [1/s] below which nothing holds a coordinate."""
_AXES = ("x", "y", "z", "roll", "pitch", "yaw")
_WEIGHTS = ("position_weights", "attitude_weights", "velocity_weights", "spin_weights")


@dataclasses.dataclass(frozen=True, kw_only=True)
class Lqr(Control):
    """Bring a vehicle back to rest by linear feedback that costs least, level and in still water.

    The cost is the sum over all updates of the squares of errors and of thrusts, each by its
    weight. A weight of one over the square of the largest error that is acceptable is a good first
    choice (Bryson's rule). The motion is linearised about the rest by MuJoCo's own derivatives,
    with water and added mass; the lag of thrusters is in it too. The feedback knows no integral:
    what pushes steadily beside the weight and the buoyancy leaves an error. A. E. Bryson and Y.-C.
    Ho, Applied Optimal Control (1975), chapter 5.

    Raises:
        ControlError: a value that makes no sense.
    """

    needs_rest: ClassVar[bool] = True
    """It asks what the water does at rest when it starts."""

    position: tuple[float, float] | None = None
    """Place of rest of the root body's origin (2,) [m], world frame; None for that of the start."""
    depth: float | None = None
    """Depth of rest of the root body's origin below the still surface [m]; None for that of the
    start."""
    heading: float | None = None
    """Heading of rest [rad]; None for that of the start."""
    free: tuple[str, ...] = ()
    """What is left as it comes, in which a still sea is the same everywhere: 'position', 'depth',
    'heading'."""
    position_weights: tuple[float, float, float] = (100.0, 100.0, 100.0)
    """Weights of x, y and z (3,) [1/m^2]."""
    attitude_weights: tuple[float, float, float] = (100.0, 100.0, 100.0)
    """Weights of roll, pitch and yaw (3,) [1/rad^2]."""
    velocity_weights: tuple[float, float, float] = (10.0, 10.0, 10.0)
    """Weights of the velocity along x, y and z (3,) [s^2/m^2]."""
    spin_weights: tuple[float, float, float] = (10.0, 10.0, 10.0)
    """Weights of the angular velocity about the body's x, y and z (3,) [s^2/rad^2]."""
    thrust_weight: float = 0.01
    """Weight of each thrust [1/N^2]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.rate is None:
            raise ControlError("rate is None; an lqr needs one, as 50.0")
        if self.position is not None:
            position = read_array(ControlError, "position", self.position, (2,))
            object.__setattr__(self, "position", tuple(position.tolist()))
        for name in ("depth", "heading"):
            if getattr(self, name) is not None:
                set_number(self, ControlError, name)
        for name in self.free:
            if name not in FREE:
                raise ControlError(f"free holds {describe(name)}; {choices(name, FREE)}")
            if getattr(self, name) is not None:
                raise ControlError(f"free holds '{name}', which is given; leave one of the two out")
        for name in _WEIGHTS:
            weights = read_array(ControlError, name, getattr(self, name), (3,))
            if weights.min() < 0.0:
                raise ControlError(f"{name} holds {weights.min():g}; weights must not be negative")
            object.__setattr__(self, name, tuple(weights.tolist()))
        set_number(self, ControlError, "thrust_weight", above=0.0)

    @property
    def title(self) -> str:
        """What messages call it."""
        return "lqr"

    def start(self, outset: Outset) -> "LqrController":
        """Linearise, and find the feedback."""
        return LqrController(self, outset)


class LqrController:
    """Feedback for one vehicle.

    Args:
        lqr: the settings.
        outset: the vehicle, in still water.

    Raises:
        ControlError: the vehicle has no free joint or no rest there, or its thrusters do not reach
            a motion that does not come to rest by itself.
    """

    def __init__(self, lqr: Lqr, outset: Outset) -> None:
        self._joint = find_free_joint(outset.model, outset.craft)
        _place(lqr, outset, self._joint)
        self.motion: LinearMotion = linearise(outset)
        """The motion about the rest, step by step."""
        self._free = lqr.free
        count = len(self.motion.dofs)

        # coordinates that are left as they come are none of the state
        left = [dof for name in lqr.free for dof in FREE[name]]
        self._kept = np.array([i for i in range(2 * count) if i not in left])
        _check_free(lqr, self.motion, left)

        # the motion from one update to the next, with what rotors lag behind
        self.steps = count_steps(lqr, float(outset.model.opt.timestep))
        """Number of steps from one update to the next."""
        kept = self._kept
        a, b = self.motion.a[np.ix_(kept, kept)], self.motion.b[kept]
        drives, timestep = outset.craft.drives, float(outset.model.opt.timestep)
        lags = np.array([drive.lag.keep(timestep) if drive.lag else 0.0 for drive in drives])
        a, b = hold_inputs(*add_lags(a, b, lags), self.steps)
        self._lagging = np.flatnonzero(lags)
        _check_reach(a, b, kept, count, outset)

        # the feedback
        weights = np.zeros(len(a))
        weights[: len(kept)] = self._list_weights(lqr, count)[kept]
        found = solve_regulator(a, b, weights, np.full(len(drives), lqr.thrust_weight))
        self.gain = found.gain
        """Thrusts per error of the state (m, k) [N], see `measure`."""
        self.poles = found.poles
        """Eigenvalues of the closed loop (k,), from one update to the next."""
        self.allocation = allocate_craft(outset.model, outset.craft, self.motion.qpos)
        """The thrusters."""

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData) -> None:
        """Write the controls of the thrusters."""
        thrusts = self.motion.thrusts - self.gain @ self.measure(model, data)
        self.allocation.write(data, thrusts)

    def measure(self, model: mujoco.MjModel, data: mujoco.MjData) -> NDArray[np.float64]:
        """Error of the state (k,): coordinates that are not free, velocities, thrusts that lag.

        A vehicle that has turned, where its heading is free, is seen as if it had not: still water
        is the same in all directions.
        """
        from scipy.spatial.transform import Rotation

        qpos, qvel = data.qpos.copy(), data.qvel.copy()
        joint = self._joint
        if "heading" in self._free:
            turn = Rotation.from_euler("z", self._heading_of(self.motion.qpos, qpos))
            place = slice(joint.qpos, joint.qpos + 3)
            rest = self.motion.qpos[place]
            qpos[place] = rest + turn.apply(qpos[place] - rest)
            attitude = slice(joint.qpos + 3, joint.qpos + 7)
            turned = turn * Rotation.from_quat(qpos[attitude], scalar_first=True)
            qpos[attitude] = turned.as_quat(scalar_first=True)
            moving = slice(joint.dof, joint.dof + 3)
            qvel[moving] = turn.apply(qvel[moving])
        error = np.zeros(model.nv)
        mujoco.mj_differentiatePos(model, error, 1.0, self.motion.qpos, qpos)
        dofs = self.motion.dofs
        whole = np.concatenate([error[dofs], qvel[dofs]])
        drives, balance = self.allocation.drives, self.motion.thrusts
        thrusts = [drives[i].follow(data) - balance[i] for i in self._lagging]
        return np.concatenate([whole[self._kept], thrusts])

    def _heading_of(self, rest: NDArray[np.float64], now: NDArray[np.float64]) -> float:
        """The turn about the vertical [rad] from the heading now to that of the rest."""
        headings = []
        for qpos in (rest, now):
            w, x, y, z = qpos[self._joint.qpos + 3 :][:4]
            headings.append(math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))
        return headings[0] - headings[1]

    def _list_weights(self, lqr: Lqr, count: int) -> NDArray[np.float64]:
        """Weights of the whole state (2n,); joints beside the free one have none."""
        weights = np.zeros(2 * count)
        start = int(np.searchsorted(self.motion.dofs, self._joint.dof))
        weights[start : start + 6] = (*lqr.position_weights, *lqr.attitude_weights)
        weights[count + start : count + start + 6] = (*lqr.velocity_weights, *lqr.spin_weights)
        return weights


def _place(lqr: Lqr, outset: Outset, joint: FreeJoint) -> None:
    """Put the data where the rest is to be: level."""
    from scipy.spatial.transform import Rotation

    data = outset.data
    motion = joint.read(data)
    place = slice(joint.qpos, joint.qpos + 3)
    x, y, z = data.qpos[place]
    if lqr.position is not None:
        x, y = lqr.position
    if lqr.depth is not None:
        z = outset.level - lqr.depth
    heading = motion.heading if lqr.heading is None else lqr.heading
    data.qpos[place] = x, y, z
    level = Rotation.from_euler("z", heading).as_quat(scalar_first=True)
    data.qpos[joint.qpos + 3 : joint.qpos + 7] = level


def _check_free(lqr: Lqr, motion: LinearMotion, left: list[int]) -> None:
    """Refuse to leave free what the motion depends on."""
    count = len(motion.dofs)
    for name in lqr.free:
        pull = np.abs(motion.a[count:, list(FREE[name])]).max()
        others = [i for i in range(count) if i not in left]
        moved = np.abs(motion.a[np.ix_(others, list(FREE[name]))]).max(initial=0.0)
        if max(pull, moved) > STIFF:
            raise ControlError(
                f"free holds '{name}', and the motion depends on it ({pull:.2g} per second and "
                "step): something holds the vehicle there; leave it out of free"
            )


def _check_reach(
    a: NDArray[np.float64],
    b: NDArray[np.float64],
    kept: NDArray[np.int64],
    count: int,
    outset: Outset,
) -> None:
    """Refuse motions that do not come to rest by themselves and that thrusters do not reach."""
    lost = find_unreached(a, b)
    if lost is None:
        return
    first = int(kept[lost]) % count
    axis = _AXES[first] if first < 6 else f"joint {first - 5}"
    raise ControlError(
        f"the thrusters of '{outset.craft.name}' do not reach its {axis}, which does not come to "
        "rest by itself; leave it free where that is possible, or add a thruster"
    )

"""`allocation`: which thrusts bring a force and a torque on the whole vehicle."""

import dataclasses
import functools
from collections.abc import Sequence

import mujoco
import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.errors import ModelError
from buoyancy_mj.values import read_array
from buoyancy_mj.vehicle.crafts import Craft, find_centre, find_craft
from buoyancy_mj.vehicle.drives import Curve, Drive

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
"""Axes of a wrench in the frame of a vehicle: forces along x, y, z, then torques about them."""
_FLAT = 1e-9
"""Share of the greatest singular value, or of the greatest reach, below which there is none."""
_STEADY = 1e-4
"""Weight of small thrusts against a wrench that is missed, so that one answer is the best."""
_UNBOUNDED = 3
"""Status of `scipy.optimize.linprog` where there is no greatest value."""


@dataclasses.dataclass(frozen=True, eq=False)
class Allocation:
    """The thrusters of a vehicle, and the wrenches that they bring.

    A wrench is a force [N] and a torque [N m] about the vehicle's centre of gravity, in the frame
    of its root body. Thrusts are in the order of `names`.

    Example:
        >>> thrusts = allocation(model).allocate([10.0, 0.0, 0.0, 0.0, 0.0, 2.0])
    """

    drives: tuple[Drive, ...]
    """What pushes (n)."""
    root: int
    """Index of the vehicle's root body."""
    centre: NDArray[np.float64]
    """Centre of gravity (3,) [m], frame of the root body."""
    matrix: NDArray[np.float64]
    """Wrench (6, n) [1, m] per newton of each thrust."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the actuators (n)."""
        return tuple(drive.name for drive in self.drives)

    @functools.cached_property
    def least(self) -> NDArray[np.float64]:
        """Least thrusts (n,) [N]."""
        return np.array([drive.least for drive in self.drives])

    @functools.cached_property
    def most(self) -> NDArray[np.float64]:
        """Greatest thrusts (n,) [N]."""
        return np.array([drive.most for drive in self.drives])

    @functools.cached_property
    def inverse(self) -> NDArray[np.float64]:
        """The pseudo-inverse of the matrix (n, 6): the smallest thrusts that bring a wrench."""
        return np.asarray(np.linalg.pinv(self.matrix, rcond=_FLAT))

    @functools.cached_property
    def rank(self) -> int:
        """Number of independent wrenches, 6 where every wrench has its thrusts."""
        return int(np.linalg.matrix_rank(self.matrix, tol=_FLAT * self._scale))

    @functools.cached_property
    def reach(self) -> NDArray[np.float64]:
        """The most that can be had along each axis alone, the other five zero (6, 2) [N, N m].

        The first column is negative, the second positive. Without limits it is infinite.
        """
        return np.array([[-self._reach(axis, -1.0), self._reach(axis, 1.0)] for axis in range(6)])

    @functools.cached_property
    def unreachable(self) -> tuple[str, ...]:
        """Names of the axes along which nothing can be had alone, in either direction."""
        least = _FLAT * max(1.0, float(np.abs(self.reach[np.isfinite(self.reach)]).max(initial=0)))
        return tuple(
            axis
            for axis, reach in zip(AXES, self.reach, strict=True)
            if np.abs(reach).max() <= least
        )

    def allocate(self, wrench: ArrayLike, weights: ArrayLike | None = None) -> NDArray[np.float64]:
        """The thrusts within their limits that come nearest to a wrench, in least squares.

        Where several bring it, they are the smallest.

        Args:
            wrench: force and torque (6,) [N, N m].
            weights: how much a miss along each axis counts (6,) [1/N, 1/(N m)]; 1 each by default.

        Returns:
            Thrusts (n,) [N].

        Raises:
            ModelError: a value that is no finite number, or a weight that is negative.
        """
        wanted = read_array(ModelError, "wrench", wrench, (6,))
        matrix, inverse = self.matrix, self.inverse
        if weights is not None:
            scale = read_array(ModelError, "weights", weights, (6,))
            if scale.min() < 0.0:
                raise ModelError(f"weights hold {scale.min():g}; they must not be negative")
            wanted, matrix = scale * wanted, scale[:, None] * matrix
            inverse = np.asarray(np.linalg.pinv(matrix, rcond=_FLAT))

        # mostly the limits do not matter
        thrusts: NDArray[np.float64] = inverse @ wanted
        if (thrusts >= self.least).all() and (thrusts <= self.most).all():
            return thrusts
        small = _STEADY * np.eye(len(self.drives))
        found = scipy.optimize.lsq_linear(
            np.vstack([matrix, small]),
            np.append(wanted, np.zeros(len(self.drives))),
            (self.least, self.most),
            method="bvls",
        )
        return np.asarray(np.clip(found.x, self.least, self.most))

    def commands(self, thrusts: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """Controls (n,) that bring steady thrusts (n,) [N] in still water, within the limits."""
        wanted = np.clip(thrusts, self.least, self.most)
        commands = np.empty(len(self.drives))
        for curve, alike in self._alike.items():
            commands[alike] = curve.command(wanted[alike])
        return commands

    def write(self, data: mujoco.MjData, thrusts: Sequence[float] | NDArray[np.float64]) -> None:
        """Write the controls that bring thrusts (n,) [N] into `data.ctrl`."""
        data.ctrl[self._controls] = self.commands(thrusts)

    @functools.cached_property
    def _controls(self) -> list[int]:
        """Where the controls stand in `data.ctrl`."""
        return [drive.control for drive in self.drives]

    @functools.cached_property
    def _alike(self) -> dict[Curve, list[int]]:
        """The drives of each curve."""
        groups: dict[Curve, list[int]] = {}
        for i, drive in enumerate(self.drives):
            groups.setdefault(drive.curve, []).append(i)
        return groups

    @property
    def _scale(self) -> float:
        """The greatest singular value of the matrix."""
        return float(np.linalg.norm(self.matrix, 2)) if self.drives else 0.0

    def _reach(self, axis: int, sign: float) -> float:
        """The most that can be had along an axis alone, in the direction of a sign."""
        # unknowns are the thrusts, and how much comes of them
        count = len(self.drives)
        found = scipy.optimize.linprog(
            np.append(np.zeros(count), -1.0),
            A_eq=np.column_stack([self.matrix, -sign * np.eye(6)[axis]]),
            b_eq=np.zeros(6),
            bounds=[*zip(self.least, self.most, strict=True), (0.0, None)],
        )
        if found.status == _UNBOUNDED:
            return np.inf
        # thrusts that cannot all be zero at once may bring nothing alone
        return float(found.x[-1]) if found.success else 0.0


def allocation(
    model: mujoco.MjModel, data: mujoco.MjData | None = None, body: str | int | None = None
) -> Allocation:
    """Find which thrusts bring a force and a torque on a vehicle.

    The matrix has a column for each actuator that pushes at a site: motors, generals whose force
    goes with their control, and thrusters of this package. T. I. Fossen, Handbook of Marine Craft
    Hydrodynamics and Motion Control (2011), section 12.3.

    Args:
        model: the model.
        data: where the joints of the vehicle stand; None for the model's own pose.
        body: name or index of any body of the vehicle; None for the only one.

    Raises:
        ModelError: there is no such vehicle, nothing pushes it at a site, or the thrust of an
            actuator does not follow from its control.
    """
    craft = find_craft(model, body)
    if not craft.drives:
        raise ModelError(
            f"no actuator pushes '{craft.name}' at a site; give it motors or thrusters at sites"
        )
    return allocate_craft(model, craft, None if data is None else data.qpos)


def allocate_craft(
    model: mujoco.MjModel, craft: Craft, qpos: NDArray[np.float64] | None = None
) -> Allocation:
    """The allocation of a vehicle, in the model's own pose or where coordinates put it."""
    with raise_causes():
        data = mujoco.MjData(model)
        if qpos is not None:
            data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
    centre = find_centre(model, data, craft)
    turn = data.xmat[craft.root].reshape(3, 3).T

    # each unit of thrust, about the centre of gravity
    columns = []
    for drive in craft.drives:
        site = data.site_xmat[drive.site].reshape(3, 3)
        force, torque = site @ drive.wrench[:3], site @ drive.wrench[3:]
        torque = torque + np.cross(data.site_xpos[drive.site] - centre, force)
        columns.append(np.concatenate([turn @ force, turn @ torque]))
    return Allocation(
        drives=craft.drives,
        root=craft.root,
        centre=turn @ (centre - data.xpos[craft.root]),
        matrix=np.array(columns).reshape(-1, 6).T,
    )

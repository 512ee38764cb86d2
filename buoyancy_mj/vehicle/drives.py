"""`Drive`: an actuator that pushes at a site, and the control that brings a thrust."""

import dataclasses
import math
from typing import Protocol

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.engine.device_kinds import kind_of
from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.ballasts import PLUGIN as BALLAST
from buoyancy_mj.vehicle.thrusters.adding import find_thruster
from buoyancy_mj.vehicle.thrusters.thruster import Thruster

_STEADY = (
    int(mujoco.mjtDyn.mjDYN_NONE),
    int(mujoco.mjtDyn.mjDYN_FILTER),
    int(mujoco.mjtDyn.mjDYN_FILTEREXACT),
)
"""Dynamics that end where the control is."""
_GAINS = (int(mujoco.mjtGain.mjGAIN_FIXED), int(mujoco.mjtGain.mjGAIN_AFFINE))
_BIASES = (int(mujoco.mjtBias.mjBIAS_NONE), int(mujoco.mjtBias.mjBIAS_AFFINE))
_AFFINE = int(mujoco.mjtBias.mjBIAS_AFFINE)


class Curve(Protocol):
    """What lies between a control and a steady thrust in water at rest; equal ones are alike."""

    def limits(self) -> tuple[float, float]:
        """Least and most thrust [N]."""

    def command(self, thrust: ArrayLike, /) -> NDArray[np.float64]:
        """Controls that bring thrusts [N] within the limits, of any shape."""

    def thrust(self, command: ArrayLike, /) -> NDArray[np.float64]:
        """Thrusts [N] that controls bring, of any shape."""


@dataclasses.dataclass(frozen=True)
class Motor:
    """MuJoCo's own actuator, whose thrust is a straight line over its control."""

    gain: float
    """Thrust per unit of control [N]."""
    bias: float
    """Thrust at control 0 [N]."""
    least: float
    """Least thrust [N]."""
    most: float
    """Most thrust [N]."""

    def limits(self) -> tuple[float, float]:
        """Least and most thrust [N]."""
        return self.least, self.most

    def command(self, thrust: ArrayLike, /) -> NDArray[np.float64]:
        """Controls that bring thrusts [N] of any shape."""
        return np.asarray((np.asarray(thrust, float) - self.bias) / self.gain)

    def thrust(self, command: ArrayLike, /) -> NDArray[np.float64]:
        """Thrusts [N] of controls of any shape."""
        return np.asarray(self.gain * np.asarray(command, float) + self.bias)


@dataclasses.dataclass(frozen=True)
class Lag:
    """How a drive follows its control: a state in `data.act` closes the gap by and by."""

    state: int
    """Index of the state in `data.act`."""
    time: float
    """Time in which the gap falls to 1/e [s]."""
    is_exact: bool = True
    """Whether a step closes as much as an exponential does, and not as a tangent."""

    def keep(self, timestep: float) -> float:
        """The part of the gap that is left after a timestep [s]."""
        x = timestep / self.time
        return math.exp(-x) if self.is_exact else 1.0 - x


@dataclasses.dataclass(frozen=True)
class Drive:
    """An actuator that pushes at a site.

    Its thrust is along its gear's force in the frame of the site, which is z for thrusters. The
    gear's torque goes with it: newton metres per newton, as the reaction of a propeller. A gear
    without force, as that of a reaction wheel, makes a thrust in newton metres.
    """

    name: str
    """Name of the actuator."""
    actuator: int
    """Index of the actuator."""
    control: int
    """Index of its control in `data.ctrl`."""
    site: int
    """Index of the site at which it pushes."""
    wrench: tuple[float, float, float, float, float, float]
    """Force and torque per newton of thrust (6,) [1, m], frame of the site."""
    curve: Curve
    """What lies between its control and its thrust."""
    lag: Lag | None = None
    """How it follows its control; None for at once."""

    @property
    def least(self) -> float:
        """Least thrust [N]; negative pushes backward, -inf has no limit."""
        return self.curve.limits()[0]

    @property
    def most(self) -> float:
        """Most thrust [N]."""
        return self.curve.limits()[1]

    def command(self, thrust: float) -> float:
        """The control that brings a steady thrust [N] in water at rest, within the limits."""
        least, most = self.curve.limits()
        return float(self.curve.command(min(max(thrust, least), most)))

    def follow(self, data: mujoco.MjData) -> float:
        """The steady thrust [N] of what a drive with a lag follows now."""
        if self.lag is None:
            return float(self.curve.thrust(data.ctrl[self.control]))
        state = float(data.act[self.lag.state])
        if not isinstance(self.curve, Thruster):
            return float(self.curve.thrust(state))
        if self.curve.inertia:
            return float(self.curve.curves.thrust_of(np.array(state / math.tau)))
        return float(self.curve.thrust(state + self.curve.neutral))


def find_pushing(model: mujoco.MjModel) -> list[int]:
    """Indices of the actuators that push or turn at a site: not ballast, which has a site too."""
    return [
        actuator
        for actuator in np.flatnonzero(model.actuator_trntype == mujoco.mjtTrn.mjTRN_SITE).tolist()
        if model.actuator_gear[model.actuator_outadr[actuator]].any()
        and not is_ballast(model, actuator)
    ]


def find_drives(model: mujoco.MjModel) -> tuple[Drive, ...]:
    """Find the actuators that push at a site, in the order of the model.

    Actuators of disabled groups and ballast do not push, and those between two sites push on
    neither alone.

    Raises:
        ModelError: the thrust of one does not follow from its control.
    """
    return tuple(
        _read_drive(model, actuator)
        for actuator in find_pushing(model)
        if model.actuator_trnid[actuator, 1] < 0 and not _is_disabled(model, actuator)
    )


def is_ballast(model: mujoco.MjModel, actuator: int) -> bool:
    """Whether an actuator is a bladder, a tank or a compartment."""
    kind = kind_of(model, int(model.actuator_plugin[actuator]))
    return kind is not None and kind.plugin == BALLAST


def _read_drive(model: mujoco.MjModel, actuator: int) -> Drive:
    """What a model says of an actuator at a site."""
    # a unit of thrust is along the gear
    gear = model.actuator_gear[model.actuator_outadr[actuator]]
    scale = float(np.linalg.norm(gear[:3]) or np.linalg.norm(gear[3:]))
    thruster = find_thruster(model, actuator)
    return Drive(
        name=str(model.actuator(actuator).name) or f"actuator {actuator}",
        actuator=actuator,
        control=int(model.actuator_ctrladr[actuator]),
        site=int(model.actuator_trnid[actuator, 0]),
        wrench=tuple((gear / scale).tolist()),
        curve=thruster or _read_motor(model, actuator, scale),
        lag=_find_lag(model, actuator, thruster),
    )


def _find_lag(model: mujoco.MjModel, actuator: int, thruster: Thruster | None) -> Lag | None:
    """How a thruster, or else a motor with a filter, follows its control."""
    state = int(model.actuator_actadr[actuator])
    if thruster is not None:
        return Lag(state, thruster.lag) if thruster.lag else None
    if state < 0:
        return None
    is_exact = model.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_FILTEREXACT
    return Lag(state, float(model.actuator_dynprm[actuator, 0]), bool(is_exact))


def _read_motor(model: mujoco.MjModel, actuator: int, scale: float) -> Motor:
    """The straight line of MuJoCo's own actuator; `scale` is thrust over its force."""
    kinds = (
        (model.actuator_dyntype, _STEADY, "dyntype"),
        (model.actuator_gaintype, _GAINS, "gaintype"),
        (model.actuator_biastype, _BIASES, "biastype"),
    )
    gain = scale * float(model.actuator_gainprm[actuator, 0])
    is_affine = model.actuator_biastype[actuator] == _AFFINE
    bias = scale * float(model.actuator_biasprm[actuator, 0]) if is_affine else 0.0
    odd = [key for values, known, key in kinds if values[actuator] not in known]
    has_plugin = model.actuator_plugin[actuator] >= 0
    if has_plugin or odd or gain == 0.0 or model.actuator_ctrlnum[actuator] != 1:
        why = f"its {' and '.join(odd)}" if odd else "its gain or number of controls"
        why = "its plugin" if has_plugin else why
        raise ModelError(
            f"the thrust of actuator '{model.actuator(actuator).name}' does not follow from its "
            f"control: {why} is not that of a motor or of a thruster; give it one of these, or put "
            "it into a group that is disabled"
        )

    # the narrower of both limits
    least, most = -math.inf, math.inf
    control = int(model.actuator_ctrladr[actuator])
    if model.actuator_ctrllimited[control]:
        ends = gain * model.actuator_ctrlrange[control] + bias
        least, most = float(ends.min()), float(ends.max())
    if model.actuator_forcelimited[actuator]:
        low, high = (scale * model.actuator_forcerange[actuator]).tolist()
        least, most = max(least, low), min(most, high)
    return Motor(gain, bias, least, most)


def _is_disabled(model: mujoco.MjModel, actuator: int) -> bool:
    """Whether an actuator is of a group that the model's options disable."""
    group = int(model.actuator_group[actuator])
    return 0 <= group <= 30 and bool(model.opt.disableactuator >> group & 1)

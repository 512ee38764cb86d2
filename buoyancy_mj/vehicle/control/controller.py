"""What a controller is: settings that start it, and a function that writes `data.ctrl`."""

import abc
import dataclasses
from pathlib import Path
from typing import ClassVar, NamedTuple, Protocol

import mujoco
import numpy as np

from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.engine.plugin import water_in
from buoyancy_mj.errors import ControlError, describe
from buoyancy_mj.values import set_number
from buoyancy_mj.vehicle.crafts import Craft, find_craft

FASTEST_RATE = 1e5
"""Most updates in a second [Hz]."""
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION


class Controller(Protocol):
    """Anything that steers: a function of a model and its data, called between steps."""

    def __call__(self, model: mujoco.MjModel, data: mujoco.MjData, /) -> None:
        """Write controls into `data.ctrl`, from the state in `data` or from its sensors."""


class Outset(NamedTuple):
    """What a controller knows when it starts."""

    model: mujoco.MjModel
    """The model, with its water in it or lent."""
    data: mujoco.MjData
    """Its state at the start, of which nobody else needs anything: mj_forward was called."""
    craft: Craft
    """The vehicle that it steers."""
    level: float = 0.0
    """Height of the still surface [m], world frame."""
    prefix: str = ""
    """What stands before all names of the vehicle's file in the model."""
    folder: Path = Path()
    """Where relative paths start."""


@dataclasses.dataclass(frozen=True, kw_only=True)
class Control(abc.ABC):
    """Settings of a controller.

    Raises:
        ControlError: a value that makes no sense.
    """

    needs_rest: ClassVar[bool] = False
    """Whether it asks what the water does at rest when it starts."""

    vehicle: str | None = None
    """Name of the vehicle that it steers; None for the only one."""
    rate: float | None = 50.0
    """Number of updates per simulated second [Hz], between which controls stay as they are."""

    def __post_init__(self) -> None:
        if self.rate is not None:
            set_number(self, ControlError, "rate", above=0.0, most=FASTEST_RATE)

    @property
    @abc.abstractmethod
    def title(self) -> str:
        """What messages call it."""

    def list_files(self, folder: Path) -> tuple[Path, ...]:  # noqa: ARG002
        """The files that it reads when it starts; relative paths start at a folder."""
        return ()

    @abc.abstractmethod
    def start(self, outset: Outset) -> Controller:
        """Start the controller.

        Raises:
            ControlError: it cannot act on this vehicle.
        """


def start_controller(
    control: Control,
    model: mujoco.MjModel,
    data: mujoco.MjData,
    *,
    body: str | int | None = None,
    level: float | None = None,
) -> Controller:
    """Start a controller in a loop of your own.

    What the model's water does at the state of the data is what the controller takes for its rest:
    start it in still water, or where waves are small.

    Args:
        control: what to start, as `Hold(depth=0.8)`.
        model: the model, with its water in it, or `installed`.
        data: the state at the start; it stays as it is.
        body: name or index of any body of the vehicle; None for the only one.
        level: height of the still surface [m]; None for that of the water in the model, or 0.

    Returns:
        A function `update(model, data)`. Call it before each step, or at the rate of the control.

    Raises:
        ModelError: there is no such vehicle.
        ControlError: the controller cannot act on it.

    Example:
        >>> update = start_controller(Hold(depth=0.8, heading=0.0), model, data)
        >>> while data.time < 5.0:
        ...     update(model, data)
        ...     mujoco.mj_step(model, data)
    """
    if not isinstance(control, Control):
        raise ControlError(
            f"control is {describe(control)}; it must be a Hold, Lqr, Keyframes or Program"
        )
    craft = find_craft(model, body)
    if level is None:
        level = water_in(model).water.level if plugin_instances(model) else 0.0
    with raise_causes():
        return control.start(Outset(model, copy_data(model, data), craft, level))


def count_steps(control: Control, timestep: float) -> int:
    """Number of steps of a timestep [s] from one update to the next, the nearest to the rate.

    Raises:
        ControlError: the rate is higher than that of the steps.
    """
    if control.rate is None:
        return 1
    if control.rate * timestep > 1.0 + 1e-9:
        raise ControlError(
            f"rate is {control.rate:g} Hz, and a timestep of {timestep:g} s has "
            f"{1.0 / timestep:g} Hz at most; lower one of the two"
        )
    return round(1.0 / (control.rate * timestep))


def copy_data(model: mujoco.MjModel, data: mujoco.MjData) -> mujoco.MjData:
    """Other data in the same state, after mj_forward."""
    own = mujoco.MjData(model)
    state = np.empty(mujoco.mj_stateSize(model, _STATE))
    mujoco.mj_getState(model, data, state, _STATE)
    mujoco.mj_setState(model, own, state, _STATE)
    mujoco.mj_forward(model, own)
    return own

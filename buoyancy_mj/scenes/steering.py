"""`Steering`: the controllers of a scene at work, each at its rate, between the steps of a run."""

import contextlib
import dataclasses
import warnings
from collections.abc import Iterator, Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.buoyancy import Buoyancy
from buoyancy_mj.engine.c_functions import raise_causes
from buoyancy_mj.engine.instances import plugin_instances
from buoyancy_mj.errors import BuoyancyWarning, ControlError, SceneError, choices
from buoyancy_mj.scenes.assembly import assemble
from buoyancy_mj.scenes.parts import Afloat
from buoyancy_mj.scenes.scene import Scene
from buoyancy_mj.sea.currents import is_still
from buoyancy_mj.vehicle.control.controller import (
    Control,
    Controller,
    Outset,
    copy_data,
    count_steps,
)
from buoyancy_mj.vehicle.control.program import Program
from buoyancy_mj.vehicle.crafts import find_craft

AT_LIMIT = 1e-9
"""Share of its range within which a control counts as at its limit."""


@dataclasses.dataclass
class _Helm:
    """One controller and the vehicle that it steers."""

    control: Control
    """What the scene says of it."""
    update: Controller
    """The function that writes controls."""
    steps: int
    """Number of steps from one update to the next."""
    vehicle: str
    """Name of the vehicle."""
    addresses: NDArray[np.int64]
    """Where the limited controls of the vehicle stand in `data.ctrl`."""
    ranges: NDArray[np.float64]
    """Their least and greatest values (n, 2), a hair inside."""
    at_limits: int = 0
    """Number of updates in which one of them was at a limit or beyond."""


class Steering:
    """All controllers of a scene.

    Args:
        scene: the scene.
        model: its model.
        data: its state at the start, after mj_forward.
        afloat: what floats of its vehicles.
        trust: whether to run the Python files that the scene names.

    Raises:
        SceneError: a controller for a vehicle that is not there, one in a Python file without
            trust, or one that cannot act on its vehicle.
    """

    def __init__(
        self,
        scene: Scene,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        afloat: Sequence[Afloat],
        *,
        trust: bool = False,
    ) -> None:
        check_trust(scene, trust=trust)
        self._model = model
        self._done = 0
        self._helms: list[_Helm] = []
        with contextlib.ExitStack() as stack, raise_causes():
            rest = model, data
            if any(control.needs_rest for control in scene.control):
                rest = stack.enter_context(_still_sea(scene, model, data))
            for control in scene.control:
                vehicle = _find_vehicle(control, afloat)
                own, start = rest if control.needs_rest else (model, data)
                outset = Outset(
                    own,
                    copy_data(own, start),
                    find_craft(own, vehicle.root),
                    scene.water.level,
                    vehicle.part.prefix,
                    scene.folder,
                )
                self._helms.append(_take_helm(control, vehicle, outset))

    def update(self, data: mujoco.MjData) -> int:
        """Let the controllers that are due write their controls, before the next step.

        Returns:
            How many steps may be taken, and told to `note_steps`, before the next is due.

        Raises:
            ControlError: a controller raises, or gives what is no finite number.
        """
        for helm in self._helms:
            if self._done % helm.steps == 0:
                self._call(helm, data)
        return min(helm.steps - self._done % helm.steps for helm in self._helms)

    def note_steps(self, count: int) -> None:
        """Note that steps have been taken since the last update."""
        self._done += count

    @property
    def controllers(self) -> dict[str, Controller]:
        """The controllers at work, by the vehicle that each steers."""
        return {helm.vehicle: helm.update for helm in self._helms}

    @property
    def at_limits(self) -> dict[str, int]:
        """Number of updates in which a control was at a limit, by the vehicle that is steered."""
        return {helm.vehicle: helm.at_limits for helm in self._helms}

    def _call(self, helm: _Helm, data: mujoco.MjData) -> None:
        """Call one controller, and look at what it wrote."""
        title, time = helm.control.title, float(data.time)
        try:
            helm.update(self._model, data)
        except Exception as error:
            raise ControlError(
                f"the controller {title} of '{helm.vehicle}' raised {type(error).__name__} at "
                f"{time:.4g} s: {' '.join(str(error).split())}"
            ) from error
        bad = np.flatnonzero(~np.isfinite(data.ctrl))
        if len(bad):
            name = _name_control(self._model, int(bad[0]))
            raise ControlError(
                f"the controller {title} of '{helm.vehicle}' gave {data.ctrl[bad[0]]} for "
                f"actuator '{name}' at {time:.4g} s; controls must be finite numbers"
            )
        given = data.ctrl[helm.addresses]
        if ((given <= helm.ranges[:, 0]) | (given >= helm.ranges[:, 1])).any():
            helm.at_limits += 1


def check_trust(scene: Scene, *, trust: bool) -> None:
    """Refuse to run Python files that a scene names, unless somebody trusts it.

    Raises:
        SceneError: the scene names one, and nobody does.
    """
    for control in scene.control:
        if isinstance(control, Program) and not trust:
            raise SceneError(
                f"the scene runs the code of '{control.file}'; read it, and give --trust (in "
                "Python trust=True) if you trust it"
            )


def _find_vehicle(control: Control, afloat: Sequence[Afloat]) -> Afloat:
    """The vehicle that a controller steers."""
    by_name = {group.name: group for group in afloat}
    if control.vehicle is None:
        if len(afloat) > 1:
            raise SceneError(
                f"control does not say which of {len(afloat)} vehicles ({', '.join(by_name)}) it "
                "steers; give it vehicle = NAME"
            )
        return afloat[0]
    if control.vehicle not in by_name:
        raise SceneError(
            f"control steers vehicle '{control.vehicle}', which is not there; "
            f"{choices(control.vehicle, by_name)}"
        )
    return by_name[control.vehicle]


def _take_helm(control: Control, vehicle: Afloat, outset: Outset) -> _Helm:
    """Start one controller."""
    model = outset.model
    controls = model.actuator_ctrladr[list(vehicle.part.actuators)]
    limited = controls[model.actuator_ctrllimited[controls].astype(bool)]
    least, most = model.actuator_ctrlrange[limited].T
    hair = AT_LIMIT * (most - least)
    return _Helm(
        control=control,
        update=control.start(outset),
        steps=count_steps(control, float(model.opt.timestep)),
        vehicle=vehicle.name,
        addresses=limited,
        ranges=np.column_stack([least + hair, most - hair]),
    )


@contextlib.contextmanager
def _still_sea(
    scene: Scene, model: mujoco.MjModel, data: mujoco.MjData
) -> Iterator[tuple[mujoco.MjModel, mujoco.MjData]]:
    """A model of the scene and its state at the start, on still water that acts."""
    water = dataclasses.replace(scene.water, waves=(), current=(0.0, 0.0, 0.0))
    if not scene.water.waves and is_still(scene.water.current) and plugin_instances(model):
        yield model, data
        return
    still = dataclasses.replace(scene, water=water)
    with warnings.catch_warnings(), raise_causes():
        # the run itself has given them
        warnings.simplefilter("ignore", BuoyancyWarning)
        twin, start, _ = assemble(still, with_water=True)
        if plugin_instances(twin):
            yield twin, start
        else:
            with Buoyancy(twin, still).installed():
                yield twin, start


def _name_control(model: mujoco.MjModel, address: int) -> str:
    """The name of the actuator to which a control belongs."""
    actuator = int(np.searchsorted(model.actuator_ctrladr, address, side="right")) - 1
    return str(model.actuator(actuator).name) or f"actuator {actuator}"

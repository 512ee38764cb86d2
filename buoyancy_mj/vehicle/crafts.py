"""`Craft`: the bodies of one vehicle that moves as a whole, and what drives it."""

import dataclasses
import functools

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError, choices, describe
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.vehicle.drives import Drive, find_drives


@dataclasses.dataclass(frozen=True, eq=False)
class Craft:
    """One vehicle of a model, with the actuators that push it at sites."""

    name: str
    """Name of its root body."""
    bodies: NDArray[np.int64]
    """Indices of its bodies, the root body first."""
    model: mujoco.MjModel
    """The model."""

    @property
    def root(self) -> int:
        """Index of its root body."""
        return int(self.bodies[0])

    @functools.cached_property
    def drives(self) -> tuple[Drive, ...]:
        """What pushes it, in the order of the model.

        Raises:
            ModelError: the thrust of an actuator does not follow from its control.
        """
        bodies = self.model.site_bodyid
        return tuple(
            drive for drive in find_drives(self.model) if bodies[drive.site] in self.bodies
        )


def find_craft(model: mujoco.MjModel, body: str | int | None = None) -> Craft:
    """Find a vehicle of a model.

    Args:
        model: the model.
        body: name or index of any of its bodies; None for the only vehicle, or for the only one
            that actuators push.

    Raises:
        ModelError: there is no such vehicle, or several are possible.
    """
    crafts = [
        Craft(body_name(model, int(bodies[0])), bodies, model)
        for bodies in group_floating_bodies(model)
    ]
    if body is not None:
        index = _find_body(model, body)
        crafts = [craft for craft in crafts if index in craft.bodies]
        if not crafts:
            raise ModelError(f"body {describe(body)} cannot move; name one of a vehicle")
    elif len(crafts) > 1:
        crafts = [craft for craft in crafts if craft.drives]
    if len(crafts) != 1:
        names = ", ".join(f"'{craft.name}'" for craft in crafts)
        told = f"{len(crafts)} vehicles ({names})" if crafts else "no vehicle"
        raise ModelError(
            f"the model has {told} whose actuators push at sites; name a body of one (body=)"
        )
    return crafts[0]


def find_centre(model: mujoco.MjModel, data: mujoco.MjData, craft: Craft) -> NDArray[np.float64]:
    """Centre of gravity (3,) [m] of a vehicle at the poses of its data, world frame."""
    masses = model.body_mass[craft.bodies]
    centre: NDArray[np.float64] = masses @ data.xipos[craft.bodies] / masses.sum()
    return centre


def _find_body(model: mujoco.MjModel, body: str | int) -> int:
    """The index of a body that is named, or given by its index."""
    names = {body_name(model, i): i for i in range(1, model.nbody)}
    if isinstance(body, str):
        if body not in names:
            raise ModelError(f"the model has no body {describe(body)}; {choices(body, names)}")
        return names[body]
    if not 0 < body < model.nbody:
        raise ModelError(f"body is {describe(body)}; the model has bodies 1 to {model.nbody - 1}")
    return int(body)

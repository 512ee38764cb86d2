"""What each vehicle's file has brought into the model of a scene, and what of it floats."""

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.verdicts import judge_geoms
from buoyancy_mj.scenes.scene_vehicle import SceneVehicle


class Part(NamedTuple):
    """What came from the file of one vehicle."""

    entry: SceneVehicle
    """What the scene says of the vehicle."""
    prefix: str
    """What stands before all names of the file in the model; '' for the only vehicle."""
    bodies: range
    """Indices of the bodies that came from it, those that cannot move among them."""
    actuators: range
    """Indices of the actuators that came from it."""

    @property
    def subject(self) -> str:
        """What messages call the vehicle."""
        return f"vehicle '{self.entry.name}'" if self.prefix else "the vehicle"


class Afloat(NamedTuple):
    """Bodies of one part that float together."""

    name: str
    """Name of the vehicle; that of the root body where several float in one file."""
    part: Part
    """What came from its file."""
    bodies: NDArray[np.int64]
    """Their indices, the root body first."""

    @property
    def root(self) -> int:
        """Index of the root body."""
        return int(self.bodies[0])


def find_afloat(
    model: mujoco.MjModel, parts: Sequence[Part], selection: Selection
) -> tuple[Afloat, ...]:
    """Find the bodies of each part that float: those that move with one that displaces water.

    Static bodies, mocap bodies and what displaces nothing are surroundings or cargo.

    Raises:
        ModelError: a vehicle displaces no water; and all that `judge_geoms` raises.
    """
    wet = {
        int(model.geom_bodyid[verdict.geom])
        for verdict in judge_geoms(model, selection)
        if verdict.displaces
    }
    groups = [
        bodies for bodies in group_floating_bodies(model) if not wet.isdisjoint(bodies.tolist())
    ]
    afloat: list[Afloat] = []
    for part in parts:
        own = [bodies for bodies in groups if bodies[0] in part.bodies]
        if not own:
            raise ModelError(
                f"{part.subject} displaces no water; choose geoms of its own (--geoms)"
            )
        for bodies in own:
            name = part.entry.name if len(own) == 1 else body_name(model, int(bodies[0]))
            afloat.append(Afloat(str(name), part, bodies))
    return tuple(afloat)


def choose_free(model: mujoco.MjModel, afloat: Sequence[Afloat]) -> list[Afloat]:
    """Those that a scene's start and masses are for: what floats freely; all where nothing does.

    A crane on a pier moves too, but is not what the scene sets afloat.
    """
    free_bodies = model.jnt_bodyid[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]
    free = [group for group in afloat if np.isin(group.bodies, free_bodies).any()]
    return free or list(afloat)

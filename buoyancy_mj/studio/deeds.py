"""What a button does to a vehicle: drop it, let it rest, lean it."""

import mujoco
import numpy as np
import scipy
from numpy.typing import NDArray

from buoyancy_mj.errors import ModelError
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.scenes.fleet import Vehicle
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.equilibrium import find_equilibrium
from buoyancy_mj.studio.basin import Basin


def drop(basin: Basin, name: str, height: float) -> None:
    """Hold a vehicle over the sea, at rest, and let it go.

    Args:
        basin: the scene.
        name: the vehicle.
        height: between its lowest point and the surface [m].

    Raises:
        ModelError: the vehicle is not free.
    """
    vehicle = basin.vehicles[name]
    rise = height + basin.frame().vehicles[name].draft
    _move(basin, vehicle, np.eye(3), np.array([0.0, 0.0, rise]))


def rest(basin: Basin, name: str) -> None:
    """Put a vehicle where it comes to rest on still water of the density and level that act.

    Raises:
        ModelError: the vehicle is not free.
        EquilibriumError: it sinks, or there is no balance near its pose.
    """
    vehicle = basin.vehicles[name]
    _find_free_joints(basin.model, vehicle)
    still = Water(density=basin.water.density, level=basin.water.level)
    vessel = build_vessel(
        basin.model,
        still,
        basin.data.qpos,
        body=body_name(basin.model, vehicle.root),
        selection=basin.scene.selection,
        ballast=basin.data.act,
    )
    vessel.check_free()
    basin.data.qpos[:] = find_equilibrium(vessel).qpos
    _stop(basin, vehicle)


def lean(basin: Basin, name: str, heel: float, trim: float) -> None:
    """Turn a vehicle about its centre of mass, and let it go at rest.

    Args:
        basin: the scene.
        name: the vehicle.
        heel: turn about the x axis of its root body [rad].
        trim: turn about its y axis [rad].

    Raises:
        ModelError: the vehicle is not free.
    """
    vehicle = basin.vehicles[name]
    axes = basin.frame().data.xmat[vehicle.root].reshape(3, 3)
    own = scipy.spatial.transform.Rotation.from_euler("YX", [trim, heel]).as_matrix()
    _move(basin, vehicle, axes @ own @ axes.T, np.zeros(3))


def _move(
    basin: Basin, vehicle: Vehicle, turn: NDArray[np.float64], shift: NDArray[np.float64]
) -> None:
    """Turn a vehicle (3, 3) about its centre of mass, shift it (3,) [m], and stop it."""
    Rotation = scipy.spatial.transform.Rotation
    joints = _find_free_joints(basin.model, vehicle)
    centre = vehicle.centre_of_mass(basin.frame().data)
    qpos = basin.data.qpos
    for joint in joints:
        at = int(basin.model.jnt_qposadr[joint])
        qpos[at : at + 3] = centre + turn @ (qpos[at : at + 3] - centre) + shift
        old = Rotation.from_quat(qpos[at + 3 : at + 7], scalar_first=True)
        new = Rotation.from_matrix(turn) * old
        qpos[at + 3 : at + 7] = new.as_quat(scalar_first=True)
    _stop(basin, vehicle)


def _stop(basin: Basin, vehicle: Vehicle) -> None:
    """Take all velocity from a vehicle."""
    own = np.isin(basin.model.dof_bodyid, vehicle.bodies)
    basin.data.qvel[own] = 0.0
    basin.data.qacc_warmstart[own] = 0.0


def _find_free_joints(model: mujoco.MjModel, vehicle: Vehicle) -> list[int]:
    """The free joints of a vehicle.

    Raises:
        ModelError: it has none.
    """
    free = (model.jnt_type == mujoco.mjtJoint.mjJNT_FREE) & np.isin(
        model.jnt_bodyid, vehicle.bodies
    )
    if not free.any():
        raise ModelError(
            f"vehicle '{vehicle.name}' hangs on joints of its own and cannot be put elsewhere; "
            "give its root body a <freejoint/>"
        )
    return [int(joint) for joint in np.flatnonzero(free)]

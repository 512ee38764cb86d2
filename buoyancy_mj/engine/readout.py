"""What a pass of the water left, as `Loads`."""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.engine.load_model import LoadModel
from buoyancy_mj.kernels import clip, wrenches
from buoyancy_mj.kernels.passes import Record
from buoyancy_mj.loads.loads import Loads, Portion


def read_loads(
    load_model: LoadModel,
    record: Record,
    data: mujoco.MjData,
    gravity: float,
    centre_of_mass: NDArray[np.float64],
) -> Loads:
    """What a record holds, as copies.

    Args:
        load_model: what acted.
        record: what the pass left.
        data: of the pass, which still hold its poses.
        gravity: downward acceleration [m/s^2].
        centre_of_mass: of the floating bodies (3,) [m], world frame.
    """
    hulls, owners = load_model.hulls, load_model.arrays.owners
    # without the rows of bladders, which count to the ballast
    wet, heads = record.wet[: len(hulls)].copy(), record.heads[: len(hulls)]
    centres, rows = record.centres.copy(), record.total.copy()
    xipos, weight = data.xipos, load_model.arrays.sea.density * gravity

    # each hull
    if load_model.has_wave_pressure:
        force, about = weight * heads[:, :3], weight * heads[:, 3:]
        origins = data.geom_xpos[[hull.geom for hull in hulls]]
        torque = about + _cross(origins - xipos[owners], force)
    else:
        force = np.zeros((len(hulls), 3))
        force[:, 2] = weight * wet[:, clip.VOLUME]
        arm = np.where(force[:, 2:] > 0.0, wet[:, clip.CENTROID] - xipos[owners], 0.0)
        torque = _cross(arm, force)
    hull = Portion(wet[:, clip.VOLUME], wet[:, clip.CENTROID], force, torque)

    # each body, and all of them
    body = Portion(centres[:, 0], centres[:, 1:], rows[:, :3], rows[:, 3:])
    everything = np.empty((1, 4))
    wrenches.merge(wet, np.zeros(len(wet), np.int64), everything)
    torque = body.torque + _cross(xipos - centre_of_mass, body.force)
    total = Portion(everything[0, 0], everything[0, 1:], body.force.sum(axis=0), torque.sum(axis=0))
    return Loads(
        names=tuple(hull.name for hull in hulls),
        hull=hull,
        body=body,
        total=total,
        wetted_area=wet[:, clip.WETTED_AREA],
        waterplane_area=wet[:, clip.WATERPLANE_AREA],
        by_cause={cause: getattr(record.causes, cause).copy() for cause in load_model.causes},
    )


def _cross(arms: NDArray[np.float64], forces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cross products (n, 3) of rows (n, 3), as `np.cross` has them in several times as long."""
    (ax, ay, az), (fx, fy, fz) = arms.T, forces.T
    return np.column_stack([ay * fz - az * fy, az * fx - ax * fz, ax * fy - ay * fx])

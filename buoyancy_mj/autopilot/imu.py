"""Where the autopilot of a vehicle is, and the frames of aviation.

MuJoCo's world has z up. An autopilot has north, east and down (NED): north is the world's x, so
that a vehicle without yaw heads north, east its -y, and down its -z from the still level. A vehicle
has x forward, y to port and z up; an autopilot has x forward, y to starboard and z down (FRD). Both
changes are the same half turn about x: the signs of y and z.
"""

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.scenes.fleet import Vehicle

HALF_TURN = np.array([1.0, -1.0, -1.0])
"""Signs that turn axes with z up into axes with z down, and back."""
_IMU = "imu"
"""Name of the site whose frame the autopilot has."""


def find_imu(model: mujoco.MjModel, vehicle: Vehicle) -> tuple[int, int]:
    """The kind and the index of what bears a vehicle's autopilot: its site `imu`, or its root."""
    for site in range(model.nsite):
        name = str(model.site(site).name).rsplit("/", 1)[-1]
        if name == _IMU and model.site_bodyid[site] in vehicle.bodies:
            return int(mujoco.mjtObj.mjOBJ_SITE), site
    return int(mujoco.mjtObj.mjOBJ_XBODY), vehicle.root


def imu_pose(
    data: mujoco.MjData, kind: int, index: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place (3,) [m] and rotation world_from_imu (9,) of what `find_imu` found."""
    if kind == mujoco.mjtObj.mjOBJ_SITE:
        return data.site_xpos[index], data.site_xmat[index]
    return data.xpos[index], data.xmat[index]

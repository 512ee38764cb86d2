"""A vessel at the draft that carries its weight, turned as one likes, and its stiffness there."""

import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.vessel import Vessel

NEUTRAL = 1e-6
"""Part of its mass by which the reserve of a vessel that hovers may differ from zero.

MuJoCo keeps vertices in single precision."""


def find_heave_balance(
    vessel: Vessel,
    rotation: NDArray[np.float64],
    height: float | None = None,
    tolerance: float = 1e-14,
) -> FloatingPose:
    """Find the draft at which a vessel displaces its mass, its attitude held.

    A vessel that weighs just what it displaces stays at its height, or goes as much deeper as it
    takes to be under water.

    Args:
        vessel: the vessel.
        rotation: its attitude, world_from_vessel (3, 3).
        height: of its centre of gravity, where the search begins [m]; where the vessel is if None.
        tolerance: part of its whole volume by which the wet volume may be off.

    Raises:
        EquilibriumError: the vessel sinks, or weighs nothing.
    """
    vessel.check_weight()
    z = float(vessel.position[2]) if height is None else height
    neutral = NEUTRAL * vessel.mass
    if vessel.reserve < -neutral:
        raise EquilibriumError(
            f"'{vessel.name}' sinks: it weighs {vessel.mass:.4g} kg and displaces "
            f"{vessel.mass + vessel.reserve:.4g} kg of water fully submerged, "
            f"{-vessel.reserve:.4g} kg too little; take mass out or add foam (see ballast)"
        )
    if vessel.reserve <= neutral:
        _, high = vessel.heights(rotation)
        z = min(z, vessel.water.level - high)
        return pose_vessel(vessel, [*vessel.position[:2], z], rotation)
    return _find_floating_height(vessel, rotation, z, tolerance)


def _find_floating_height(
    vessel: Vessel, rotation: NDArray[np.float64], z: float, tolerance: float
) -> FloatingPose:
    """Find the height of the centre of gravity at which a vessel floats, starting from `z` [m]."""
    level = vessel.water.level
    volume = vessel.mass / vessel.water.density
    low, high = level - vessel.radius, level + vessel.radius
    z = z if low < z < high else level
    while True:
        pose = pose_vessel(vessel, [*vessel.position[:2], z], rotation)
        excess = pose.volume - volume
        if abs(excess) <= tolerance * vessel.volume:
            return pose

        # the balance lies above a pose that displaces too much, below one that displaces too little
        low, high = (z, high) if excess > 0.0 else (low, z)

        # a Newton step by the waterplane, or half the interval where that leads out of it
        area = pose.waterplane_area
        z = z + excess / area if area > 0.0 else math.inf
        if not low < z < high:
            z = 0.5 * (low + high)

        # the interval has closed
        if not low < z < high:
            return pose


def tilt(pose: FloatingPose, angles: NDArray[np.float64]) -> FloatingPose:
    """Turn a vessel about the world's x and y by angles (2,) [rad], and heave it to its draft."""
    from scipy.spatial.transform import Rotation

    rotation = Rotation.from_rotvec([*angles, 0.0]).as_matrix() @ pose.rotation
    return find_heave_balance(pose.vessel, rotation, float(pose.position[2]))


def tilt_stiffness(pose: FloatingPose) -> NDArray[np.float64]:
    """Restoring torques (2, 2) [N m] per turn about x and y [rad], at constant displacement."""
    stiffness = pose.stiffness
    heave, coupling, turning = stiffness[0, 0], stiffness[0, 1:], stiffness[1:, 1:]
    if heave <= 1e-12 * pose.vessel.weight / pose.vessel.radius:
        return turning

    # the draft follows the turn, so that the volume stays
    return np.asarray(turning - np.outer(coupling, coupling) / heave, float)

"""Balance of a vessel: at the draft that carries its weight, turned until no torque is left."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.vessel import Vessel

NEUTRAL = 1e-6
"""Part of its mass by which the reserve of a vessel that hovers may differ from zero.

MuJoCo keeps vertices in single precision."""
SEARCH_ANGLE = 0.1
"""How far to look around where the curvature tells nothing [rad]."""
_BALANCED = 1e-11
"""Torque over weight times radius at which a vessel is at rest."""
_MOST_STEPS = 200
"""Steps in attitude after which the search gives up."""
_LONGEST_STEP = 0.5
"""Largest turn in one step [rad]."""


def find_heave_balance(
    vessel: Vessel, rotation: NDArray[np.float64], height: float | None = None
) -> FloatingPose:
    """Find the draft at which a vessel displaces its mass, its attitude held.

    A vessel that weighs just what it displaces stays at its height, or goes as much deeper as it
    takes to be under water.

    Args:
        vessel: the vessel.
        rotation: its attitude, world_from_vessel (3, 3).
        height: of its centre of gravity, where the search begins [m]; where the vessel is if None.

    Raises:
        EquilibriumError: the vessel sinks, or weighs nothing.
    """
    vessel.check_weight()
    z = float(vessel.position[2]) if height is None else height
    tolerance = NEUTRAL * vessel.mass
    if vessel.reserve < -tolerance:
        raise EquilibriumError(
            f"'{vessel.name}' sinks: it weighs {vessel.mass:.4g} kg and displaces "
            f"{vessel.mass + vessel.reserve:.4g} kg of water fully submerged, "
            f"{-vessel.reserve:.4g} kg too little; take mass out or add foam (see ballast)"
        )
    if vessel.reserve <= tolerance:
        _, high = vessel.heights(rotation)
        z = min(z, vessel.water.level - high)
        return pose_vessel(vessel, [*vessel.position[:2], z], rotation)
    return _find_floating_height(vessel, rotation, z)


def _find_floating_height(vessel: Vessel, rotation: NDArray[np.float64], z: float) -> FloatingPose:
    """Find the height of the centre of gravity at which a vessel floats, starting from `z` [m]."""
    level = vessel.water.level
    volume = vessel.mass / vessel.water.density
    low, high = level - vessel.radius, level + vessel.radius
    z = z if low < z < high else level
    while True:
        pose = pose_vessel(vessel, [*vessel.position[:2], z], rotation)
        excess = pose.volume - volume
        if abs(excess) <= 1e-14 * vessel.volume:
            return pose

        # the balance lies above a pose that displaces too much, below one that displaces too little
        low, high = (z, high) if excess > 0.0 else (low, z)

        # a Newton step by the waterplane, or half the interval where that leads out of it
        area = pose.waterplane.area
        z = z + excess / area if area > 0.0 else math.inf
        if not low < z < high:
            z = 0.5 * (low + high)

        # the interval has closed
        if not low < z < high:
            return pose


def find_balance(
    vessel: Vessel,
    rotation: NDArray[np.float64],
    height: float | None = None,
    *,
    axes: NDArray[np.float64] | None = None,
    stable: bool = True,
) -> tuple[FloatingPose, int]:
    """Find a pose without torque, at the draft that carries the weight.

    At that draft the energy is weight times the height of G over B, a smooth function of attitude
    alone. Newton steps with the exact stiffness make it smallest, with negative curvature turned
    downhill, within a trust region. So each step leads down, and off a summit too.

    Args:
        vessel: a vessel that floats.
        rotation: world_from_vessel (3, 3), where the search begins.
        height: of its centre of gravity, where the search begins [m]; where the vessel is if None.
        axes: horizontal axes about which it may turn (2, k), orthonormal; x and y if None.
        stable: False for the nearest balance, be it a summit or a saddle.

    Returns:
        The pose, and the number of steps in attitude.

    Raises:
        EquilibriumError: the vessel sinks, or the search found no balance.
    """
    basis = np.eye(2) if axes is None else axes
    pose = find_heave_balance(vessel, rotation, height)
    scale = vessel.weight * vessel.radius
    reach = _LONGEST_STEP
    for count in range(_MOST_STEPS):
        torque = basis.T @ pose.torque
        values, vectors = np.linalg.eigh(basis.T @ tilt_stiffness(pose) @ basis)
        principal = basis @ vectors

        # in balance: look for a lower pose nearby
        if np.linalg.norm(torque) <= _BALANCED * scale:
            lower = _find_lower(pose, values, principal) if stable else None
            if lower is None:
                return pose, count
            pose = lower
            continue

        # a step within the trust region, which grows with success
        step = _newton_step(values, vectors.T @ torque, 1e-9 * scale, reach, downhill=stable)
        trial = tilt(pose, principal @ step)
        if _improves(trial, pose, basis, stable=stable):
            reach = min(2.0 * reach, _LONGEST_STEP)
            pose = trial
            continue

        # and shrinks with failure; flat faces in the surface may leave a kink, where torques
        # change sign at once
        reach = 0.25 * min(reach, float(np.linalg.norm(step)))
        if reach < 1e-12:
            if stable:
                return pose, count
            break
    raise EquilibriumError(
        f"no balance of '{vessel.name}' was found from this start: after {count + 1} steps "
        f"{float(np.linalg.norm(basis.T @ pose.torque)):.3g} N m are left; start elsewhere"
        + ("" if stable else ", or look for a stable one")
    )


def tilt(pose: FloatingPose, angles: NDArray[np.float64]) -> FloatingPose:
    """Turn a vessel about the world's x and y by angles (2,) [rad], and heave it to its draft."""
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


def _find_lower(
    pose: FloatingPose, values: NDArray[np.float64], axes: NDArray[np.float64]
) -> FloatingPose | None:
    """Find a lower pose beside a summit or a saddle, or where the curvature tells nothing.

    Args:
        pose: a pose in balance.
        values: its principal stiffnesses (k,) [N m], ascending.
        axes: their axes (2, k).

    Returns:
        The pose; None at the bottom of a valley.
    """
    scale = pose.vessel.weight * pose.vessel.radius
    if values[0] >= 1e-6 * scale:
        return None
    angles = (way * part * SEARCH_ANGLE for part in (1.0, 0.1, 0.01) for way in (1.0, -1.0))
    around = (tilt(pose, angle * axes[:, 0]) for angle in angles)
    return next((other for other in around if other.energy < pose.energy - 1e-10 * scale), None)


def _newton_step(
    values: NDArray[np.float64],
    torque: NDArray[np.float64],
    least: float,
    reach: float,
    *,
    downhill: bool,
) -> NDArray[np.float64]:
    """Turns (k,) [rad] about the principal axes that should take the torque away.

    Args:
        values: principal stiffnesses (k,) [N m].
        torque: torques about the principal axes (k,) [N m].
        least: smallest magnitude of a stiffness to divide by [N m].
        reach: length of the longest step [rad].
        downhill: whether to turn with the torque also where the stiffness is negative.
    """
    divisor = np.where(np.abs(values) > least, values, np.copysign(least, values))
    step = torque / (np.abs(divisor) if downhill else divisor)
    length = float(np.linalg.norm(step))
    return step * (reach / length) if length > reach else step


def _improves(
    trial: FloatingPose, pose: FloatingPose, basis: NDArray[np.float64], *, stable: bool
) -> bool:
    """Whether a step leads to lower energy, or to less torque where only a balance is sought."""
    before, after = (float(np.linalg.norm(basis.T @ at.torque)) for at in (pose, trial))
    if not stable:
        return after < before

    # within rounding of the energy the torque tells more
    noise = 1e-13 * pose.vessel.weight * pose.vessel.radius
    gain = pose.energy - trial.energy
    return gain > noise or (gain > -noise and after < before)

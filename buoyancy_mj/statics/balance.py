"""A vessel brought into balance: at the draft that carries its weight, turned until no torque is left."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.vessel import Vessel

NEUTRAL = 1e-6
"""Part of its mass by which a vessel that hovers may differ from its water: MuJoCo keeps vertices in single precision."""
BALANCED = 1e-11
"""Torque over weight times radius at which a vessel is at rest."""
STRIDE = 0.1
"""How far to look around where the curvature tells nothing [rad]."""
_STEPS, _LONGEST = 200, 0.5


def find_heave_balance(
    vessel: Vessel, rotation: NDArray[np.float64], height: float | None = None
) -> FloatingPose:
    """The vessel turned by world_from_vessel (3, 3), at the height at which it displaces its mass.

    One that weighs just what it displaces stays where it is, or as much deeper as it takes to be under water.

    Args:
        vessel: any.
        rotation: its attitude.
        height: of its centre of gravity, where the search begins [m]; None for where it is.

    Raises:
        EquilibriumError: it sinks.
    """
    level, wanted = vessel.water.level, vessel.mass / vessel.water.density
    low, high = level - vessel.radius, level + vessel.radius
    z = float(vessel.position[2]) if height is None else height
    surplus = vessel.water.density * vessel.volume - vessel.mass
    if surplus <= NEUTRAL * vessel.mass:
        _refuse_to_sink(vessel, surplus)
        top = float((vessel.points @ rotation[2]).max())
        return pose_vessel(vessel, [*vessel.position[:2], min(z, level - top)], rotation)
    z = z if low < z < high else level
    while True:
        afloat = pose_vessel(vessel, [*vessel.position[:2], z], rotation)
        excess = afloat.volume - wanted
        low, high = (z, high) if excess > 0.0 else (low, z)
        if abs(excess) <= 1e-14 * vessel.volume:
            return afloat
        # Newton by the waterplane, halving where that leads out
        area = afloat.waterplane.area
        z = z + excess / area if area > 0.0 else math.inf
        if not low < z < high:
            z = 0.5 * (low + high)
            if not low < z < high:
                return afloat


def find_balance(
    vessel: Vessel,
    rotation: NDArray[np.float64],
    height: float | None = None,
    *,
    free: NDArray[np.float64] | None = None,
    stable: bool = True,
) -> tuple[FloatingPose, int]:
    """Where the torques vanish at the draft that carries the weight, and the steps in attitude that it took.

    At that draft the energy is weight times the height of G over B, a smooth function of attitude
    alone. It is made smallest by Newton steps with the exact stiffness, negative curvature turned
    downhill, within a trust region; so each step leads down, and off a summit too.

    Args:
        vessel: any that floats.
        rotation: world_from_vessel (3, 3), where the search begins.
        height: likewise, see `floated`.
        free: horizontal axes about which it may turn (2, k), orthonormal; both if None.
        stable: False for the nearest balance, be it a summit or a saddle.

    Raises:
        EquilibriumError: it sinks; or no balance was found.
    """
    basis = np.eye(2) if free is None else free
    afloat = find_heave_balance(vessel, rotation, height)
    scale = vessel.weight * vessel.radius
    reach = _LONGEST
    for count in range(_STEPS):
        torque = basis.T @ afloat.force[1:]
        values, vectors = np.linalg.eigh(basis.T @ tilt_stiffness(afloat) @ basis)
        axes = basis @ vectors
        if np.linalg.norm(torque) <= BALANCED * scale:
            lower = _downhill(afloat, values, axes) if stable else None
            if lower is None:
                return afloat, count
            afloat = lower
            continue
        step = _step(values, vectors.T @ torque, 1e-9 * scale, reach, downhill=stable)
        trial = tilt(afloat, axes @ step)
        if _better(trial, afloat, basis, stable=stable):
            reach = min(2.0 * reach, _LONGEST)
            afloat = trial
        else:
            reach = 0.25 * min(reach, float(np.linalg.norm(step)))
            # flat faces in the surface may leave a kink, where torques change sign at once
            if reach < 1e-12 and stable:
                return afloat, count
            if reach < 1e-12:
                break
    raise EquilibriumError(
        f"no balance of '{body_name(vessel.model, vessel.root)}' was found from this start: after {count + 1} steps "
        f"{float(np.linalg.norm(basis.T @ afloat.force[1:])):.3g} N m are left; start elsewhere"
        + ("" if stable else ", or look for a stable one")
    )


def tilt(afloat: FloatingPose, turn: NDArray[np.float64]) -> FloatingPose:
    """Turned about horizontal axes by (2,) [rad], at the draft that carries its weight."""
    rotation = Rotation.from_rotvec([*turn, 0.0]).as_matrix() @ afloat.rotation
    return find_heave_balance(afloat.vessel, rotation, float(afloat.position[2]))


def tilt_stiffness(afloat: FloatingPose) -> NDArray[np.float64]:
    """Restoring torques per turn about x and y (2, 2) [N m], the draft following so that the volume stays."""
    whole = afloat.stiffness
    heave = whole[0, 0]
    if heave <= 1e-12 * afloat.vessel.weight / afloat.vessel.radius:
        return whole[1:, 1:]
    return whole[1:, 1:] - np.outer(whole[1:, 0], whole[0, 1:]) / heave


def _refuse_to_sink(vessel: Vessel, surplus: float) -> None:
    if surplus < -NEUTRAL * vessel.mass:
        raise EquilibriumError(
            f"'{body_name(vessel.model, vessel.root)}' sinks: it weighs {vessel.mass:.4g} kg and displaces "
            f"{vessel.mass + surplus:.4g} kg of water fully submerged, {-surplus:.4g} kg too little; take mass out or add "
            "foam (see ballast)"
        )


def _downhill(
    afloat: FloatingPose, values: NDArray[np.float64], axes: NDArray[np.float64]
) -> FloatingPose | None:
    """A lower pose beside a summit, a saddle, or where the curvature tells nothing; None at the bottom."""
    scale = afloat.vessel.weight * afloat.vessel.radius
    if values[0] >= 1e-6 * scale:
        return None
    ways = (way * part * STRIDE for part in (1.0, 0.1, 0.01) for way in (1.0, -1.0))
    poses = (tilt(afloat, way * axes[:, 0]) for way in ways)
    return next((pose for pose in poses if pose.energy < afloat.energy - 1e-10 * scale), None)


def _step(
    values: NDArray[np.float64],
    along: NDArray[np.float64],
    least: float,
    reach: float,
    *,
    downhill: bool,
) -> NDArray[np.float64]:
    """A turn (k,) [rad] along the axes of stiffness."""
    divisor = np.where(np.abs(values) > least, values, np.copysign(least, values))
    step = along / (np.abs(divisor) if downhill else divisor)
    length = float(np.linalg.norm(step))
    return step * (reach / length) if length > reach else step


def _better(
    trial: FloatingPose, afloat: FloatingPose, basis: NDArray[np.float64], *, stable: bool
) -> bool:
    """Whether a step is to be taken."""
    less = bool(
        np.linalg.norm(basis.T @ trial.force[1:]) < np.linalg.norm(basis.T @ afloat.force[1:])
    )
    if not stable:
        return less
    # within rounding of the energy the torque tells more
    noise = 1e-13 * afloat.vessel.weight * afloat.vessel.radius
    gain = afloat.energy - trial.energy
    return gain > noise or (gain > -noise and less)

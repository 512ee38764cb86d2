"""`find_balance`: a vessel turned, at its draft, until no torque is left."""

import math

import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.balance import find_heave_balance, tilt, tilt_stiffness
from buoyancy_mj.statics.floating_pose import FloatingPose
from buoyancy_mj.statics.vessel import Vessel

_BALANCED = 1e-11
"""Torque over weight times radius at which a vessel is at rest."""
_SOFT = 1e-6
"""Stiffness over weight times radius below which a lower pose may lie beside a balance."""
_LEVEL = 1e-5
"""Stiffness over weight times radius of a valley that is all but level."""
_FAINT = 1e-7
"""Torque over weight times radius along such a valley."""
_NOISE = 1e-13
"""Rounding of the energy, over weight times radius."""
_LOWER = 1e-11
"""Fall of energy, over weight times radius, that tells a lower pose from rounding."""
_PATIENCE = 50
"""Steps after which a valley that bends, and is all but level, counts as level."""
_LOOK_AROUND = 1e-3, 1e-2, 1e-1
"""How far to look for a lower pose beside a balance [rad]."""
_MOST_STEPS = 200
"""Steps in attitude after which the search gives up."""
_LONGEST_STEP = 0.5
"""Largest turn in one step [rad]."""
_SHORTEST_STEP = 1e-12
"""Turn below which no step can lead farther [rad]."""


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
    downhill, within a trust region. So each step leads down, and off a summit too: the way that the
    torque drives, be it ever so small. Where there is none the vessel heels to starboard; where
    only trim leads down, it trims by the bow.

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
        late = count > _PATIENCE
        values, vectors = np.linalg.eigh(basis.T @ tilt_stiffness(pose) @ basis)
        principal = basis @ vectors
        torque = principal.T @ pose.torque
        if stable:
            torque = np.where(_is_level(values, torque, scale, late), 0.0, torque)

        # in balance, or as good as on a summit: look for a lower pose nearby
        balanced = bool(np.linalg.norm(torque) <= _BALANCED * scale) or reach < _SHORTEST_STEP
        if stable and (balanced or _is_poised(values, torque, scale)):
            lower = _find_lower(pose, values, principal, scale * (-_SOFT if late else _SOFT))
            if lower is not None:
                pose, reach = lower, _LONGEST_STEP
                continue
        if reach < _SHORTEST_STEP and not stable:
            break
        if balanced:
            return pose, count

        # a step within the trust region, which grows with success
        step = _newton_step(values, torque, 1e-9 * scale, reach, downhill=stable)
        trial = tilt(pose, principal @ step)
        if _improves(trial, pose, basis, stable=stable):
            reach = min(2.0 * reach, _LONGEST_STEP)
            pose = trial
            continue

        # and shrinks with failure; flat faces in the surface may leave a kink, where torques
        # change sign at once
        reach = 0.25 * min(reach, float(np.linalg.norm(step)))
    raise EquilibriumError(
        f"no balance of '{vessel.name}' was found from this start: after {count + 1} steps "
        f"{float(np.linalg.norm(basis.T @ pose.torque)):.3g} N m are left; start elsewhere"
        + ("" if stable else ", or look for a stable one")
    )


def _is_level(
    values: NDArray[np.float64], torque: NDArray[np.float64], scale: float, faint: bool
) -> NDArray[np.bool_]:
    """Which principal axes (k,) a turn about gains nothing, and would spoil the balance of others.

    Args:
        values: principal stiffnesses (k,) [N m].
        torque: torques about the principal axes (k,) [N m].
        scale: weight times radius [N m].
        faint: whether faint torques do not count, or only those that gain less than rounding.
    """
    soft = values < _LEVEL * scale
    if faint:
        return soft & (np.abs(torque) < _FAINT * scale)
    gains = 0.5 * torque**2 / np.maximum(np.abs(values), 1e-9 * scale)
    return soft & (gains < 0.1 * _NOISE * scale)


def _is_poised(values: NDArray[np.float64], torque: NDArray[np.float64], scale: float) -> bool:
    """Whether a vessel is so near to a summit that rounding hides where a Newton step leads.

    Args:
        values: principal stiffnesses (k,) [N m], ascending.
        torque: torques about the principal axes (k,) [N m].
        scale: weight times radius [N m].
    """
    if values[0] >= -_SOFT * scale:
        return False
    least = np.maximum(np.abs(values), _SOFT * scale)
    return float((torque**2 / least).sum()) <= 2.0 * _LOWER * scale


def _find_lower(
    pose: FloatingPose,
    values: NDArray[np.float64],
    principal: NDArray[np.float64],
    least: float,
) -> FloatingPose | None:
    """Find a lower pose beside a summit or a saddle, or where the curvature tells nothing.

    Args:
        pose: a pose in balance, or nearly so.
        values: its principal stiffnesses (k,) [N m], ascending.
        principal: their axes (2, k).
        least: stiffness from which on nothing lower lies beside [N m].

    Returns:
        The pose; None at the bottom of a valley.
    """
    scale = pose.vessel.weight * pose.vessel.radius
    soft = principal[:, values < least]
    if not soft.size:
        return None

    # along the softest axis, and across it where that is soft too
    softest = principal[:, values <= values[0] + _SOFT * scale]
    along = _choose_axis(pose, softest)
    axes = [along]
    if soft.shape[1] > 1:
        across = np.array([-along[1], along[0]])
        axes += [across, (along + across) / math.sqrt(2.0), (along - across) / math.sqrt(2.0)]
    turns = (way * angle * axis for angle in _LOOK_AROUND for axis in axes for way in (1.0, -1.0))
    around = (tilt(pose, turn) for turn in turns)
    return next((other for other in around if other.energy < pose.energy - _LOWER * scale), None)


def _choose_axis(pose: FloatingPose, axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Choose the axis (2,) about which a vessel falls off a summit, turned the way that it falls.

    That is the way of the torque; without one to starboard, else by the bow.

    Args:
        pose: the pose on the summit.
        axes: the axes about which it falls alike (2, k), orthonormal.
    """
    onto = axes @ axes.T
    torque = onto @ pose.torque / (pose.vessel.weight * pose.vessel.radius)
    heading = Attitude.from_matrix(pose.rotation).heading
    heel = onto @ [math.cos(heading), math.sin(heading)]
    trim = onto @ [-math.sin(heading), math.cos(heading)]
    least = (torque, _BALANCED), (heel, 1e-3), (trim, 0.0)
    way = next(way for way, length in least if np.linalg.norm(way) > length)
    return np.asarray(way / np.linalg.norm(way), float)


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
    noise = _NOISE * pose.vessel.weight * pose.vessel.radius
    gain = pose.energy - trial.energy
    return gain > noise or (gain > -noise and after < before)

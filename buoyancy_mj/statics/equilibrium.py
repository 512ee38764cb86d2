"""`equilibrium` and `equilibria`: where a vessel comes to rest, and whether it stays there."""

import dataclasses
from collections.abc import Mapping, Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.descent import find_balance
from buoyancy_mj.statics.distinct_poses import group_poses
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.heading_axes import HEAVE_ROLL_PITCH, compute_mass_matrix
from buoyancy_mj.statics.hydrostatics import Hydrostatics, compute_hydrostatics
from buoyancy_mj.statics.lows import find_lows
from buoyancy_mj.statics.vessel import Vessel

INDIFFERENT = 1e-3
"""Part of the largest eigenvalue below which an eigenvalue counts as zero.

The period of such a motion is thirty times the shortest."""

_SWING = 1e-3
"""Turn [rad], and heave over radius, of a swing that shows what holds a vessel."""
_LEVEL = 1e-6
"""Difference of energy over weight times radius of poses that are level with each other."""


@dataclasses.dataclass(frozen=True, eq=False)
class Equilibrium:
    """A pose in which weight and buoyancy balance."""

    qpos: NDArray[np.float64]
    """Coordinates of the model (nq,), with the heading, the place and the joints of the start."""
    hydrostatics: Hydrostatics
    """Draft, heel, trim and all else in this pose."""
    eigenvalues: NDArray[np.float64]
    """Squared frequencies of coupled heave, roll and pitch (3,) [1/s^2], ascending.

    The vessel tips over where one is negative. Of a vessel that outriggers hold which only just
    touch the water, they are those of a swing of 0.001 rad."""
    energy: float
    """Potential energy of weight and buoyancy [J]; of several poses the lowest is the safest."""
    iterations: int
    """Number of steps in attitude that the search took."""

    @property
    def stability(self) -> str:
        """'stable', 'indifferent' or 'unstable'.

        Indifferent is a vessel with a motion that meets no resistance: one that hovers at any
        depth, or a log at any angle of roll.
        """
        least = float(self.eigenvalues[0])
        small = INDIFFERENT * float(np.abs(self.eigenvalues).max())
        return "stable" if least > small else "unstable" if least < -small else "indifferent"

    @property
    def stable(self) -> bool:
        """Whether the vessel comes back from every small push."""
        return self.stability == "stable"


def equilibrium(
    model: mujoco.MjModel,
    water: Water | None = None,
    start: ArrayLike | None = None,
    *,
    stable: bool = True,
    body: str | None = None,
    selection: Selection = Selection(),
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> Equilibrium:
    """Find the pose in which a vessel comes to rest, its joints held.

    The search takes Newton steps that always lead down, see `statics.descent.find_balance`. On a
    summit the vessel falls the way that its least asymmetry drives it; without any it heels to
    starboard, or trims by the bow where only that leads down.

    Args:
        model: any MuJoCo model with a body that floats.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        start: coordinates of the model (nq,), or of its free joint alone (7,); `model.qpos0` if
            None.
        stable: False for the nearest balance, be it a summit or a saddle.
        body: name of the root body, where several float; the first that floats freely and has
            hulls if None.
        selection: which geoms displace water, and as what.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        EquilibriumError: the vessel sinks, or there is no balance near the start.
        ModelError: nothing is free to float; or see `statics.building.build_vessel`.
        MeshError: a mesh bounds no volume.

    Example:
        `equilibrium(model, Water(density=1025.0)).hydrostatics.draft`
    """
    vessel = build_vessel(model, water, start, body=body, selection=selection, ballast=ballast)
    vessel.check_free()
    return find_equilibrium(vessel, stable=stable)


def equilibria(
    model: mujoco.MjModel,
    water: Water | None = None,
    start: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> tuple[Equilibrium, ...]:
    """Find every pose in which a vessel stays at rest, its joints held; lowest energy first.

    The search starts from the lows of the energy over 642 attitudes all round, 9 degrees apart, and
    over others 1 degree apart where the torque may vanish. Poses that differ by heading alone, or
    by a turn that resists with less than 0.0005 of weight times radius per radian, count once, as
    the one nearest to the start.

    Args:
        model: any MuJoCo model with a body that floats.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        start: coordinates of the model (nq,), or of its free joint alone (7,), which hold the
            joints, place and heading; `model.qpos0` if None.
        body: name of the root body, where several float; the first that floats freely and has
            hulls if None.
        selection: which geoms displace water, and as what.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        EquilibriumError: the vessel sinks.
        ModelError: nothing is free to float; or see `statics.building.build_vessel`.
        MeshError: a mesh bounds no volume.
    """
    vessel = build_vessel(model, water, start, body=body, selection=selection, ballast=ballast)
    vessel.check_free()
    return find_equilibria(vessel)


def find_equilibrium(vessel: Vessel, *, stable: bool = True) -> Equilibrium:
    """Find the pose in which a vessel comes to rest from where it is, see `equilibrium`."""
    pose, iterations = find_balance(vessel, vessel.rotation, stable=stable)
    return _describe(pose, iterations, held=stable)


def find_equilibria(vessel: Vessel) -> tuple[Equilibrium, ...]:
    """Find all poses in which a vessel stays at rest, lowest energy first; see `equilibria`."""
    found = [find_balance(vessel, low.rotation) for low in find_lows(vessel)]
    groups = group_poses([pose for pose, _ in found])
    rests = []
    for group in np.unique(groups):
        members = [found[i] for i in np.flatnonzero(groups == group)]
        rests.append(_describe(*_choose_nearest(vessel, members), held=True))
    return tuple(sorted(rests, key=lambda rest: rest.energy))


def _choose_nearest(
    vessel: Vessel, found: Sequence[tuple[FloatingPose, int]]
) -> tuple[FloatingPose, int]:
    """Choose the pose nearest to the attitude of a vessel, of those as low as the lowest."""
    lowest = min(pose.energy for pose, _ in found)
    highest = lowest + _LEVEL * vessel.weight * vessel.radius
    level = [(pose, steps) for pose, steps in found if pose.energy <= highest]
    return max(level, key=lambda entry: float(entry[0].rotation[2] @ vessel.rotation[2]))


def move_to_rest(vessel: Vessel, rest: Equilibrium) -> Vessel:
    """A copy of a vessel, moved to where it comes to rest."""
    start = int(vessel.model.jnt_qposadr[vessel.model.body_jntadr[vessel.root]])
    rotation = np.empty(9)
    mujoco.mju_quat2Mat(rotation, rest.qpos[start + 3 : start + 7])
    turn = rotation.reshape(3, 3)
    position = rest.qpos[start : start + 3] + turn @ vessel.centre_of_gravity
    return dataclasses.replace(vessel, qpos=rest.qpos, position=position, rotation=turn)


def _describe(pose: FloatingPose, iterations: int, *, held: bool) -> Equilibrium:
    """Describe a pose in balance, brought to the place and heading of the vessel's root body.

    Args:
        pose: the pose.
        iterations: steps of the search.
        held: whether no lower pose lies beside it.
    """
    from scipy.spatial.transform import Rotation

    vessel = pose.vessel

    # turn it back to the heading of the vessel
    before, after = (Attitude.from_matrix(at.rotation).heading for at in (vessel, pose))
    rotation = Rotation.from_rotvec([0.0, 0.0, before - after]).as_matrix() @ pose.rotation

    # the root body stays where it was, but for its height
    root = vessel.position - vessel.rotation @ vessel.centre_of_gravity
    position = root + rotation @ vessel.centre_of_gravity
    position[2] = pose.position[2]

    rest = pose_vessel(vessel, position, rotation)
    at = compute_hydrostatics(rest)
    return Equilibrium(
        qpos=vessel.qpos_at(position, rotation),
        hydrostatics=at,
        eigenvalues=_find_eigenvalues(rest, held=held),
        energy=rest.energy,
        iterations=iterations,
    )


def _find_eigenvalues(pose: FloatingPose, *, held: bool) -> NDArray[np.float64]:
    """Find the eigenvalues (3,) [1/s^2] of heave, roll and pitch, ascending."""
    eigenvalues = _compute_eigenvalues(pose, pose.stiffness)

    # a waterplane that changes at once: what holds the vessel shows in a swing
    if held and eigenvalues[0] < -INDIFFERENT * np.abs(eigenvalues).max():
        return _compute_eigenvalues(pose, _measure_stiffness(pose))
    return eigenvalues


def _compute_eigenvalues(pose: FloatingPose, stiffness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Eigenvalues (3,) [1/s^2] of stiffness over mass in heave, roll and pitch, ascending."""
    mass_matrix = compute_mass_matrix(pose, np.eye(3))[HEAVE_ROLL_PITCH, HEAVE_ROLL_PITCH]
    inverse = np.linalg.inv(np.linalg.cholesky(mass_matrix))
    symmetric = 0.5 * (stiffness + stiffness.T)
    return np.asarray(np.linalg.eigvalsh(inverse @ symmetric @ inverse.T), float)


def _measure_stiffness(pose: FloatingPose) -> NDArray[np.float64]:
    """Restoring force and torques (3, 3) per heave and turn, as in `FloatingPose.stiffness`.

    They are those of a swing of finite size, from side to side.
    """
    from scipy.spatial.transform import Rotation

    vessel, size = pose.vessel, np.diag([_SWING * pose.vessel.radius, _SWING, _SWING])

    def press(swing: NDArray[np.float64]) -> NDArray[np.float64]:
        rotation = Rotation.from_rotvec([*swing[1:], 0.0]).as_matrix() @ pose.rotation
        return pose_vessel(vessel, np.add(pose.position, [0.0, 0.0, swing[0]]), rotation).force

    columns = [(press(-swing) - press(swing)) / (2.0 * swing.sum()) for swing in size]
    return np.column_stack(columns)

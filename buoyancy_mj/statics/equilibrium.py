"""`equilibrium`: where a vessel comes to rest on still water, and whether it stays there."""

import dataclasses
import math
from collections.abc import Iterator

import mujoco
import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.balance import (
    STRIDE,
    find_balance,
    tilt,
    tilt_stiffness,
)
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.hydrostatics import Hydrostatics, compute_hydrostatics
from buoyancy_mj.statics.vessel import Vessel

INDIFFERENT = 1e-3
"""Part of the largest eigenvalue below which nothing restores worth the name: a period thirty times the shortest."""
LEVEL, SOFT = 1e-6, 1e-2
"""Energy over weight times radius by which a valley may rise, and how soft it is beside what crosses it."""


@dataclasses.dataclass(frozen=True, eq=False)
class Equilibrium:
    """A pose in which weight and buoyancy balance."""

    qpos: NDArray[np.float64]
    """Coordinates of the model (nq,), its joints as they were; heading and place of the root body are kept."""
    hydrostatics: Hydrostatics
    """Draft, heel, trim and all else there."""
    eigenvalues: NDArray[np.float64]
    """Squared frequencies of heave, roll and pitch coupled (3,) [1/s^2], ascending; what is negative tips over."""
    energy: float
    """Potential energy of weight and buoyancy [J]; of several poses the lowest is the safest."""
    iterations: int
    """Steps in attitude that it took."""

    @property
    def stability(self) -> str:
        """'stable', 'indifferent' where a motion meets no resistance (any depth, any heading of a log), or 'unstable'."""
        least = float(self.eigenvalues[0])
        small = INDIFFERENT * float(np.abs(self.eigenvalues).max())
        return "stable" if least > small else "unstable" if least < -small else "indifferent"

    @property
    def stable(self) -> bool:
        """Whether it comes back from every small push."""
        return self.stability == "stable"


def equilibrium(
    model: mujoco.MjModel,
    water: Water | None = None,
    start: ArrayLike | None = None,
    *,
    stable: bool = True,
    body: str | None = None,
    selection: Selection = Selection(),
) -> Equilibrium:
    """The pose in which a vessel comes to rest, its joints held.

    It is found by Newton steps that always lead down, see `statics.find_balance`.

    Args:
        model: any MuJoCo model with a body that floats.
        water: fresh and still at z = 0 if None; waves are left aside.
        start: coordinates of the model (nq,), or of its free joint alone (7,); the model's own if None.
        stable: False for the nearest balance, be it a summit or a saddle.
        body: name of the root body, where several float; None for the first that has hulls.
        selection: which geoms displace water, and as what.

    Raises:
        EquilibriumError: it sinks; or no balance was found near the start.
        ModelError: see `statics.build_vessel`; or nothing of it is free to float.
        MeshError: a mesh that bounds no volume.
    """
    return find_equilibrium(
        build_vessel(model, water, start, body=body, selection=selection), stable=stable
    )


def equilibria(
    model: mujoco.MjModel,
    water: Water | None = None,
    start: ArrayLike | None = None,
    *,
    body: str | None = None,
    selection: Selection = Selection(),
) -> tuple[Equilibrium, ...]:
    """Every stable pose of a vessel, its joints held; those of lowest energy first.

    The search starts from 42 attitudes all round. Poses that differ by heading alone, or by rolling
    without resistance, count once.

    Args:
        model: any MuJoCo model with a body that floats.
        water: fresh and still at z = 0 if None; waves are left aside.
        start: coordinates of the model (nq,), or of its free joint alone (7,), which hold the joints, place
            and heading; the model's own if None.
        body: name of the root body, where several float; None for the first that has hulls.
        selection: which geoms displace water, and as what.

    Raises:
        EquilibriumError: it sinks.
        ModelError: see `statics.build_vessel`; or nothing of it is free to float.
        MeshError: a mesh that bounds no volume.
    """
    return find_equilibria(build_vessel(model, water, start, body=body, selection=selection))


def find_equilibrium(vessel: Vessel, *, stable: bool = True) -> Equilibrium:
    """The pose in which a vessel comes to rest from where it is, see `equilibrium`."""
    afloat, steps = find_balance(vessel, vessel.rotation, stable=stable)
    return _equilibrium(afloat, steps)


def find_equilibria(vessel: Vessel) -> tuple[Equilibrium, ...]:
    """All poses in which a vessel stays at rest, see `equilibrium`; those of lowest energy first."""
    found: list[Equilibrium] = []
    kept: list[FloatingPose] = []
    for down in trimesh.creation.icosphere(subdivisions=1).vertices:
        turn, _ = Rotation.align_vectors([[0.0, 0.0, -1.0]], [down])
        afloat, steps = find_balance(vessel, turn.as_matrix())
        new = _equilibrium(afloat, steps)
        if new.stability != "unstable" and not any(_same(one, afloat) for one in kept):
            kept.append(afloat)
            found.append(new)
    return tuple(sorted(found, key=lambda one: one.energy))


def _equilibrium(afloat: FloatingPose, steps: int) -> Equilibrium:
    """The result, its root body's place and heading those of the vessel."""
    vessel = afloat.vessel
    heading = (
        Attitude.from_matrix(vessel.rotation).heading
        - Attitude.from_matrix(afloat.rotation).heading
    )
    turned = Rotation.from_rotvec([0.0, 0.0, heading]).as_matrix() @ afloat.rotation
    root = vessel.position - vessel.rotation @ vessel.centre_of_gravity
    place = root + turned @ vessel.centre_of_gravity
    place[2] = afloat.position[2]
    final = pose_vessel(vessel, place, turned)
    found = compute_hydrostatics(final)
    inverse = np.linalg.inv(np.linalg.cholesky(found.mass_matrix[2:5, 2:5]))
    restoring = found.stiffness[2:5, 2:5]
    return Equilibrium(
        qpos=vessel.qpos_at(final.position, final.rotation),
        hydrostatics=found,
        eigenvalues=np.asarray(
            np.linalg.eigvalsh(inverse @ (0.5 * (restoring + restoring.T)) @ inverse.T), float
        ),
        energy=final.energy,
        iterations=steps,
    )


def _same(one: FloatingPose, two: FloatingPose) -> bool:
    """Whether two poses differ by heading alone, or by a roll without resistance, as of a log."""
    scale = one.vessel.weight * one.vessel.radius
    if abs(one.energy - two.energy) > LEVEL * scale:
        return False
    if _angle(one, two) < 1e-4:
        return True
    soft, stiff = np.linalg.eigvalsh(tilt_stiffness(one))
    if stiff < SOFT * scale:
        return True
    return bool(soft < SOFT * stiff) and any(
        abs(pose.energy - one.energy) <= LEVEL * scale and _angle(pose, two) <= STRIDE
        for way in (1.0, -1.0)
        for pose in _valley(one, way)
    )


def _valley(afloat: FloatingPose, way: float) -> Iterator[FloatingPose]:
    """Poses along the softest direction, the stiff one kept in balance, once round or until they rise."""
    base, scale = afloat.energy, afloat.vessel.weight * afloat.vessel.radius
    axis = way * np.linalg.eigh(tilt_stiffness(afloat))[1][:, 0]
    for _ in range(math.ceil(2.0 * math.pi / STRIDE)):
        afloat = tilt(afloat, STRIDE * axis)
        for _ in range(2):
            values, axes = np.linalg.eigh(tilt_stiffness(afloat))
            stiff = axes[:, 1]
            if values[1] > 0.0:
                afloat = tilt(afloat, stiff * (stiff @ afloat.force[1:] / values[1]))
        axis = axes[:, 0] * np.copysign(1.0, axes[:, 0] @ axis)
        yield afloat
        if afloat.energy > base + LEVEL * scale:
            return


def _angle(one: FloatingPose, two: FloatingPose) -> float:
    """Between what is down in two poses [rad]."""
    a, b = one.rotation[2], two.rotation[2]
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))

"""`equilibrium`: where a vessel comes to rest on still water, and whether it stays there."""

import dataclasses
import math
from collections.abc import Iterator, Sequence
from typing import Literal, overload

import mujoco
import numpy as np
import trimesh
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.choice import body_name
from buoyancy_mj.errors import EquilibriumError
from buoyancy_mj.hydrostatics import Hydrostatics, attitude, hydrostatics_of
from buoyancy_mj.vessel import Afloat, Vessel, vessel_of
from buoyancy_mj.water import Water

NEUTRAL = 1e-9
"""Part of its mass by which a vessel that hovers may differ from the water it displaces."""
BALANCED = 1e-11
"""Torque over weight times radius at which a vessel is at rest."""
INDIFFERENT = 1e-6
"""Part of the largest eigenvalue below which nothing restores."""
LEVEL, SOFT = 1e-6, 1e-2
"""Energy over weight times radius by which a valley may rise, and how soft it is beside what crosses it."""
_STEPS, _LONGEST, _STRIDE = 200, 0.5, 0.1


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


@overload
def equilibrium(
    model: mujoco.MjModel, water: Water | None = ..., start: ArrayLike | None = ..., *, all: Literal[False] = ...,
    stable: bool = ..., body: str | None = ..., geoms: str | Sequence[str] | None = ...,
    hull: str | Sequence[str] | None = ..., fill: str | Sequence[str] | None = ...,
) -> Equilibrium: ...  # fmt: skip
@overload
def equilibrium(
    model: mujoco.MjModel, water: Water | None = ..., start: ArrayLike | None = ..., *, all: Literal[True],
    stable: bool = ..., body: str | None = ..., geoms: str | Sequence[str] | None = ...,
    hull: str | Sequence[str] | None = ..., fill: str | Sequence[str] | None = ...,
) -> tuple[Equilibrium, ...]: ...  # fmt: skip
def equilibrium(
    model: mujoco.MjModel,
    water: Water | None = None,
    start: ArrayLike | None = None,
    *,
    all: bool = False,  # noqa: A002
    stable: bool = True,
    body: str | None = None,
    geoms: str | Sequence[str] | None = None,
    hull: str | Sequence[str] | None = None,
    fill: str | Sequence[str] | None = None,
) -> Equilibrium | tuple[Equilibrium, ...]:
    """The pose in which a vessel comes to rest, its joints held.

    At the draft that carries its weight the energy is weight times the height of G over B, a smooth
    function of attitude alone. It is made smallest by Newton steps with the exact stiffness, negative
    curvature turned downhill, within a trust region; so each step leads down, and off a summit too.

    Args:
        model: any MuJoCo model with a body that floats.
        water: fresh and still at z = 0 if None; waves are left aside.
        start: coordinates of the model (nq,), or of its free joint alone (7,); the model's own if None.
        all: every stable pose instead of the one downhill from `start`: from 42 attitudes all round, those of
            lowest energy first; poses that differ by heading alone, or by rolling without resistance, count once.
        stable: False for the nearest balance, be it a summit or a saddle.
        body: name of the root body, where several float; None for the first that has hulls.
        geoms: which geoms displace water, see `Buoyancy`.
        hull: which of them as their convex hull, likewise.
        fill: and which displace in part, likewise.

    Raises:
        EquilibriumError: it sinks; or no balance was found near the start.
        ModelError: see `vessel.vessel_of`; or nothing of it is free to float.
        MeshError: a mesh that bounds no volume.
    """
    vessel = vessel_of(model, water, start, body=body, geoms=geoms, hull=hull, fill=fill)
    return stable_rests(vessel) if all else rest(vessel, stable=stable)


def rest(vessel: Vessel, *, stable: bool = True) -> Equilibrium:
    """The pose in which a vessel comes to rest from where it is, see `equilibrium`."""
    afloat, steps = _balanced(vessel, vessel.rotation, stable)
    return _equilibrium(afloat, steps)


def stable_rests(vessel: Vessel) -> tuple[Equilibrium, ...]:
    """All poses in which a vessel stays at rest, see `equilibrium`; those of lowest energy first."""
    found: list[Equilibrium] = []
    kept: list[Afloat] = []
    for down in trimesh.creation.icosphere(subdivisions=1).vertices:
        turn, _ = Rotation.align_vectors([[0.0, 0.0, -1.0]], [down])
        afloat, steps = _balanced(vessel, turn.as_matrix(), True)
        new = _equilibrium(afloat, steps)
        if new.stability != "unstable" and not any(_same(one, afloat) for one in kept):
            kept.append(afloat)
            found.append(new)
    return tuple(sorted(found, key=lambda one: one.energy))


def floated(vessel: Vessel, rotation: NDArray[np.float64], height: float | None = None) -> Afloat:
    """The vessel turned by world_from_vessel (3, 3), at the height at which it displaces its mass.

    Args:
        vessel: one that floats.
        rotation: its attitude.
        height: of its centre of gravity, where the search begins [m]; None for the level.
    """
    level, wanted = vessel.water.level, vessel.mass / vessel.water.density
    low, high = level - vessel.radius, level + vessel.radius
    z = level if height is None or not low < height < high else height
    while True:
        afloat = vessel.at([vessel.position[0], vessel.position[1], z], rotation)
        excess = afloat.volume - wanted
        low, high = (z, high) if excess > 0.0 else (low, z)
        if abs(excess) <= 1e-14 * vessel.volume or high - low <= 1e-15 * vessel.radius:
            return afloat
        # Newton by the waterplane, halving where that leads out
        area = afloat.waterplane[0]
        z = z + excess / area if area > 0.0 else math.inf
        if not low < z < high:
            z = 0.5 * (low + high)
            if not low < z < high:
                return afloat


def _balanced(vessel: Vessel, rotation: NDArray[np.float64], stable: bool) -> tuple[Afloat, int]:
    """Where the torques vanish at the draft that carries the weight, and the steps it took."""
    surplus = vessel.water.density * vessel.volume - vessel.mass
    name = body_name(vessel.model, vessel.root)
    if surplus < -NEUTRAL * vessel.mass:
        raise EquilibriumError(
            f"'{name}' sinks: it weighs {vessel.mass:.4g} kg and displaces {vessel.mass + surplus:.4g} kg of water fully "
            f"submerged, {-surplus:.4g} kg too little; take mass out or add foam (see ballast)"
        )
    if surplus <= NEUTRAL * vessel.mass:
        return _hovering(vessel, rotation, stable), 1
    afloat = floated(vessel, rotation)
    reach = _LONGEST
    scale = vessel.weight * vessel.radius
    for count in range(_STEPS):
        torque, stiffness = afloat.force[1:], _at_constant_displacement(afloat)
        values, axes = np.linalg.eigh(stiffness)
        size = float(np.linalg.norm(torque)) / scale
        if size <= BALANCED:
            if not stable:
                return afloat, count
            # off a summit, or a saddle; where the curvature tells nothing, look a little further
            ways = [way * part for part in (1.0, 0.1, 0.01) for way in (1.0, -1.0)] if values[0] < 1e-6 * scale else []
            pushed = (_turned(afloat, way * _STRIDE * axes[:, 0]) for way in ways)
            lower = next((pose for pose in pushed if pose.energy < afloat.energy - 1e-10 * scale), None)
            if lower is None:
                return afloat, count
            afloat = lower
            continue
        step = axes @ _step(values, axes.T @ torque, reach, downhill=stable)
        trial = _turned(afloat, step)
        if _better(trial, afloat, scale, stable):
            reach = min(2.0 * reach, _LONGEST)
            afloat = trial
        else:
            reach = 0.25 * min(reach, float(np.linalg.norm(step)))
            if reach < 1e-13:
                break
    # flat faces in the surface may leave a kink, where torques change sign at once
    if stable and reach < 1e-9:
        return afloat, count
    raise EquilibriumError(
        f"no balance of '{name}' was found near the start, only one that is off by {size * scale:.3g} N m after {count + 1} "
        "steps; start elsewhere" + ("" if stable else ", or look for a stable one")
    )


def _step(values: NDArray[np.float64], along: NDArray[np.float64], reach: float, *, downhill: bool) -> NDArray[np.float64]:
    """A turn (2,) [rad] along the axes of stiffness."""
    least = 1e-9 * np.abs(values).max() + 1e-300
    divisor = np.where(np.abs(values) > least, values, np.copysign(least, values))
    step = along / (np.abs(divisor) if downhill else divisor)
    length = float(np.linalg.norm(step))
    return step * (reach / length) if length > reach else step


def _better(trial: Afloat, afloat: Afloat, scale: float, stable: bool) -> bool:
    """Whether a step is to be taken."""
    less = bool(np.linalg.norm(trial.force[1:]) < np.linalg.norm(afloat.force[1:]))
    if not stable:
        return less
    # within rounding of the energy the torque tells more
    gain = afloat.energy - trial.energy
    return gain > 1e-13 * scale or (gain > -1e-13 * scale and less)


def _at_constant_displacement(afloat: Afloat) -> NDArray[np.float64]:
    """Restoring torques per turn about x and y (2, 2) [N m], the draft following so that the volume stays."""
    whole = afloat.stiffness
    heave = whole[0, 0]
    if heave <= 1e-12 * afloat.vessel.weight / afloat.vessel.radius:
        return whole[1:, 1:]
    return whole[1:, 1:] - np.outer(whole[1:, 0], whole[0, 1:]) / heave


def _hovering(vessel: Vessel, rotation: NDArray[np.float64], stable: bool) -> Afloat:
    """Wholly submerged, its centre of buoyancy over its centre of gravity, or if that is nearer and will do, under it."""
    arm = rotation @ vessel.centroid
    turned = rotation
    if np.linalg.norm(arm) > 1e-12 * vessel.radius:
        up = 1.0 if stable or arm[2] >= 0.0 else -1.0
        # of all turns that bring it upright the shortest
        axis, aim = np.cross(arm, [0.0, 0.0, up]), up * arm[2]
        flat = float(np.linalg.norm(axis))
        axis = axis / flat if flat > 0.0 else np.array([1.0, 0.0, 0.0])
        turned = Rotation.from_rotvec(math.atan2(flat, aim) * axis).as_matrix() @ rotation
    top = float((vessel.points @ turned[2]).max())
    place = vessel.position.copy()
    place[2] = min(place[2], vessel.water.level - top)
    return vessel.at(place, turned)


def _equilibrium(afloat: Afloat, steps: int) -> Equilibrium:
    """The result, its root body's place and heading those of the vessel."""
    vessel = afloat.vessel
    heading = attitude(vessel.rotation)[0] - attitude(afloat.rotation)[0]
    turned = Rotation.from_rotvec([0.0, 0.0, heading]).as_matrix() @ afloat.rotation
    root = vessel.position - vessel.rotation @ vessel.root_from_vessel
    place = root + turned @ vessel.root_from_vessel
    place[2] = afloat.position[2]
    final = vessel.at(place, turned)
    found = hydrostatics_of(final)
    inverse = np.linalg.inv(np.linalg.cholesky(found.mass_matrix[2:5, 2:5]))
    restoring = found.stiffness[2:5, 2:5]
    return Equilibrium(
        qpos=vessel.qpos_at(final),
        hydrostatics=found,
        eigenvalues=np.asarray(np.linalg.eigvalsh(inverse @ (0.5 * (restoring + restoring.T)) @ inverse.T), float),
        energy=final.energy,
        iterations=steps,
    )


def _same(one: Afloat, two: Afloat) -> bool:
    """Whether two poses differ by heading alone, or by a roll without resistance, as of a log."""
    scale = one.vessel.weight * one.vessel.radius
    if abs(one.energy - two.energy) > LEVEL * scale:
        return False
    if _angle(one, two) < 1e-4:
        return True
    soft, stiff = np.linalg.eigvalsh(_at_constant_displacement(one))
    if stiff < SOFT * scale:
        return True
    return bool(soft < SOFT * stiff) and any(
        abs(pose.energy - one.energy) <= LEVEL * scale and _angle(pose, two) <= _STRIDE
        for way in (1.0, -1.0)
        for pose in _valley(one, way)
    )


def _valley(afloat: Afloat, way: float) -> Iterator[Afloat]:
    """Poses along the softest direction, the stiff one kept in balance, once round or until they rise."""
    base, scale = afloat.energy, afloat.vessel.weight * afloat.vessel.radius
    axis = way * np.linalg.eigh(_at_constant_displacement(afloat))[1][:, 0]
    for _ in range(math.ceil(2.0 * math.pi / _STRIDE)):
        afloat = _turned(afloat, _STRIDE * axis)
        for _ in range(2):
            values, axes = np.linalg.eigh(_at_constant_displacement(afloat))
            stiff = axes[:, 1]
            if values[1] > 0.0:
                afloat = _turned(afloat, stiff * (stiff @ afloat.force[1:] / values[1]))
        axis = axes[:, 0] * np.copysign(1.0, axes[:, 0] @ axis)
        yield afloat
        if afloat.energy > base + LEVEL * scale:
            return


def _turned(afloat: Afloat, turn: NDArray[np.float64]) -> Afloat:
    """Turned about horizontal axes by (2,) [rad], at the draft that carries its weight."""
    rotation = Rotation.from_rotvec([*turn, 0.0]).as_matrix() @ afloat.rotation
    return floated(afloat.vessel, rotation, float(afloat.position[2]))


def _angle(one: Afloat, two: Afloat) -> float:
    """Between what is down in two poses [rad]."""
    a, b = one.rotation[2], two.rotation[2]
    return math.atan2(float(np.linalg.norm(np.cross(a, b))), float(a @ b))

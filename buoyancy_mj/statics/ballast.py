"""`ballast`: how much mass or foam, and where, brings a vessel to a wanted draft and attitude."""

import dataclasses
import math
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

from buoyancy_mj.errors import BallastError, BuoyancyWarning, ModelError, choices
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.overlaps import find_close_pairs
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS, Selection
from buoyancy_mj.meshes import shapes
from buoyancy_mj.meshes.surface import to_manifold
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.ballast_sites import (
    LEAST,
    BallastSite,
    find_ballast_sites,
    find_least_masses,
)
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.hydrostatics import Hydrostatics, compute_hydrostatics
from buoyancy_mj.statics.vessel import Vessel, VesselHull

LEAD, FOAM = 11_340.0, 200.0
"""Densities [kg/m^3] of what is added, unless said otherwise: lead, and closed-cell PVC foam as used under water."""
_NOBODY = 1 << 30
"""A contype that meets nothing, for geoms that MuJoCo must not discard as visual, as it does by default in URDF."""


@dataclasses.dataclass(frozen=True, eq=False)
class BallastItem:
    """One thing added to a vessel."""

    kind: str
    """'ballast' or 'foam'."""
    name: str
    """Of its site, or 'box'."""
    position: NDArray[np.float64]
    """Its middle in the frame of the root body (3,) [m], its joints as they were."""
    mass: float
    """[kg]."""
    density: float
    """[kg/m^3]."""
    displaces: bool
    """Whether it lies outside of the hulls, where it displaces water itself."""

    @property
    def label(self) -> str:
        """What its body is called."""
        return self.name if self.name.startswith(self.kind) else f"{self.kind}_{self.name}"

    @property
    def radius(self) -> float:
        """Of the ball that it is taken for [m]."""
        return float((self.mass / self.density * 0.75 / math.pi) ** (1.0 / 3.0))


@dataclasses.dataclass(frozen=True, eq=False)
class Ballast:
    """What to add to a vessel, and what becomes of it."""

    items: tuple[BallastItem, ...]
    """Each thing added; none where the vessel is right as it is."""
    hydrostatics: Hydrostatics
    """Of the vessel with all that, at the wanted draft and attitude."""
    root: str
    """Name of the root body."""

    @property
    def mass(self) -> float:
        """All that is added [kg]."""
        return sum(one.mass for one in self.items)

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add all that to a model that is not yet compiled: the same vehicle's, as bodies of the root body.

        Raises:
            ModelError: it has no such body, or has been ballasted already.
        """
        bodies = {body.name: body for body in spec.bodies}
        if self.root not in bodies:
            raise ModelError(
                f"there is no body '{self.root}' to carry the ballast; {choices(self.root, bodies)}"
            )
        for one in self.items:
            name = one.label
            if name in bodies:
                raise ModelError(
                    f"body '{name}' is there already; ballast the vehicle as it was, without '{name}'"
                )
            body = bodies[self.root].add_body(
                name=name, pos=one.position.tolist(), mass=one.mass, explicitinertial=True
            )
            body.ipos, body.inertia = [0.0] * 3, [0.4 * one.mass * one.radius**2] * 3
            if one.displaces:
                ball = mujoco.mjtGeom.mjGEOM_SPHERE
                body.add_geom(
                    name=name,
                    type=ball,
                    size=[one.radius, 0.0, 0.0],
                    contype=_NOBODY,
                    conaffinity=0,
                    mass=0.0,
                )
                for text in spec.texts:
                    if text.name.rsplit("/", 1)[-1] == CUSTOM_TEXTS["geoms"]:
                        text.data = f"{text.data} {name}"


def ballast(
    model: mujoco.MjModel,
    water: Water | None = None,
    *,
    draft: float | None = None,
    reserve: float | None = None,
    heel: float = 0.0,
    trim: float = 0.0,
    bg: float | None = None,
    masses: str | Sequence[str] | ArrayLike = "ballast*",
    foam: str | Sequence[str] | ArrayLike = "foam*",
    mass_density: float = LEAD,
    foam_density: float = FOAM,
    start: ArrayLike | None = None,
    body: str | None = None,
    selection: Selection = Selection(),
) -> Ballast:
    """The least ballast and foam that bring a vessel to rest as wanted, its joints held.

    Weight and buoyancy must be equal and their moments cancel at the wanted pose, and G must lie as
    far under B as wanted; all that is linear in the masses at given places, so a linear program
    (HiGHS, by scipy) finds the least. Inside a box the mass may be anywhere: its corners are the
    places, and one mass at their common centre does the same.

    What is added inside a hull displaces nothing more; outside it displaces its own volume, as a ball,
    where that is under water.

    Args:
        model: any MuJoCo model with bodies that displace water.
        water: fresh and still at z = 0 if None; waves are left aside.
        draft: wanted depth of the lowest point of its hulls [m], floating; or
        reserve: wanted lift left when it is submerged [kg], 0 for neutral.
        heel: wanted roll [rad].
        trim: wanted pitch, bow down [rad].
        bg: wanted height of B over G [m]; None for whatever comes.
        masses: where ballast may go: globs of sites, or a box (2, 3) in the frame of the root body [m].
        foam: where foam may go, likewise.
        mass_density: of the ballast [kg/m^3].
        foam_density: of the foam [kg/m^3].
        start: coordinates of the model (nq,), for its joints; the model's own if None.
        body: name of the root body, where several float; None for the first that has hulls.
        selection: which geoms displace water, and as what.

    Raises:
        BallastError: these places cannot do it; the message says what they could.
        ModelError: neither draft nor reserve, or both; values that make no sense; see also `statics.build_vessel`.
        MeshError: a mesh that bounds no volume.
    """
    if (draft is None) == (reserve is None):
        raise ModelError(
            "ballast needs either a draft [m], to float, or a reserve [kg], 0 for neutral; not both"
        )
    numbers = [value for value in (draft, reserve, heel, trim, bg) if value is not None]
    if not all(math.isfinite(value) for value in numbers) or not (
        foam_density > 0.0 and mass_density > 0.0
    ):
        raise ModelError(
            f"draft or reserve, heel, trim and bg are {numbers}, densities {mass_density:g} and {foam_density:g}; all must "
            "be finite, densities positive"
        )
    vessel = build_vessel(model, water, start, body=body, selection=selection)
    pose = _wanted(vessel, draft, heel, trim)
    # foam that lifts less than it weighs there is none
    lifting = [
        place for place in find_ballast_sites(pose, "foam", foam, foam_density) if place.lift > 1.0
    ]
    places = [*find_ballast_sites(pose, "ballast", masses, mass_density), *lifting]
    placed = _merged(vessel, places, find_least_masses(pose, places, reserve or 0.0, bg))
    after = _ballasted(vessel, placed)
    moved = pose.position + pose.rotation @ (after.centre_of_gravity - vessel.centre_of_gravity)
    result = compute_hydrostatics(pose_vessel(after, moved, pose.rotation))
    _check(after, result, reserve or 0.0, len(vessel.meshes))
    return Ballast(placed, result, body_name(model, vessel.root))


def _wanted(vessel: Vessel, draft: float | None, heel: float, trim: float) -> FloatingPose:
    """The vessel as it is, where it is wanted."""
    heading = Attitude.from_matrix(vessel.rotation).heading
    turn = Rotation.from_euler("ZYX", [heading, trim, heel]).as_matrix()
    heights = vessel.points @ turn[2]
    low, high = float(heights.min()), float(heights.max())
    if draft is None:
        height = vessel.water.level - high - vessel.radius
    elif 0.0 < draft <= high - low:
        height = vessel.water.level - draft - low
    else:
        raise BallastError(
            f"a draft of {draft:g} m is wanted of hulls {high - low:.4g} m tall at this attitude; it must be above 0 and at "
            "most that, or ask for a reserve of 0 to be neutral under water"
        )
    return pose_vessel(vessel, [*vessel.position[:2], height], turn)


def _merged(
    vessel: Vessel, places: Sequence[BallastSite], masses: NDArray[np.float64]
) -> tuple[BallastItem, ...]:
    """What goes where; the corners of a box as one."""
    result = []
    for kind, name in dict.fromkeys((place.kind, place.name) for place in places):
        own = [
            (place, mass)
            for place, mass in zip(places, masses, strict=True)
            if (place.kind, place.name) == (kind, name)
        ]
        mass = sum(share for _, share in own)
        if mass > LEAST * vessel.mass:
            middle = sum((share / mass * place.point for place, share in own), np.zeros(3))
            first = own[0][0]
            at = middle + vessel.centre_of_gravity
            result.append(BallastItem(kind, name, at, float(mass), first.density, first.displaces))
    return tuple(result)


def _ballasted(vessel: Vessel, placed: Sequence[BallastItem]) -> Vessel:
    """The vessel with all that."""
    mass = vessel.mass + sum(one.mass for one in placed)
    points = [one.position - vessel.centre_of_gravity for one in placed]
    shift = (
        sum((one.mass * point for one, point in zip(placed, points, strict=True)), np.zeros(3))
        / mass
    )
    inertia = vessel.inertia + vessel.mass * _about(shift)
    for one, point in zip(placed, points, strict=True):
        inertia = (
            inertia + one.mass * _about(point - shift) + 0.4 * one.mass * one.radius**2 * np.eye(3)
        )
    balls = [(one, point) for one, point in zip(placed, points, strict=True) if one.displaces]
    return dataclasses.replace(
        vessel,
        mass=mass,
        inertia=inertia,
        centre_of_gravity=vessel.centre_of_gravity + shift,
        position=vessel.position + vessel.rotation @ shift,
        hulls=(
            *(dataclasses.replace(hull, position=hull.position - shift) for hull in vessel.hulls),
            *(
                VesselHull(one.label, shapes.sphere(one.radius), point - shift, np.eye(3), 1.0)
                for one, point in balls
            ),
        ),
        sites={name: at - shift for name, at in vessel.sites.items()},
    )


def _about(arm: NDArray[np.float64]) -> NDArray[np.float64]:
    """Inertia per mass of a point at `arm` (Steiner)."""
    return arm @ arm * np.eye(3) - np.outer(arm, arm)


def _check(vessel: Vessel, found: Hydrostatics, reserve: float, before: int) -> None:
    """Tell what the linear program could not see; hulls from number `before` on were added."""
    off = found.displacement - reserve - found.mass
    if abs(off) > 1e-4 * found.mass:
        warnings.warn(
            f"what was added lies partly in the surface, and {abs(off):.3g} kg are {'too much' if off < 0 else 'missing'}; "
            "give it a place well under water, or well over it",
            BuoyancyWarning,
            stacklevel=3,
        )
    if not found.GM > 0.0:
        warnings.warn(
            f"as wanted it is not stable: GM is {found.GM:.4g} m, and it would turn away; ask for a greater bg, or give "
            "masses a lower place",
            BuoyancyWarning,
            stacklevel=3,
        )
    for i, j in find_close_pairs(vessel.meshes):
        pair = vessel.hulls[i].name, vessel.hulls[j].name
        if max(i, j) >= before and vessel.fills[i] == vessel.fills[j] == 1.0:
            solids = to_manifold(*vessel.meshes[i].compact), to_manifold(*vessel.meshes[j].compact)
            common = (solids[0] ^ solids[1]).volume() if solids[0] and solids[1] else 0.0
            if common > 1e-3 * min(vessel.meshes[i].volume, vessel.meshes[j].volume):
                warnings.warn(
                    f"'{pair[0]}' and '{pair[1]}' overlap by {common:.3g} m^3, which will displace once and was counted "
                    "twice; place them apart",
                    BuoyancyWarning,
                    stacklevel=3,
                )

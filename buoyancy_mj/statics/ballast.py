"""`ballast`: how much mass or foam, and where, brings a vessel to a draft and an attitude."""

import dataclasses
import math
import numbers
import warnings
from collections.abc import Iterator, Sequence

import mujoco
from numpy.typing import ArrayLike

from buoyancy_mj.errors import BallastError, BuoyancyWarning, ModelError, choices
from buoyancy_mj.hulls.scopes import find_scope
from buoyancy_mj.hulls.selection import CUSTOM_TEXTS, Selection, add_geom
from buoyancy_mj.meshes.overlaps import find_close_pairs, measure_overlaps
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.attitude import Attitude
from buoyancy_mj.statics.ballast_items import BallastItem, add_items, merge_sites
from buoyancy_mj.statics.ballast_program import find_least_masses
from buoyancy_mj.statics.ballast_sites import find_ballast_sites
from buoyancy_mj.statics.building import build_vessel
from buoyancy_mj.statics.floating_pose import FloatingPose, pose_vessel
from buoyancy_mj.statics.hydrostatics import Hydrostatics, compute_hydrostatics
from buoyancy_mj.statics.vessel import Vessel

LEAD = 11_340.0
"""Density of ballast [kg/m^3] by default: lead."""
FOAM = 200.0
"""Density of foam [kg/m^3] by default: closed-cell PVC foam, as used under water."""
_OVERLAP = 1e-3
"""Part of the smaller of two hulls from which on their overlap is worth a warning."""
_NOBODY = 1 << 30
"""A contype that meets nothing.

MuJoCo discards geoms without one as visual, by default in URDF."""


@dataclasses.dataclass(frozen=True, eq=False)
class Ballast:
    """What to add to a vessel, and what becomes of it."""

    items: tuple[BallastItem, ...]
    """Each thing added; none where the vessel is right as it is."""
    hydrostatics: Hydrostatics
    """Hydrostatics of the vessel with all items, at its target draft and attitude."""
    root: str
    """Name of the root body."""

    @property
    def mass(self) -> float:
        """Mass of all items [kg]."""
        return sum(item.mass for item in self.items)

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add all items to the specification of the same vehicle, as bodies of its root body.

        Raises:
            ModelError: the specification has no such body, or has the items already.
        """
        bodies = {body.name: body for body in spec.bodies}
        if self.root not in bodies:
            raise ModelError(
                f"there is no body '{self.root}' to carry the ballast; {choices(self.root, bodies)}"
            )
        for item in self.items:
            if item.label in bodies:
                raise ModelError(
                    f"body '{item.label}' is there already; "
                    f"ballast the vehicle as it was, without '{item.label}'"
                )
            _add_item(spec, bodies[self.root], item)


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
    """Find the least ballast and foam that bring a vessel to rest at a draft and an attitude.

    Weight and buoyancy must be equal in that pose and their moments cancel, and G must lie under B
    by `bg`. All that is linear in the masses at the sites, so a linear program (HiGHS, by scipy)
    finds the least. Inside a box the mass may be anywhere: the corners of the box are its sites,
    and one mass at their common centre does the same.

    What is added inside a hull displaces nothing more. Outside it displaces its own volume, as a
    ball, where that is under water.

    Args:
        model: any MuJoCo model with bodies that displace water; its joints are held.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        draft: depth of the lowest point of the hulls [m], for a vessel that floats; or
        reserve: lift left when it is submerged [kg], 0 for neutral.
        heel: roll [rad].
        trim: pitch, bow down [rad].
        bg: height of B over G [m]; None for any.
        masses: where ballast may go: globs of sites, or a box, its lowest and highest corner (2, 3)
            [m] in the frame of the root body.
        foam: where foam may go: globs of sites, or a box.
        mass_density: of the ballast [kg/m^3].
        foam_density: of the foam [kg/m^3].
        start: coordinates of the model (nq,), for its joints; `model.qpos0` if None.
        body: name of the root body, where several float; the first that floats freely and has
            hulls if None.
        selection: which geoms displace water, and as what.

    Raises:
        BallastError: the sites cannot do it; the message says what they could.
        ModelError: neither draft nor reserve is given, or both are; a number makes no sense; joints
            or a weld hold the vessel; or see `statics.building.build_vessel`.
        MeshError: a mesh bounds no volume.

    Example:
        `ballast(model, reserve=0.0, masses=[[-0.4, -0.1, -0.1], [0.4, 0.1, 0.0]]).add_to(spec)`
    """
    _check_numbers(draft, reserve, (heel, trim, bg), (mass_density, foam_density))
    vessel = build_vessel(model, water, start, body=body, selection=selection)
    vessel.check_free()
    pose = _pose_at_target(vessel, draft, heel, trim)

    # the sites, less those where foam lifts less than it weighs
    sites = find_ballast_sites(pose, "foam", foam, foam_density)
    sites = [site for site in sites if site.lift > 1.0]
    sites = [*find_ballast_sites(pose, "ballast", masses, mass_density), *sites]

    # the vessel with all that is added, its hulls where they were
    items = merge_sites(vessel, sites, find_least_masses(pose, sites, reserve or 0.0, bg))
    after = add_items(vessel, items)
    shift = after.centre_of_gravity - vessel.centre_of_gravity
    at = compute_hydrostatics(
        pose_vessel(after, pose.position + pose.rotation @ shift, pose.rotation)
    )

    # what the linear program could not see
    for doubt in _list_doubts(after, at, reserve or 0.0, added_from=len(vessel.hulls)):
        warnings.warn(doubt, BuoyancyWarning, stacklevel=2)
    return Ballast(items, at, vessel.name)


def _check_numbers(
    draft: float | None,
    reserve: float | None,
    others: Sequence[float | None],
    densities: tuple[float, float],
) -> None:
    """Refuse numbers that make no sense."""
    if (draft is None) == (reserve is None):
        which = "neither is" if draft is None else "both are"
        raise ModelError(
            "ballast needs either a draft [m], to float, or a reserve [kg], 0 for neutral, "
            f"and {which} given"
        )
    given = [value for value in (draft, reserve, *others) if value is not None]
    are_numbers = all(isinstance(value, numbers.Real) for value in (*given, *densities))
    if not (are_numbers and all(map(math.isfinite, given)) and min(densities) > 0.0):
        raise ModelError(
            f"draft or reserve, heel, trim and bg are {given}, "
            f"densities {' and '.join(map(str, densities))}; "
            "all must be finite numbers, densities positive"
        )


def _pose_at_target(vessel: Vessel, draft: float | None, heel: float, trim: float) -> FloatingPose:
    """The vessel as it is, at its target draft [m] or deep under water, at its target attitude."""
    heading = Attitude.from_matrix(vessel.rotation).heading
    rotation = Attitude(heading, trim, heel).as_matrix()
    low, high = vessel.heights(rotation)
    if draft is None:
        height = vessel.water.level - high - vessel.radius
    elif 0.0 < draft <= high - low:
        height = vessel.water.level - draft - low
    else:
        raise BallastError(
            f"a draft of {draft:g} m is wanted of hulls {high - low:.4g} m tall at this attitude; "
            "it must be above 0 and at most that, "
            "or ask for a reserve of 0 to be neutral under water"
        )
    return pose_vessel(vessel, [*vessel.position[:2], height], rotation)


def _list_doubts(
    vessel: Vessel, at: Hydrostatics, reserve: float, added_from: int
) -> Iterator[str]:
    """Sentences on a ballasted vessel that floats otherwise than the linear program found.

    Args:
        vessel: the vessel with its ballast.
        at: its hydrostatics.
        reserve: its target reserve [kg].
        added_from: index of the first of its hulls that was added.
    """
    missing = at.displacement - reserve - at.mass
    if abs(missing) > 1e-4 * at.mass:
        yield (
            f"what was added lies partly in the surface, and {abs(missing):.3g} kg are "
            f"{'too much' if missing < 0 else 'missing'}; "
            "give it a place well under water, or well over it"
        )
    if not at.GM > 0.0:
        yield (
            f"as wanted it is not stable: GM is {at.GM:.4g} m, and it would turn away; "
            "ask for a greater bg, or give masses a lower place"
        )
    pairs = [
        (i, j)
        for i, j in find_close_pairs(vessel.meshes)
        if max(i, j) >= added_from and vessel.fills[i] == vessel.fills[j] == 1.0
    ]
    for i, j, volume in measure_overlaps(vessel.meshes, pairs):
        if volume > _OVERLAP * min(vessel.meshes[i].volume, vessel.meshes[j].volume):
            yield (
                f"'{vessel.hulls[i].name}' and '{vessel.hulls[j].name}' overlap by "
                f"{volume:.3g} m^3, which will displace once and was counted twice; "
                "place them apart"
            )


def _add_item(spec: mujoco.MjSpec, root: mujoco.MjsBody, item: BallastItem) -> None:
    """Add an item to the root body of a specification, and to its choice of geoms."""
    body = root.add_body(
        name=item.label, pos=item.position.tolist(), mass=item.mass, explicitinertial=True
    )
    body.ipos = [0.0] * 3
    body.inertia = [item.inertia] * 3
    if not item.displaces:
        return
    body.add_geom(
        name=item.label,
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[item.radius, 0.0, 0.0],
        contype=_NOBODY,
        conaffinity=0,
        mass=0.0,
    )

    # whichever choice of geoms its name belongs to
    texts = [(find_scope(text.name, CUSTOM_TEXTS["geoms"]), text) for text in spec.texts]
    mine = [(scope, text) for scope, text in texts if scope and scope.has(item.label)]
    if mine:
        scope, text = max(mine, key=lambda pair: pair[0].length)
        text.data = add_geom(text.data, scope.own_name(item.label))

"""`inspect`: the truth about a model before it is put to sea: its meshes, what displaces, and whether it floats."""

import dataclasses
import math
import warnings
from collections.abc import Sequence

import mujoco
import numpy as np
from numpy.typing import NDArray

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning, MeshError
from buoyancy_mj.hulls.geoms import build_hulls, diagnose_geom, read_geom_mesh
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name, geom_kind, geom_name
from buoyancy_mj.hulls.overlaps import OVERLAP, find_close_pairs
from buoyancy_mj.hulls.patterns import parse_fills, parse_shapes
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.verdicts import Verdict, judge_geoms
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.meshes.mesh import TriMesh
from buoyancy_mj.meshes.shapes import convex_hull
from buoyancy_mj.meshes.surface import to_manifold
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.balance import NEUTRAL, find_heave_balance
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.equilibrium import Equilibrium, find_equilibria, find_equilibrium
from buoyancy_mj.statics.righting import RightingArm, compute_righting_arm
from buoyancy_mj.statics.vessel import PLAUSIBLE, Vessel

LEVELLED = 1e-4
"""Fall of energy, over weight times radius, below which a vessel rests as drawn."""
THIN, HOLLOW = 0.02, 0.3
"""A wall is thin below this part of its mesh's size, and a mesh hollow below this part of its convex hull."""
_STANDARD = 1000.0
"""Density [kg/m^3] that MuJoCo gives to what states no mass."""


@dataclasses.dataclass(frozen=True, eq=False)
class GeomInspection:
    """A geom, whether it displaces water, and its mesh."""

    name: str
    """Of the geom."""
    body: str
    """Name of its body."""
    kind: str
    """'mesh', 'box', 'sphere', ..."""
    displaces: bool
    """Whether it displaces water."""
    reason: str
    """Why, or why not."""
    convex: bool
    """Whether it does as its convex hull."""
    fill: float
    """Part of its volume that displaces."""
    mesh: TriMesh | None
    """Its mesh in its own frame; None where it displaces nothing, or was refused."""
    centroid: NDArray[np.float64] | None
    """Of its volume, in the frame of its body (3,) [m]; None without a mesh."""
    diagnosis: Diagnosis | None
    """What is wrong with its mesh; None of other geoms and convex hulls."""
    notes: tuple[str, ...]
    """What else there is to know of it."""


@dataclasses.dataclass(frozen=True)
class BuoyancyBudget:
    """What one body weighs and displaces."""

    body: str
    """Its name."""
    mass: float
    """[kg]."""
    displacement: float
    """Mass of the water that it displaces fully submerged [kg]."""
    gravity: float
    """[m/s^2]."""

    @property
    def reserve(self) -> float:
        """How much it could carry [kg], negative where it is too heavy."""
        return self.displacement - self.mass

    @property
    def lift(self) -> float:
        """The same as an upward force [N]."""
        return self.reserve * self.gravity


@dataclasses.dataclass(frozen=True, eq=False)
class VesselInspection:
    """What floats together, whether it does, and how."""

    vessel: Vessel
    """Where the model has it."""
    bodies: tuple[BuoyancyBudget, ...]
    """Of each of its bodies that weighs or displaces."""
    sentence: str
    """What a person wants to know."""
    rest: Equilibrium | None
    """Where it comes to rest from there; None where it sinks, or is not free to float."""
    rests: tuple[Equilibrium, ...]
    """All poses in which it stays."""
    righting: RightingArm | None
    """Righting arms from where it rests."""
    notes: tuple[str, ...]
    """What else there is to know."""

    @property
    def at_rest(self) -> Vessel:
        """The vessel where it comes to rest; where the model has it, if it does not."""
        return self.vessel if self.rest is None else _at(self.vessel, self.rest)

    @property
    def total(self) -> BuoyancyBudget:
        """Of all its bodies."""
        vessel = self.vessel
        name = body_name(vessel.model, vessel.root)
        return BuoyancyBudget(
            name, vessel.mass, vessel.water.density * vessel.volume, vessel.gravity
        )

    @property
    def centre_of_gravity(self) -> NDArray[np.float64]:
        """In the frame of its root body (3,) [m]."""
        return self.vessel.centre_of_gravity

    @property
    def centre_of_buoyancy(self) -> NDArray[np.float64]:
        """Fully submerged, in the frame of its root body (3,) [m]."""
        return self.vessel.centre_of_gravity + self.vessel.centroid


@dataclasses.dataclass(frozen=True, eq=False)
class Inspection:
    """All that is known of a model."""

    title: str
    """What it is called."""
    water: Water
    """The water it was inspect_model in."""
    geoms: tuple[GeomInspection, ...]
    """Its geoms."""
    overlaps: tuple[tuple[str, str, float], ...]
    """Pairs of hulls of different bodies that overlap, and the volume counted twice [m^3]."""
    vessels: tuple[VesselInspection, ...]
    """What floats together."""
    problems: tuple[str, ...]
    """Why a part or the whole cannot be put to sea, with the mend."""


def inspect_model(
    model: mujoco.MjModel,
    water: Water | None = None,
    *,
    selection: Selection = Selection(),
    title: str = "model",
) -> Inspection:
    """Inspect a model: a mesh that is refused is named and left out, and the rest goes on.

    Args:
        model: any; vehicles on free joints float, others are weighed.
        water: fresh and still at z = 0 if None; waves are left aside.
        selection: which geoms displace water, and as what.
        title: what it is called.

    Raises:
        ModelError: no geom displaces water, or a choice that makes no sense.
    """
    sea = water or Water()
    verdicts = judge_geoms(model, selection)
    chosen = [verdict.geom for verdict in verdicts if verdict.displaces]
    forms = parse_shapes(model, chosen, selection)
    fills = parse_fills(model, chosen, selection)
    problems: list[str] = []
    parts = [
        _part(model, verdict, forms.get(verdict.geom) == "convex", fills, problems)
        for verdict in verdicts
    ]
    sound = [
        verdict.geom for verdict, part in zip(verdicts, parts, strict=True) if part.mesh is not None
    ]
    if not sound:
        return Inspection(title, sea, tuple(parts), (), (), tuple(problems))
    told: list[str] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        hulls = build_hulls(model, sound, forms, fills)
        # what was mended in meshes stands with them
        mended = {notice for part in parts if part.diagnosis for notice in part.diagnosis.notices}
        told += [str(entry.message) for entry in caught if str(entry.message) not in mended]
    floating = []
    for root in dict.fromkeys(int(model.body_rootid[one.body]) for one in hulls):
        try:
            floating.append(
                _floating(
                    build_vessel_from_hulls(model, hulls, sea, body=body_name(model, root)), hulls
                )
            )
        except BuoyancyError as error:
            problems.append(str(error))
    return Inspection(
        title, sea, tuple(parts), _overlaps(model, hulls), tuple(floating), (*problems, *told)
    )


def _part(
    model: mujoco.MjModel,
    verdict: Verdict,
    convex: bool,
    fills: dict[int, float],
    problems: list[str],
) -> GeomInspection:
    """A geom as it was found."""
    geom = verdict.geom
    mesh, found, notes = None, None, []
    if verdict.displaces:
        found = None if convex else diagnose_geom(model, geom)
        arrays = read_geom_mesh(model, geom)
        assert arrays is not None
        if found is not None:
            mesh = found.mesh
            problems += [found.refusal] if found.refusal else []
        else:
            try:
                mesh = (
                    convex_hull(arrays[0], f"geom '{geom_name(model, geom)}'")
                    if convex
                    else TriMesh(*arrays)
                )
            except MeshError as error:
                problems.append(str(error))
        if found is not None and mesh is not None:
            notes = _walls(mesh)
    centroid = None
    if mesh is not None:
        turn = np.empty(9)
        mujoco.mju_quat2Mat(turn, model.geom_quat[geom])
        centroid = turn.reshape(3, 3) @ mesh.centroid + model.geom_pos[geom]
    return GeomInspection(
        name=geom_name(model, geom),
        body=body_name(model, int(model.geom_bodyid[geom])),
        kind=geom_kind(model, geom),
        displaces=verdict.displaces,
        reason=verdict.reason,
        convex=convex,
        fill=fills.get(geom, 1.0),
        mesh=mesh,
        centroid=centroid,
        diagnosis=found,
        notes=tuple(notes),
    )


def _walls(mesh: TriMesh) -> list[str]:
    """A closed surface with two sides, whose inside the sea may enter."""
    whole = convex_hull(mesh.compact[0]).volume
    share, wall = mesh.volume / whole, 2.0 * mesh.volume / mesh.area
    if share < HOLLOW and wall < THIN * whole ** (1.0 / 3.0):
        return [
            f"its walls are about {1e3 * wall:.3g} mm thick and it displaces {share:.1%} of its convex hull, as if the sea "
            "stood inside; if it is a closed hull, export its outer surface alone, or take its convex hull (--hull convex)"
        ]
    return []


def _overlaps(model: mujoco.MjModel, hulls: Sequence[Hull]) -> tuple[tuple[str, str, float], ...]:
    """Pairs of hulls of different bodies that overlap where the model has them."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    placed = [
        hull.mesh.transformed(data.geom_xmat[hull.geom].reshape(3, 3), data.geom_xpos[hull.geom])
        for hull in hulls
    ]
    solids = {}
    found = []
    for i, j in find_close_pairs(placed):
        if hulls[i].body == hulls[j].body:
            continue
        for k in (i, j):
            if k not in solids:
                solids[k] = to_manifold(*placed[k].compact)
        one, two = solids[i], solids[j]
        common = (one ^ two).volume() if one is not None and two is not None else 0.0
        if common > OVERLAP * min(placed[i].volume, placed[j].volume):
            found.append((hulls[i].name, hulls[j].name, float(common)))
    return tuple(found)


def _floating(vessel: Vessel, hulls: Sequence[Hull]) -> VesselInspection:
    """Whether a vessel floats, and how."""
    notes = _doubts(vessel)
    surplus = vessel.water.density * vessel.volume - vessel.mass
    found: Equilibrium | None = None
    all_found: tuple[Equilibrium, ...] = ()
    righting: RightingArm | None = None
    if vessel.free and surplus >= -NEUTRAL * vessel.mass:
        try:
            found, all_found = find_equilibrium(vessel), find_equilibria(vessel)
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always", BuoyancyWarning)
                righting = compute_righting_arm(
                    vessel, np.radians(np.arange(181.0)), upright=_at(vessel, found).rotation
                )
            notes += [str(entry.message) for entry in caught]
        except BuoyancyError as error:
            notes.append(str(error))
    shares = _shares(vessel, hulls)
    return VesselInspection(
        vessel, shares, _sentence(vessel, surplus, found), found, all_found, righting, tuple(notes)
    )


def _at(vessel: Vessel, found: Equilibrium) -> Vessel:
    """The vessel where it rests."""
    position = found.hydrostatics.centre_of_gravity
    turn = np.empty(9)
    start = int(vessel.model.jnt_qposadr[vessel.model.body_jntadr[vessel.root]])
    mujoco.mju_quat2Mat(turn, found.qpos[start + 3 : start + 7])
    return dataclasses.replace(
        vessel, qpos=found.qpos, position=position, rotation=turn.reshape(3, 3)
    )


def _sentence(vessel: Vessel, surplus: float, found: Equilibrium | None) -> str:
    """What a person wants to know."""
    if surplus < -NEUTRAL * vessel.mass:
        return f"sinks: {-surplus:.3g} kg too heavy"
    if not vessel.free:
        return f"is held by its joints: free, it would float with {surplus:.3g} kg reserve"
    if found is None:
        return f"floats: {surplus:.3g} kg reserve, but no rest pose was found"
    if surplus <= NEUTRAL * vessel.mass:
        return f"hovers: neutral, BG {found.hydrostatics.BG:.3g} m"
    at = found.hydrostatics
    lean = math.degrees(math.acos(max(-1.0, min(1.0, math.cos(at.heel) * math.cos(at.trim)))))
    drawn = vessel.rotation[2] @ _at(vessel, found).rotation[2]
    # a ball rests as well as drawn
    drop = find_heave_balance(vessel, vessel.rotation).energy - found.energy
    if drop < LEVELLED * vessel.weight * vessel.radius:
        return f"floats: {surplus:.3g} kg reserve, draft {at.draft:.3g} m, {found.stability}, GM {at.GM:.3g} m"
    tipped = "" if drawn > math.cos(math.radians(5.0)) else ", not as drawn"
    heel, trim = (round(math.degrees(angle), 1) + 0.0 for angle in (at.heel, at.trim))
    leaning = f", heel {heel:.1f}, trim {trim:.1f} degrees" if lean > 0.1 else ""
    return f"floats: {surplus:.3g} kg reserve, draft {at.draft:.3g} m, {found.stability}, GM {at.GM:.3g} m{leaning}{tipped}"


def _doubts(vessel: Vessel) -> list[str]:
    """What looks like a slip."""
    notes = []
    ratio = vessel.water.density * vessel.volume / vessel.mass
    if not PLAUSIBLE[0] <= ratio <= PLAUSIBLE[1]:
        notes.append(
            f"it weighs {vessel.mass:.4g} kg and would displace {ratio * vessel.mass:.4g} kg of water; check the scale of "
            "its meshes (a mesh drawn in millimetres wants scale='0.001 0.001 0.001')"
        )
    if abs(vessel.mass - _STANDARD * vessel.volume) < 1e-3 * vessel.mass:
        notes.append(
            f"it weighs just what {_STANDARD:g} kg/m^3 makes of its volume: MuJoCo's choice where a model states no mass; "
            "give its bodies <inertial>, or its geoms mass"
        )
    return notes


def _shares(vessel: Vessel, hulls: Sequence[Hull]) -> tuple[BuoyancyBudget, ...]:
    """What its bodies weigh and displace; a body without joints counts with the one it moves with."""
    model = vessel.model
    tree = np.flatnonzero(model.body_rootid == vessel.root)
    shares = []
    for body in np.unique(model.body_weldid[tree]):
        mass = float(model.body_mass[tree][model.body_weldid[tree] == body].sum())
        volume = sum(hull.displaced_volume for hull in hulls if hull.body == body)
        if mass > 0.0 or volume > 0.0:
            shares.append(
                BuoyancyBudget(
                    body_name(model, int(body)), mass, vessel.water.density * volume, vessel.gravity
                )
            )
    return tuple(shares)

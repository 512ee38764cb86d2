"""`inspect_model`: all that can be said of a model before it is put to sea."""

import dataclasses
import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from buoyancy_mj.errors import BuoyancyError, BuoyancyWarning
from buoyancy_mj.hulls.ballast_volumes import read_volumes
from buoyancy_mj.hulls.bodies import group_floating_bodies
from buoyancy_mj.hulls.geoms import build_hulls
from buoyancy_mj.hulls.hull import Hull
from buoyancy_mj.hulls.names import body_name
from buoyancy_mj.hulls.overlaps import OVERLAP
from buoyancy_mj.hulls.patterns import parse_fills, parse_shapes
from buoyancy_mj.hulls.placed_ballasts import PlacedBallast, find_ballasts
from buoyancy_mj.hulls.selection import Selection
from buoyancy_mj.hulls.tethers import list_roots
from buoyancy_mj.hulls.verdicts import judge_geoms
from buoyancy_mj.inspection.geoms import GeomInspection, inspect_geom
from buoyancy_mj.inspection.vessels import VesselInspection, inspect_vessel
from buoyancy_mj.loads.added_mass import find_estimates
from buoyancy_mj.loads.added_mass_estimates import Estimate
from buoyancy_mj.loads.foil_arrays import PlacedFoil, find_foils
from buoyancy_mj.meshes.overlaps import find_close_pairs, measure_overlaps
from buoyancy_mj.sea.water import Water
from buoyancy_mj.statics.building import build_vessel_from_hulls
from buoyancy_mj.statics.vessel import Vessel


class Overlap(NamedTuple):
    """Two hulls of different bodies that overlap, so that a volume counts twice."""

    one: str
    """Name of a hull."""
    other: str
    """Name of the other."""
    volume: float
    """Volume that counts twice [m^3]."""


@dataclasses.dataclass(frozen=True, eq=False)
class Inspection:
    """All that is known of a model."""

    title: str
    """Title of the report."""
    water: Water
    """The water in which the model was inspected."""
    geoms: tuple[GeomInspection, ...]
    """All geoms of the model, in its order."""
    overlaps: tuple[Overlap, ...]
    """Hulls of different bodies that overlap."""
    foils: tuple[PlacedFoil, ...]
    """Its foils: fins, rudders, keels and wings."""
    ballast: tuple[tuple[PlacedBallast, float], ...]
    """Its bladders, tanks and compartments, and what each holds [m^3]."""
    vessels: tuple[VesselInspection, ...]
    """Each vessel: a kinematic tree with hulls, or what welds and connects hold together."""
    problems: tuple[str, ...]
    """Why a geom, a vessel or the whole cannot be put to sea, with the mend."""
    added_mass: Mapping[str, Estimate] = dataclasses.field(default_factory=dict)
    """Added mass by the name of the body; empty if it was not asked for, or a mesh is refused."""


def inspect_model(
    model: mujoco.MjModel,
    water: Water | None = None,
    *,
    selection: Selection = Selection(),
    title: str = "model",
    added_mass: str | Mapping[str, ArrayLike] | None = None,
    ballast: Mapping[str, float] | ArrayLike | None = None,
) -> Inspection:
    """Inspect a model; a mesh that is refused is named and left out, and the rest goes on.

    Args:
        model: any model; vehicles on free joints float, others are weighed.
        water: the sea, whose still level alone counts; fresh water with its level at z = 0 if None.
        selection: which geoms displace water, and as what.
        title: title of the report.
        added_mass: where added mass comes from that is to be reported, as `Buoyancy` takes it; None
            to report none.
        ballast: what tanks, compartments and bladders hold: volumes [m^3] by name, or the states of
            actuators (na,), as `data.act`; None for empty.

    Raises:
        ModelError: no geom displaces water, or the selection, the added mass, a foil or ballast
            makes no sense.
    """
    water = water or Water()

    # the geoms, each by itself
    verdicts = judge_geoms(model, selection)
    selected = [verdict.geom for verdict in verdicts if verdict.displaces]
    forms = parse_shapes(model, selected, selection)
    fills = parse_fills(model, selected, selection)
    geoms = tuple(
        inspect_geom(model, verdict, selected, forms, fill=fills.get(verdict.geom, 1.0))
        for verdict in verdicts
    )
    foils = find_foils(model)
    placed = find_ballasts(model)
    held = tuple(zip(placed, read_volumes(model, placed, ballast), strict=True))
    problems = [geom.problem for geom in geoms if geom.problem]
    sound = [
        verdict.geom for verdict, geom in zip(verdicts, geoms, strict=True) if geom.mesh is not None
    ]
    if not sound:
        return Inspection(title, water, geoms, (), foils, held, (), tuple(problems))

    # the hulls; the report names repairs with the meshes, so they are no problems here
    hulls, notices = _build_hulls(model, sound, forms, fills)
    repairs = {notice for geom in geoms if geom.diagnosis for notice in geom.diagnosis.notices}
    notices = [notice for notice in notices if notice not in repairs]

    # the vessels
    vessels = []
    for root in _find_roots(model, hulls):
        try:
            vessel, notices_of_vessel = _build_vessel(model, hulls, water, root, ballast)
            refused = _list_refused(vessel, geoms)
            vessels.append(inspect_vessel(vessel, hulls, refused, notices_of_vessel))
        except BuoyancyError as error:
            problems.append(str(error))

    # added mass, where all hulls are known
    found: dict[str, Estimate] = {}
    if len(sound) == len(selected):
        found, doubts = _find_added_mass(model, hulls, foils, water, added_mass)
        notices += doubts
    return Inspection(
        title=title,
        water=water,
        geoms=geoms,
        overlaps=_find_overlaps(model, hulls),
        foils=foils,
        ballast=held,
        vessels=tuple(vessels),
        problems=(*problems, *notices),
        added_mass=found,
    )


def _build_hulls(
    model: mujoco.MjModel,
    geoms: Sequence[int],
    forms: Mapping[int, str],
    fills: Mapping[int, float],
) -> tuple[tuple[Hull, ...], list[str]]:
    """Hulls of geoms, and the warnings that came with them."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        hulls = build_hulls(model, geoms, forms, fills)
    return hulls, [str(entry.message) for entry in caught]


def _find_added_mass(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    foils: Sequence[PlacedFoil],
    water: Water,
    source: str | Mapping[str, ArrayLike] | None,
) -> tuple[dict[str, Estimate], list[str]]:
    """Added mass by the name of the body, and the warnings that came with it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        found = find_estimates(model, hulls, water.density, source, foils)
    by_name = {body_name(model, body): estimate for body, estimate in sorted(found.items())}
    return by_name, [str(entry.message) for entry in caught]


def _build_vessel(
    model: mujoco.MjModel,
    hulls: Sequence[Hull],
    water: Water,
    root: str,
    ballast: Mapping[str, float] | ArrayLike | None,
) -> tuple[Vessel, list[str]]:
    """The vessel with a root body, and the warnings that came with it."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", BuoyancyWarning)
        vessel = build_vessel_from_hulls(model, hulls, water, body=root, ballast=ballast)
    return vessel, [str(entry.message) for entry in caught]


def _find_roots(model: mujoco.MjModel, hulls: Sequence[Hull]) -> list[str]:
    """Name of a root of each vessel, the first that has hulls."""
    roots = []
    for bodies in group_floating_bodies(model):
        with_hulls = [hull.body for hull in hulls if hull.body in bodies]
        if with_hulls:
            roots.append(body_name(model, list_roots(model, np.array(with_hulls))[0]))
    return roots


def _list_refused(vessel: Vessel, geoms: Sequence[GeomInspection]) -> list[str]:
    """Names of the geoms of a vessel that should displace water and are refused."""
    bodies = {body_name(vessel.model, body) for body in vessel.bodies.tolist()}
    return [
        geom.name for geom in geoms if geom.displaces and geom.mesh is None and geom.body in bodies
    ]


def _find_overlaps(model: mujoco.MjModel, hulls: Sequence[Hull]) -> tuple[Overlap, ...]:
    """Find hulls of different bodies that overlap where the model has them."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    meshes = [
        hull.mesh.transformed(data.geom_xmat[hull.geom].reshape(3, 3), data.geom_xpos[hull.geom])
        for hull in hulls
    ]
    pairs = [(i, j) for i, j in find_close_pairs(meshes) if hulls[i].body != hulls[j].body]
    return tuple(
        Overlap(hulls[i].name, hulls[j].name, volume)
        for i, j, volume in measure_overlaps(meshes, pairs)
        if volume > OVERLAP * min(meshes[i].volume, meshes[j].volume)
    )

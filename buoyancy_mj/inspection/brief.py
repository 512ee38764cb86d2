"""The report in brief: what displaces, where the vessels rest, and little else."""

import math
from collections.abc import Sequence

from buoyancy_mj.inspection.geoms import GeomInspection
from buoyancy_mj.inspection.groups import group_geoms
from buoyancy_mj.inspection.inspection import Inspection
from buoyancy_mj.inspection.sentences import join_names
from buoyancy_mj.inspection.tables import (
    Section,
    format_bound,
    format_degrees,
    format_number,
    format_numbers,
)
from buoyancy_mj.inspection.vessel_sections import describe_centres, describe_free_surface
from buoyancy_mj.inspection.vessels import VesselInspection

OVERLAP = 1e-3
"""Part of the volume that is told if it is inside of other geoms."""
_MOST_NAMED = 4
"""Most names in a sentence; of more the first are told, and how many there are."""


def write_verdicts(inspection: Inspection) -> list[str]:
    """Whether each vessel floats, and how many problems there are, a sentence each."""
    verdicts = []
    for vessel in inspection.vessels:
        names = vessel.root_names
        who = names[0] if len(names) == 1 else f"{join_names(names)}, held together,"
        verdicts.append(f"{who}{':' if vessel.refused else ''} {vessel.sentence}")
    count = len(inspection.problems)
    if count:
        verdicts.append(f"{count} problem{'' if count == 1 else 's'}, told below")
    return verdicts


def describe_in_brief(inspection: Inspection) -> list[Section]:
    """The geoms in groups, and each vessel at rest."""
    sections = [_describe_groups(inspection)]
    alone = len(inspection.vessels) == 1
    for vessel in inspection.vessels:
        title = "At rest" if alone else f"'{vessel.total.body}' at rest"
        sections.append(_describe_vessel(title, vessel))
    return sections


def _describe_groups(inspection: Inspection) -> Section:
    """What displaces water, equal geoms in one row."""
    groups = group_geoms(inspection)
    whole = sum(group.total for group in groups)
    bodies = {group.geoms[0].body for group in groups}
    rows = []
    for group in groups:
        first = group.geoms[0]
        part = f", {first.fill:.0%} of it" if first.fill < 1.0 else ""
        shape = "convex hull" if first.convex else first.kind
        volumes = (format_number(1e3 * group.volume), format_number(1e3 * group.total))
        where = (first.body,) if len(bodies) > 1 else ()
        share = f"{100.0 * group.total / whole:.1f}"
        rows.append((group.name + part, *where, shape, *volumes, share))
    where = ("body",) if len(bodies) > 1 else ()
    header = ("what displaces water", *where, "shape", "each [l]", "in all [l]", "share [%]")
    notes = [*_note_overlap(inspection, whole), *_note_geoms(inspection.geoms)]
    return Section(inspection.title, header, tuple(rows), tuple(notes))


def _note_overlap(inspection: Inspection, volume: float) -> list[str]:
    """A sentence on what counts once, since geoms of a `volume` [m^3] in all overlap."""
    displaced = sum(one.total.displacement / one.vessel.water.density for one in inspection.vessels)
    if displaced <= 0.0 or volume - displaced < OVERLAP * volume:
        return []
    return [
        f"{format_number(1e3 * (volume - displaced))} l of it is inside of other geoms and counts "
        f"once, so {format_number(1e3 * displaced)} l displace"
    ]


def _note_geoms(geoms: Sequence[GeomInspection]) -> list[str]:
    """Sentences on geoms that do not displace, and on meshes."""
    notes = []
    reasons: dict[str, list[str]] = {}
    for geom in geoms:
        if not geom.displaces:
            reasons.setdefault(geom.reason, []).append(geom.name)
    notes += [f"not {_name_some(names)}: {reason}" for reason, names in reasons.items()]

    meshes = [geom for geom in geoms if geom.diagnosis is not None]
    sound = [geom for geom in meshes if geom.mesh is not None and not _list_faults(geom)]
    if meshes and len(sound) == len(meshes):
        notes.append("all its meshes are watertight" if meshes[1:] else "its mesh is watertight")
    faults = [fault for geom in meshes for fault in _list_faults(geom)]
    return [*notes, *dict.fromkeys(faults)]


def _list_faults(geom: GeomInspection) -> list[str]:
    """What was found of a mesh that is not as it should be."""
    assert geom.diagnosis is not None
    return [*geom.diagnosis.notices, *(f"{geom.name}: {note}" for note in geom.notes)]


def _name_some(names: Sequence[str]) -> str:
    """The first of some names, and how many others there are."""
    if len(names) <= _MOST_NAMED:
        return join_names(names)
    first = [f"'{name}'" for name in names[: _MOST_NAMED - 1]]
    return f"{', '.join(first)} and {len(names) - len(first)} more"


def _describe_vessel(title: str, inspection: VesselInspection) -> Section:
    """What a vessel weighs, and how it rests, beside what each number is judged by."""
    total, known = inspection.total, not inspection.refused
    rows = [("mass", f"{format_number(total.mass)} kg", "")]
    if known:
        share = total.displacement / total.mass if total.mass else math.nan
        told = f"{format_number(total.displacement)} kg"
        rows.append(("displaces under water", told, f"{share:.2f} x its mass"))
    notes = list(inspection.notes)
    if inspection.rest is None:
        title = title.replace("At rest", "Weight").replace("at rest", "weighs")
        if known:
            notes.insert(0, describe_centres(inspection))
        return Section(title, (), tuple(rows), tuple(notes))

    # at rest
    at = inspection.rest.hydrostatics
    low, high = inspection.vessel.heights(inspection.at_rest.rotation)
    across, along = (format_number(value) for value in (at.GMt, at.GMl))
    heel, trim = (format_degrees(angle, 1) for angle in (at.heel, at.trim))
    rows += [
        ("draft", f"{format_number(at.draft)} m", f"of {format_number(high - low)} m height"),
        ("heel, trim", f"{heel}, {trim} degrees", ""),
        ("GM across, along", f"{across}, {along} m", inspection.rest.stability),
        *(
            (name, f"{lost} {unit}", "across, along")
            for name, lost, unit in describe_free_surface(at)
        ),
        (
            "natural periods",
            f"{format_numbers([float(f'{period:.3g}') for period in at.natural_periods()])} s",
            "heave, roll, pitch, no added mass",
        ),
    ]
    arm = inspection.righting
    if arm is not None:
        angle, largest = arm.maximum
        rows += [
            (
                "largest righting arm",
                f"{format_number(largest)} m",
                f"at {math.degrees(angle):.0f} degrees of heel",
            ),
            ("vanishing stability", f"{format_bound(arm.vanishing)} degrees", "of heel"),
        ]
    others = len(inspection.rests) - 1
    if others > 0:
        notes.insert(0, f"it rests in {others} other pose{'' if others == 1 else 's'} too")
    return Section(title, (), tuple(rows), tuple(notes))

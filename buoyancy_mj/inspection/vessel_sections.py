"""Sections of a report on a vessel: whether it floats, its rest poses, its righting arm."""

import math
from collections.abc import Sequence

import numpy as np

from buoyancy_mj.inspection.sentences import join_names
from buoyancy_mj.inspection.tables import (
    Section,
    format_bound,
    format_degrees,
    format_number,
    format_numbers,
    format_point,
)
from buoyancy_mj.inspection.vessels import BuoyancyBudget, VesselInspection
from buoyancy_mj.statics.equilibrium import Equilibrium
from buoyancy_mj.statics.hydrostatics import Hydrostatics
from buoyancy_mj.statics.righting import RightingArm

_CARRIED = 2
"""Column of a budget that tells what gravity compensation carries."""


def describe_vessel(inspection: VesselInspection, *, alone: bool) -> list[Section]:
    """Describe whether a vessel floats, and how it rests.

    Args:
        inspection: the vessel.
        alone: whether it is the only one, so that titles need not name it.
    """
    name = f"'{inspection.total.body}'"
    sections = [_describe_budgets(inspection)]
    if inspection.rest is not None:
        rest, rests = inspection.rest, inspection.rests
        sections.append(_describe_rest("At rest" if alone else f"{name} at rest", rest))
        who = "it" if alone else name
        sections.append(_compare_rests(f"Every pose in which {who} rests", rests))
    if inspection.righting is not None:
        title = f"Righting arm{'' if alone else f' of {name}'} from there, trim free"
        sections.append(_describe_righting(title, inspection.righting))
    return sections


def _describe_budgets(inspection: VesselInspection) -> Section:
    """What each body weighs and displaces, and all of them."""
    total = inspection.total
    alone = len(inspection.root_names) == 1
    budgets = [(total.body, total)]
    if len(inspection.bodies) > 1:
        budgets = [(budget.body, budget) for budget in inspection.bodies]
        budgets.append((f"{total.body}, all" if alone else "all", total))
    known = not inspection.refused
    rows = [_list_budget(name, budget, known=known) for name, budget in budgets]

    # what gravity compensation carries has a column where it acts
    compensated = any(budget.carried for _, budget in budgets)
    header = ("body", "mass [kg]", "carried [kg]", "displaces [kg]", "reserve [kg]", "net lift [N]")
    kept = [i for i in range(len(header)) if compensated or i != _CARRIED]

    together = "" if alone else ", held together,"
    return Section(
        title=f"Will {join_names(inspection.root_names)}{together} float?",
        header=tuple(header[i] for i in kept),
        rows=tuple(tuple(row[i] for i in kept) for row in rows),
        notes=(
            inspection.sentence,
            *((describe_centres(inspection),) if known else ()),
            *inspection.notes,
        ),
    )


def describe_centres(inspection: VesselInspection) -> str:
    """Where the centres of gravity and of buoyancy are, and how far apart."""
    name = inspection.total.body
    frame = "its own frame" if len(inspection.root_names) == 1 else f"the frame of '{name}'"
    distance = round(float(np.linalg.norm(inspection.vessel.centroid)), 6)
    return (
        f"CG {format_point(inspection.centre_of_gravity)} m, "
        f"CB submerged {format_point(inspection.centre_of_buoyancy)} m in {frame}, "
        f"{format_number(distance)} m apart"
    )


def _list_budget(name: str, budget: BuoyancyBudget, *, known: bool) -> tuple[str, ...]:
    """Cells of a budget; '-' where the water that it displaces is not known."""
    water = (format_number(budget.displacement), f"{budget.reserve:+.4g}", f"{budget.lift:+.4g}")
    return (
        name,
        format_number(budget.mass),
        format_number(budget.carried),
        *(water if known else ("-", "-", "-")),
    )


def _describe_rest(title: str, rest: Equilibrium) -> Section:
    """Hydrostatics where the vessel comes to rest."""
    at = rest.hydrostatics
    waterline = format_numbers((at.waterline_length, at.waterline_beam))
    _, _, heave, roll, pitch, _ = np.diag(at.stiffness).tolist()
    eigenvalues = f"eigenvalues {format_numbers(rest.eigenvalues)} 1/s^2"
    rows = (
        ("draft", format_number(at.draft), "m"),
        ("heel, trim", f"{format_degrees(at.heel, 2)}, {format_degrees(at.trim, 2)}", "degrees"),
        ("displacement", format_number(at.displacement), "kg"),
        ("volume", format_number(1e3 * at.volume), "l"),
        ("wetted area", format_number(at.wetted_area), "m^2"),
        ("waterplane area", format_number(at.waterplane_area), "m^2"),
        ("waterline length, beam", waterline, "m"),
        ("KB, KG, BG", format_numbers((at.KB, at.KG, at.BG)), "m"),
        ("BM across, along", format_numbers((at.BMt, at.BMl)), "m"),
        ("GM across, along", format_numbers((at.GMt, at.GMl)), "m"),
        *describe_free_surface(at),
        (
            "periods of heave, roll, pitch",
            format_numbers(at.natural_periods()),
            "s, no added mass",
        ),
        ("stiffness of heave", format_number(heave), "N/m"),
        ("stiffness of roll, pitch", format_numbers((roll, pitch)), "N m"),
        ("stability", rest.stability, eigenvalues),
    )
    return Section(title, (), rows)


def describe_free_surface(at: Hydrostatics) -> tuple[tuple[str, str, str], ...]:
    """What the water in tanks takes off GM; nothing without free surfaces."""
    if not at.free_surface.any():
        return ()
    lost = (at.KMt - at.KG - at.GMt, at.KMl - at.KG - at.GMl)
    return (("of it lost to free surfaces", format_numbers(lost), "m"),)


def _compare_rests(title: str, rests: Sequence[Equilibrium]) -> Section:
    """All rest poses, their energy over that of the lowest."""
    rows = tuple(
        (
            format_degrees(rest.hydrostatics.heel),
            format_degrees(rest.hydrostatics.trim),
            format_number(rest.hydrostatics.draft),
            format_number(rest.hydrostatics.GM),
            rest.stability,
            format_number(rest.energy - rests[0].energy),
        )
        for rest in rests
    )
    header = ("heel [deg]", "trim [deg]", "draft [m]", "GM [m]", "stability", "energy [J]")
    return Section(title, header, rows)


def _describe_righting(title: str, arm: RightingArm) -> Section:
    """The largest righting arm, and the heels where the curve ends and sites go under."""
    heel, largest = arm.maximum
    rows = (
        (
            "largest righting arm",
            format_number(largest),
            f"m at {math.degrees(heel):.0f} degrees of heel",
        ),
        ("angle of vanishing stability", format_bound(arm.vanishing), "degrees"),
        ("area under the curve", format_number(arm.area()), "m rad"),
        *(
            (f"'{name}' goes under", format_bound(angle), "degrees")
            for name, angle in arm.immersed.items()
        ),
    )
    return Section(title, (), rows)

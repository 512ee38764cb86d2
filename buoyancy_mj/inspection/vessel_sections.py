"""Sections of a report on a vessel: whether it floats, its rest poses, its righting arm."""

import math
from collections.abc import Sequence

import numpy as np

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
from buoyancy_mj.statics.righting import RightingArm


def describe_vessel(inspection: VesselInspection) -> list[Section]:
    """Describe whether a vessel floats, and how it rests."""
    sections = [_describe_budgets(inspection)]
    if inspection.rest is not None:
        sections.append(_describe_rest(inspection.rest))
        sections.append(_compare_rests(inspection.rests))
    if inspection.righting is not None:
        sections.append(_describe_righting(inspection.righting))
    return sections


def _describe_budgets(inspection: VesselInspection) -> Section:
    """What each body weighs and displaces, and all of them."""
    total = inspection.total
    rows = [_list_budget(total.body, total)]
    if len(inspection.bodies) > 1:
        rows = [
            *(_list_budget(budget.body, budget) for budget in inspection.bodies),
            _list_budget(f"{total.body}, all", total),
        ]
    distance = round(float(np.linalg.norm(inspection.vessel.centroid)), 6)
    centres = (
        f"CG {format_point(inspection.centre_of_gravity)} m, "
        f"CB submerged {format_point(inspection.centre_of_buoyancy)} m in its own frame, "
        f"{format_number(distance)} m apart"
    )
    return Section(
        title=f"Will '{total.body}' float?",
        header=("body", "mass [kg]", "displaces [kg]", "reserve [kg]", "net lift [N]"),
        rows=tuple(rows),
        notes=(inspection.sentence, centres, *inspection.notes),
    )


def _list_budget(name: str, budget: BuoyancyBudget) -> tuple[str, ...]:
    """Cells of a budget."""
    return (
        name,
        format_number(budget.mass),
        format_number(budget.displacement),
        f"{budget.reserve:+.4g}",
        f"{budget.lift:+.4g}",
    )


def _describe_rest(rest: Equilibrium) -> Section:
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
        (
            "periods of heave, roll, pitch",
            format_numbers(at.natural_periods()),
            "s, no added mass",
        ),
        ("stiffness of heave", format_number(heave), "N/m"),
        ("stiffness of roll, pitch", format_numbers((roll, pitch)), "N m"),
        ("stability", rest.stability, eigenvalues),
    )
    return Section("At rest", (), rows)


def _compare_rests(rests: Sequence[Equilibrium]) -> Section:
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
    return Section("Every pose in which it rests", header, rows)


def _describe_righting(arm: RightingArm) -> Section:
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
    return Section("Righting arm from there, trim free", (), rows)

"""An `Inspection` as text: tables for a terminal, and Markdown."""

from collections.abc import Mapping, Sequence

import numpy as np
from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from buoyancy_mj.hulls.placed_ballasts import PlacedBallast
from buoyancy_mj.inspection.brief import describe_in_brief, write_verdicts
from buoyancy_mj.inspection.geom_sections import describe_geoms, describe_meshes
from buoyancy_mj.inspection.inspection import Inspection, Overlap
from buoyancy_mj.inspection.tables import Section, format_degrees, format_number
from buoyancy_mj.inspection.vessel_sections import describe_vessel
from buoyancy_mj.loads.added_mass_estimates import Estimate
from buoyancy_mj.loads.foil_arrays import PlacedFoil

_MOTIONS = ("surge", "sway", "heave", "roll", "pitch", "yaw")


def list_sections(inspection: Inspection) -> tuple[Section, ...]:
    """List the sections of a report, in the order in which a person asks."""
    sections = [
        describe_geoms(inspection.title, inspection.geoms),
        *describe_meshes(inspection.geoms),
        *_list_parts(inspection),
    ]
    for vessel in inspection.vessels:
        sections += describe_vessel(vessel, alone=len(inspection.vessels) == 1)
    return (*sections, *_list_rest(inspection))


def _list_parts(inspection: Inspection) -> list[Section]:
    """Sections on what vessels have beside their geoms."""
    sections = []
    if inspection.overlaps:
        sections.append(_describe_overlaps(inspection.overlaps))
    if inspection.foils:
        sections.append(_describe_foils(inspection.foils))
    if inspection.ballast:
        sections.append(_describe_ballast(inspection.ballast))
    return sections


def _list_rest(inspection: Inspection) -> list[Section]:
    """Sections that come last."""
    sections = []
    if inspection.added_mass:
        sections.append(_describe_added_mass(inspection.added_mass))
    if inspection.problems:
        sections.append(Section("Problems", (), (), inspection.problems))
    return sections


def to_tables(
    inspection: Inspection, steps: Sequence[tuple[str, str]] = (), *, details: bool = True
) -> Group:
    """Write the report for a terminal: the verdict, what it rests on, and what to do next.

    Args:
        inspection: what was found.
        steps: what to do next, and how.
        details: whether to tell of each geom and mesh, and of all rest poses.
    """
    parts: list[RenderableType] = [
        Text(verdict, style="bold") for verdict in write_verdicts(inspection)
    ]
    for section in list_sections(inspection) if details else _list_brief(inspection):
        parts += [Text(), _draw_table(section) if section.rows else Text(section.title, "italic")]
        parts += [Text(note) for note in section.notes]
    if steps:
        parts += [Text(), Text("Next", style="italic")]
        parts += [Text(f" {what}:\n   {how}") for what, how in steps]
    return Group(*parts)


def _list_brief(inspection: Inspection) -> list[Section]:
    """The sections of a report in brief."""
    groups, *vessels = describe_in_brief(inspection)
    return [groups, *_list_parts(inspection), *vessels, *_list_rest(inspection)]


def to_markdown(inspection: Inspection, pictures: Sequence[tuple[str, str]] = ()) -> str:
    """Write the report as Markdown, with pictures (caption, file) at its end."""
    lines = [f"# {inspection.title}", ""]
    lines += [line for verdict in write_verdicts(inspection) for line in (f"**{verdict}**", "")]
    for section in list_sections(inspection):
        lines += [f"## {section.title}", ""]
        if section.rows:
            marks = [
                "---:" if section.is_numeric(i) else "---" for i in range(len(section.columns))
            ]
            rows = (section.columns, marks, *section.rows)
            lines += [*(_write_row(row) for row in rows), ""]
        lines += [line for note in section.notes for line in (note, "")]
    for caption, file in pictures:
        lines += [f"![{caption}]({file})", ""]
    return "\n".join(lines)


def _describe_overlaps(overlaps: Sequence[Overlap]) -> Section:
    """Hulls of different bodies that overlap."""
    return Section(
        title="Overlaps between bodies",
        header=("hull", "hull", "litres counted twice"),
        rows=tuple((one, other, format_number(1e3 * volume)) for one, other, volume in overlaps),
    )


def _describe_ballast(ballast: Sequence[tuple[PlacedBallast, float]]) -> Section:
    """Bladders, tanks and compartments, and what they hold."""
    return Section(
        title="Ballast systems",
        header=("name", "kind", "capacity [l]", "holds [l]"),
        rows=tuple(
            (
                one.name,
                one.ballast.kind,
                format_number(1e3 * one.capacity),
                format_number(1e3 * volume),
            )
            for one, volume in ballast
        ),
    )


def _describe_foils(foils: Sequence[PlacedFoil]) -> Section:
    """Fins, rudders, keels and wings."""
    return Section(
        title="Foils",
        header=("foil", "area [m^2]", "aspect ratio", "lift slope [1/rad]", "stall [degrees]"),
        rows=tuple(
            (
                foil.name,
                format_number(foil.area),
                format_number(foil.aspect_ratio),
                format_number(foil.lift_slope),
                format_degrees(foil.stall),
            )
            for foil in foils
        ),
    )


def _describe_added_mass(estimates: Mapping[str, Estimate]) -> Section:
    """Added mass of each body fully under water, and where it comes from."""
    rows = []
    for name, estimate in estimates.items():
        share = f"{100.0 * estimate.change:.1f}" if estimate.triangles else "-"
        diagonal = (format_number(value) for value in np.diag(estimate.matrix))
        rows.append((name, *diagonal, estimate.method, share))
    return Section(
        title="Added mass fully submerged, about the origin of each body [kg, kg m^2]",
        header=("body", *_MOTIONS, "from", "doubt [%]"),
        rows=tuple(rows),
    )


def _draw_table(section: Section) -> Table:
    """A section's table for a terminal, its numbers to the right."""
    table = Table(
        title=section.title,
        title_justify="left",
        show_header=bool(section.header),
        box=SIMPLE_HEAD,
        pad_edge=False,
        padding=(0, 1, 0, 0),
    )
    for i, name in enumerate(section.columns):
        table.add_column(
            name,
            justify="right" if section.is_numeric(i) else "left",
            no_wrap=i == 0,
            overflow="fold",
            min_width=section.measure_words(i),
        )
    for row in section.rows:
        table.add_row(*row)
    return table


def _write_row(cells: Sequence[str]) -> str:
    """A row of a table in Markdown."""
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

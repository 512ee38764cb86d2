"""An `Inspection` for people and programs: tables for the terminal, Markdown, and plain values for JSON."""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rich.box import SIMPLE_HEAD
from rich.console import Group
from rich.table import Table
from rich.text import Text

from buoyancy_mj.inspection.inspection import (
    BuoyancyBudget,
    GeomInspection,
    Inspection,
    VesselInspection,
)
from buoyancy_mj.meshes.diagnosis import Diagnosis
from buoyancy_mj.statics.equilibrium import Equilibrium
from buoyancy_mj.statics.righting import RightingArm


@dataclasses.dataclass(frozen=True)
class Section:
    """A table with a title, and sentences under it."""

    title: str
    """Its heading."""
    header: tuple[str, ...]
    """Names of the columns; none for a table of names and values."""
    rows: tuple[tuple[str, ...], ...]
    """Cells."""
    notes: tuple[str, ...] = ()
    """Sentences."""


def sections(found: Inspection) -> tuple[Section, ...]:
    """All there is to tell, in the order in which a person asks."""
    result = [_what_displaces(found)]
    meshes = [(part, part.diagnosis) for part in found.geoms if part.diagnosis is not None]
    if meshes:
        result.append(_meshes(meshes))
    if found.overlaps:
        rows = tuple((one, two, _number(1e3 * volume)) for one, two, volume in found.overlaps)
        result.append(
            Section("Overlaps between bodies", ("hull", "hull", "litres counted twice"), rows)
        )
    for floating in found.vessels:
        result += _floats(floating)
    if found.problems:
        result.append(Section("Problems", (), (), found.problems))
    return tuple(result)


def to_tables(found: Inspection) -> Group:
    """The report for a terminal."""
    parts: list[Any] = []
    for section in sections(found):
        if section.rows:
            table = Table(
                title=section.title,
                title_justify="left",
                show_header=bool(section.header),
                box=SIMPLE_HEAD,
                pad_edge=False,
                padding=(0, 1, 0, 0),
            )
            for i, name in enumerate(section.header or ("",) * len(section.rows[0])):
                table.add_column(
                    name,
                    justify="right" if _numeric(section.rows, i) else "left",
                    no_wrap=i == 0,
                    overflow="fold",
                    min_width=_word(section.rows, i),
                )
            for row in section.rows:
                table.add_row(*row)
            parts.append(table)
        else:
            parts.append(Text(section.title, style="italic"))
        parts += [Text(note) for note in section.notes]
    return Group(*parts)


def to_markdown(found: Inspection, pictures: Sequence[tuple[str, str]] = ()) -> str:
    """The report as Markdown, with pictures (caption, file) at its end."""
    lines = [f"# {found.title}", ""]
    for section in sections(found):
        lines += [f"## {section.title}", ""]
        if section.rows:
            header = section.header or ("",) * len(section.rows[0])
            marks = ["---:" if _numeric(section.rows, i) else "---" for i in range(len(header))]
            lines += [_row(header), _row(marks), *(_row(row) for row in section.rows), ""]
        lines += [line for note in section.notes for line in (note, "")]
    for caption, file in pictures:
        lines += [f"![{caption}]({file})", ""]
    return "\n".join(lines)


# sections


def _what_displaces(found: Inspection) -> Section:
    rows = []
    for part in found.geoms:
        shape = "convex hull" if part.convex else part.kind
        verdict = "yes" if part.mesh is not None else "refused" if part.displaces else "no"
        size = ("", "", "")
        if part.mesh is not None and part.centroid is not None:
            size = (_number(1e3 * part.mesh.volume), _number(part.mesh.area), _point(part.centroid))
        flooded = f"{part.fill:.0%} of it" if part.fill < 1.0 else ""
        rows.append((part.name, part.body, shape, f"{verdict}: {part.reason}", *size, flooded))
    header = (
        "geom",
        "body",
        "shape",
        "displaces",
        "volume [l]",
        "area [m^2]",
        "centroid [m]",
        "displacing",
    )
    # what is alike in all rows tells nothing
    kept = [i for i in range(len(header)) if i not in (1, 7) or len({row[i] for row in rows}) > 1]
    cells = tuple(tuple(row[i] for i in kept) for row in rows)
    return Section(f"{found.title}: what displaces water", tuple(header[i] for i in kept), cells)


def _meshes(meshes: Sequence[tuple[GeomInspection, Diagnosis]]) -> Section:
    alike: dict[tuple[str, ...], list[str]] = {}
    for part, mesh in meshes:
        size = " x ".join(_number(side) for side in mesh.extents)
        alike.setdefault((f"{mesh.triangles:,}", str(mesh.pieces), size, _state(mesh)), []).append(
            part.name
        )
    rows = tuple(
        (names[0] + (f" and {len(names) - 1} more" if names[1:] else ""), *cells)
        for cells, names in alike.items()
    )
    notes = [
        text
        for part, mesh in meshes
        for text in (*mesh.notices, *(f"{part.name}: {note}" for note in part.notes))
    ]
    return Section(
        "Meshes",
        ("geom", "triangles", "pieces", "size [m]", "state"),
        rows,
        tuple(dict.fromkeys(notes)),
    )


def _state(mesh: Diagnosis) -> str:
    """What was found of a mesh, in a few words."""
    words = ["watertight" if mesh.pieces and not mesh.holes else "open"]
    if mesh.holes:
        longest = max(hole.perimeter for hole in mesh.holes)
        words = [
            f"{len(mesh.holes)} holes, to {_number(longest)} m round, {_number(1e3 * mesh.uncertain_volume)} l in doubt"
        ]
    crossing = 1e3 * (mesh.doubled_volume + mesh.inside_out_volume)
    for count, what in (
        (mesh.backwards, f"{mesh.backwards} wound backwards"),
        (mesh.inverted, f"{mesh.inverted} inside out"),
        (mesh.degenerate, f"{mesh.degenerate} degenerate"),
        (mesh.duplicates, f"{mesh.duplicates} doubled"),
        (mesh.shells, f"{mesh.shells} inner shells"),
        (mesh.joined_volume, f"pieces joined, {_number(1e3 * mesh.joined_volume)} l less"),
        (crossing, f"crosses itself, {_number(crossing)} l"),
        (mesh.refusal, "refused"),
    ):
        if count:
            words.append(what)
    return ", ".join(words)


def _floats(floating: VesselInspection) -> list[Section]:
    total = floating.total
    shares: list[BuoyancyBudget] = (
        [*floating.bodies, total] if len(floating.bodies) > 1 else [total]
    )
    rows = [
        (share.body + (", all" if share is total and len(shares) > 1 else ""), _number(share.mass), _number(share.displacement),
         f"{share.reserve:+.4g}", f"{share.lift:+.4g}") for share in shares
    ]  # fmt: skip
    header = ("body", "mass [kg]", "displaces [kg]", "reserve [kg]", "net lift [N]")
    centres = (
        f"CG {_point(floating.centre_of_gravity)} m, CB submerged {_point(floating.centre_of_buoyancy)} m in its own frame, "
        f"{_number(round(float(np.linalg.norm(floating.vessel.centroid)), 6))} m apart"
    )
    result = [
        Section(
            f"Will '{total.body}' float?",
            header,
            tuple(rows),
            (floating.sentence, centres, *floating.notes),
        )
    ]
    if floating.rest is not None:
        result.append(_at_rest(floating.rest))
        result.append(_rests(floating.rests))
    if floating.righting is not None:
        result.append(_righting(floating.righting))
    return result


def _at_rest(found: Equilibrium) -> Section:
    at = found.hydrostatics
    heave, roll, pitch = at.natural_periods()
    rows = [
        ("draft", _number(at.draft), "m"),
        ("heel, trim", f"{_degrees(at.heel, 2)}, {_degrees(at.trim, 2)}", "degrees"),
        ("displacement", _number(at.displacement), "kg"),
        ("volume", _number(1e3 * at.volume), "l"),
        ("wetted area", _number(at.wetted_area), "m^2"),
        ("waterplane area", _number(at.waterplane_area), "m^2"),
        (
            "waterline length, beam",
            f"{_number(at.waterline_length)}, {_number(at.waterline_beam)}",
            "m",
        ),
        ("KB, KG, BG", f"{_number(at.KB)}, {_number(at.KG)}, {_number(at.BG)}", "m"),
        ("BM across, along", f"{_number(at.BMt)}, {_number(at.BMl)}", "m"),
        ("GM across, along", f"{_number(at.GMt)}, {_number(at.GMl)}", "m"),
        (
            "periods of heave, roll, pitch",
            ", ".join(map(_number, (heave, roll, pitch))),
            "s, no added mass",
        ),
        ("stiffness of heave", _number(float(at.stiffness[2, 2])), "N/m"),
        (
            "stiffness of roll, pitch",
            f"{_number(float(at.stiffness[3, 3]))}, {_number(float(at.stiffness[4, 4]))}",
            "N m",
        ),
        (
            "stability",
            found.stability,
            "eigenvalues " + ", ".join(map(_number, found.eigenvalues)) + " 1/s^2",
        ),
    ]
    return Section("At rest", (), tuple(rows))


def _rests(rests: Sequence[Equilibrium]) -> Section:
    rows = tuple(
        (
            _degrees(one.hydrostatics.heel), _degrees(one.hydrostatics.trim),
            _number(one.hydrostatics.draft), _number(one.hydrostatics.GM), one.stability,
            _number(one.energy - rests[0].energy),
        )
        for one in rests
    )  # fmt: skip
    header = ("heel [deg]", "trim [deg]", "draft [m]", "GM [m]", "stability", "energy [J]")
    return Section("Every pose in which it rests", header, rows)


def _righting(arm: RightingArm) -> Section:
    heel, largest = arm.maximum
    rows = [
        (
            "largest righting arm",
            _number(largest),
            f"m at {math.degrees(heel):.0f} degrees of heel",
        ),
        ("angle of vanishing stability", _angle(arm.vanishing), "degrees"),
        ("area under the curve", _number(arm.area()), "m rad"),
        *((f"'{name}' goes under", _angle(at), "degrees") for name, at in arm.immersed.items()),
    ]
    return Section("Righting arm from there, trim free", (), tuple(rows))


# cells


def _number(value: float) -> str:
    return f"{value:.4g}" if math.isfinite(value) else "-"


def _angle(value: float) -> str:
    return f"{math.degrees(value):.1f}" if math.isfinite(value) else "none"


def _point(values: NDArray[np.float64]) -> str:
    # what is below a hundredth of a millimetre nobody builds
    return "(" + ", ".join(f"{value:.4g}" for value in np.round(values, 5) + 0.0) + ")"


def _degrees(angle: float, digits: int = 1) -> str:
    return f"{round(math.degrees(angle), digits) + 0.0:.{digits}f}"


def _numeric(rows: Sequence[Sequence[str]], column: int) -> bool:
    """Whether a column holds numbers alone."""
    cells = [row[column].replace(",", "") for row in rows]
    return all(
        cell in ("", "-") or cell.lstrip("+-").replace(".", "").replace("e-", "").isdigit()
        for cell in cells
    )


def _word(rows: Sequence[Sequence[str]], column: int) -> int:
    """Length of the longest word of a column, that it be not broken; of monsters a part."""
    return min(14, max(len(word) for row in rows for word in [*row[column].split(), ""]))


def _row(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"

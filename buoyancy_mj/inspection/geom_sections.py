"""Sections of a report on geoms: which displace water, and the state of their meshes."""

from collections.abc import Sequence

from buoyancy_mj.inspection.geoms import GeomInspection
from buoyancy_mj.inspection.tables import Section, format_number, format_point
from buoyancy_mj.meshes.diagnosis import Diagnosis

_HEADER = (
    "geom", "body", "shape", "displaces", "volume [l]", "area [m^2]", "centroid [m]", "displacing",
)  # fmt: skip
_LEFT_OUT_IF_ALIKE = ("body", "displacing")
"""Columns that tell nothing where all their cells are alike."""


def describe_geoms(title: str, geoms: Sequence[GeomInspection]) -> Section:
    """Describe which geoms displace water, and how much."""
    rows = [_describe_geom(geom) for geom in geoms]
    kept = [
        i
        for i, name in enumerate(_HEADER)
        if name not in _LEFT_OUT_IF_ALIKE or len({row[i] for row in rows}) > 1
    ]
    return Section(
        title=f"{title}: what displaces water",
        header=tuple(_HEADER[i] for i in kept),
        rows=tuple(tuple(row[i] for i in kept) for row in rows),
    )


def _describe_geom(geom: GeomInspection) -> tuple[str, ...]:
    """Cells of a geom, one for each name of `_HEADER`."""
    shape = "convex hull" if geom.convex else geom.kind
    verdict = f"{'yes' if geom.displaces else 'no'}: {geom.reason}"
    if geom.displaces and geom.mesh is None:
        verdict = "refused, see the problems"
    size = ("", "", "")
    if geom.mesh is not None and geom.centroid is not None:
        size = (
            format_number(1e3 * geom.mesh.volume),
            format_number(geom.mesh.area),
            format_point(geom.centroid),
        )
    part = f"{geom.fill:.0%} of it" if geom.fill < 1.0 else ""
    return (geom.name, geom.body, shape, verdict, *size, part)


def describe_meshes(geoms: Sequence[GeomInspection]) -> list[Section]:
    """Describe the state of the meshes of geoms, like ones in one row; nothing without meshes."""
    diagnoses = [(geom, geom.diagnosis) for geom in geoms if geom.diagnosis is not None]
    if not diagnoses:
        return []

    # the geoms that share all cells
    alike: dict[tuple[str, ...], list[str]] = {}
    for geom, mesh in diagnoses:
        size = " x ".join(format_number(side) for side in mesh.extents)
        cells = (f"{mesh.triangles:,}", str(mesh.pieces), size, _describe_state(mesh))
        alike.setdefault(cells, []).append(geom.name)
    rows = tuple(
        (names[0] + (f" and {len(names) - 1} more" if names[1:] else ""), *cells)
        for cells, names in alike.items()
    )

    notes = [
        text
        for geom, mesh in diagnoses
        for text in (*mesh.notices, *(f"{geom.name}: {note}" for note in geom.notes))
    ]
    header = ("geom", "triangles", "pieces", "size [m]", "state")
    return [Section("Meshes", header, rows, tuple(dict.fromkeys(notes)))]


def _describe_state(mesh: Diagnosis) -> str:
    """Describe the faults of a mesh in a few words."""
    words = ["watertight" if mesh.pieces and not mesh.holes else "open"]
    if mesh.holes:
        longest = max(hole.perimeter for hole in mesh.holes)
        words = [
            f"{_count(len(mesh.holes), 'hole')}, to {format_number(longest)} m round, "
            f"{format_number(1e3 * mesh.uncertain_volume)} l in doubt"
        ]
    joined = 1e3 * mesh.joined_volume
    crossing = 1e3 * (mesh.doubled_volume + mesh.inside_out_volume)
    faults = (
        (mesh.stitched, f"{mesh.stitched} vertices joined"),
        (mesh.backwards, f"{mesh.backwards} wound backwards"),
        (mesh.inverted, f"{mesh.inverted} inside out"),
        (mesh.degenerate, f"{mesh.degenerate} degenerate"),
        (mesh.duplicates, f"{mesh.duplicates} doubled"),
        (mesh.shells, _count(mesh.shells, "inner shell")),
        (joined, f"pieces joined, {format_number(joined)} l less"),
        (crossing, f"crosses itself, {format_number(crossing)} l"),
        (mesh.refusal, "refused"),
    )
    return ", ".join(words + [text for fault, text in faults if fault])


def _count(number: int, noun: str) -> str:
    """A number of things."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"

"""The page that shows the reproduction: the claims beside what is measured, and the figures."""

import os
import platform
from collections.abc import Sequence
from importlib.metadata import version

from buoyancy_mj.paper.contents import STUDIES

PAGE_TITLE = "# The source paper, reproduced"
"""The first line of the page."""


def render_page(header: Sequence[str], rows: Sequence[tuple[str, ...]], *, quick: bool) -> str:
    """Write the page in Markdown.

    Args:
        header: of the table of claims.
        rows: of that table, the command last.
        quick: whether the studies ran coarsely.
    """
    pictures = [
        f"## {study.title}\n\n![{study.title}]({study.name}.png)\n\n{study.caption}"
        for study in STUDIES.values()
        if study.draw is not None
    ]
    table = [f"| {' | '.join(header)} |", "| --- | --- | --- | --- | --- |"]
    for *cells, command in rows:
        table.append(f"| {' | '.join(cell.replace('|', '/') for cell in cells)} | `{command}` |")
    machine = (
        f"{os.cpu_count()} cores, Python {platform.python_version()}, "
        f"MuJoCo {version('mujoco')}, SciPy {version('scipy')}"
    )
    return _PAGE.format(
        title=PAGE_TITLE,
        table="\n".join(table),
        pictures="\n\n".join(pictures),
        machine=machine,
        quick="A coarse, quick run; do not quote it.\n\n" if quick else "",
    )


_PAGE = """{title}

{quick}Mahbub and Shaharear (2025), *Real-Time Buoyancy Estimation for AUV Simulations Using Convex
Hull-Based Submerged Volume Calculation* (arXiv 2509.03804), put water into a simulator. Their
method takes the convex hull of those vertices of each mesh that are under the surface; a cheaper
one integrates cross-sections. This package has both (`--method convex_hull`, `--method sections`)
beside the exact one, and this page runs all three. The page, its pictures and its tables (CSV) are
written by

    scripts/reproduce_paper

The last run was on {machine}.
Wall times change from machine to machine. So do the last digits of whatever bounces for a minute.
The paper's vehicle and meshes are not published, so the hourglass and the AUV here are those of
`models/`. That AUV is an open-frame vehicle of the same class, with more hollows for a hull to fill
than a plain torpedo has.

## What holds

{table}

{pictures}

## How the paper is read

- *Volume*: the method takes the convex hull, by Quickhull, of each mesh's vertices below the
  surface, and sums over the meshes. "With cuts" adds the points where edges meet the surface, and
  uses the hull's true centroid instead of the mean of its vertices.
- *Sorting*: every 10 steps the vertices are sorted by their height above the surface. The method
  walks them in this order until one is dry. A step is 0.01 s.
- *Sections*: the areas are those of true cross-sections every 1/100 of each mesh's height,
  integrated by the trapezoid rule. "An axis free to turn" is read as one that stays vertical while
  the body tilts, "fixed" as one that turns with the body. On a wave the surface over each mesh is
  level, at the height that it has over the middle of the mesh.
- *Waves of +-0.3 m at 0.5 Hz*: the surface is both a level that goes up and down and a travelling
  wave, 6.2 m long.
- *Swing*: half the range of the centre of gravity's z over the last period of 5 s.
- *Holds?* "Linear" means within 2 % of the whole, "negligible" within 1 %. The error along the axis
  that stays vertical must be below 3 %, and that along the fixed one above. "In part" means for
  some of the bodies or methods named.
"""

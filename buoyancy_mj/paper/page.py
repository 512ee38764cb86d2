"""The page that shows the reproduction: the claims beside what was measured, and the figures."""

import os
import platform
from collections.abc import Sequence
from importlib.metadata import version

from buoyancy_mj.paper.studies import STUDIES


def page(header: Sequence[str], rows: Sequence[tuple[str, ...]], *, quick: bool) -> str:
    """The page, in Markdown.

    Args:
        header: of the table of claims.
        rows: of that table, the command last.
        quick: whether it was a coarse run.
    """
    pictures = [
        f"## {study.title}\n\n![{study.title}]({study.name}.png)\n\n{study.caption}"
        for study in STUDIES.values()
        if study.draw is not None
    ]
    table = [f"| {' | '.join(header)} |", "| --- | --- | --- | --- | --- |"]
    for *cells, command in rows:
        table.append(f"| {' | '.join(cell.replace('|', '/') for cell in cells)} | `{command}` |")
    machine = f"{os.cpu_count()} cores, Python {platform.python_version()}, MuJoCo {version('mujoco')}, SciPy {version('scipy')}"
    return _PAGE.format(
        table="\n".join(table),
        pictures="\n\n".join(pictures),
        machine=machine,
        quick="A coarse, quick run; do not quote it.\n\n" if quick else "",
    )


_PAGE = """# The source paper, reproduced

{quick}Mahbub and Shaharear (2025), *Real-Time Buoyancy Estimation for AUV Simulations Using Convex Hull-Based
Submerged Volume Calculation* (arXiv 2509.03804), put water into a simulator by the convex hull of the vertices of
each mesh that are under the surface, and more cheaply by integrating cross-sections. Both methods are here
(`--method convex_hull`, `--method sections`) beside the exact one, and this page runs them. It is written by

    scripts/reproduce_paper

as are the pictures and the tables (CSV) beside it; last on {machine}.
Wall times change from machine to machine, and so do the last digits of what bounces for a minute. The paper's
vehicle and its meshes are not published: the hourglass and the AUV are those of `models/`, the latter an open-frame
vehicle of the same class, with more hollows for a hull to fill than a plain torpedo has.

## What holds

{table}

{pictures}

## How the paper was read

- *Volume*: the convex hull, by Quickhull, of each mesh's vertices below the surface, summed over the meshes; "with
  cuts" adds the points where edges meet the surface, and takes the hull's true centroid instead of the mean of its
  vertices.
- *Sorting*: the vertices are sorted by their height above the surface every 10 steps, and walked in this order until
  one is dry. A step is 0.01 s.
- *Sections*: areas of true cross-sections every 1/100 of each mesh's height, trapezoid rule. "An axis free to turn"
  is read as one that stays vertical while the body tilts, "fixed" as one that turns with the body. On a wave the
  surface over each mesh is taken as level, at its height over the middle of the mesh.
- *Waves of +-0.3 m at 0.5 Hz*: both as a level that goes up and down and as a travelling wave, 6.2 m long.
- *Swing*: half the range of the centre of gravity's z over the last period of 5 s.
- *Holds?* "Linear" is within 2 % of the whole, "negligible" within 1 %; the axis that turns must stay below 3 % and
  the fixed one above. "In part": for some of the bodies or methods named.
"""
